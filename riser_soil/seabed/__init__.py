"""Seabeds without dofs of their own: they stand in for a continuum, everywhere or outside a block of soil."""
