"""Load cases: one scene with many overrides, each case a run in a process and a folder of its own, and their table."""
