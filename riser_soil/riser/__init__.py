"""The riser: finite rotations, beam elements, the line's configuration and the parts that load it."""
