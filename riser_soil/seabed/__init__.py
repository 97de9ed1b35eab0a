"""Seabed models without dofs (rigid, springs, hysteretic), with or without a block of soil inside."""
