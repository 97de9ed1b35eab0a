"""Variants of a scene: made by key paths or settings, run in processes, and compared by their key results."""
