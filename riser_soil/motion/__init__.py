"""Prescribed motions of the riser's ends and rotations of their supports, as functions of time.

A motion gives position, velocity and acceleration at a time, each (3,) in global axes; a rotation gives a
`SupportRotation`.
"""
