"""Results of a run: recording, netCDF, XDMF and summary files, and reading them."""

from riser_soil.results.read import Run, SoilFrame

__all__ = ["Run", "SoilFrame"]
