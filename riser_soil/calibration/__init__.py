"""Calibration of a scene's numbers, such as those of a soil law, on a measured curve of resistance by penetration."""
