"""Calibration of an accuracy asked in a scene: whether runs reach it, what they cost beside the best set by hand."""
