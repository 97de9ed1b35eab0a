"""Contact between the riser and what lies under it: pairing, the penalty law, and the part that couples the
two.
"""
