"""From the scene to its parts: the only place that asks whether a scene has a thing, and that imports what it has."""

from riser_soil.assembly.assembly import Assembly, build

__all__ = ["Assembly", "build"]
