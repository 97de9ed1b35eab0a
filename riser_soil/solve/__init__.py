"""Solving the system: Newton's method and its linear solver, static and time steps, step control, lost stability."""
