"""The folder of a run: what is recorded, how its files are written, and how they are read again."""

from riser_soil.results.read import Run, SoilFrame

__all__ = ["Run", "SoilFrame"]
