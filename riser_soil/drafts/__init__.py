"""Drafts: first scenes of common lines, written from a few numbers, for `riser-soil new`."""
