"""Stress suite: stiff and extreme scenes, each in a process with limits, judged by exact or bounding answers."""
