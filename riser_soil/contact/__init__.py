"""Contact of the riser with seabed and soil: detection, penalty law, friction, suction, touchdown point."""
