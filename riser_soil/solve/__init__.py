"""Solution: Newton's method, linear solver, time schemes, step control, dynamic relaxation, stability."""
