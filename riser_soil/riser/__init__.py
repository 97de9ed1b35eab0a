"""The riser: finite rotations, corotational beam elements, line configuration, inertia, damping and loads."""
