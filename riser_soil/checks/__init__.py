"""Checks before a scene is solved: plausibility warnings, problem size, memory, disk and run time."""
