"""What the water does to the riser."""
