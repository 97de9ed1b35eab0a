"""Prescribed motions of the riser's ends: t -> position, velocity, acceleration, each (3,) in global axes; and of the
supports' rotations: t -> Turning.
"""
