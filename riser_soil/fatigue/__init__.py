"""Fatigue of the pipe's wall: rainflow cycles of recorded stress, S-N curves, damage over load cases."""
