"""Calibration of error bars: scenes with known answers, whether their true errors are inside, by how much."""
