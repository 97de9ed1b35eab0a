"""Assembly: builds the parts of the model from a checked scene; nothing that the scene lacks is imported."""

from riser_soil.assembly.assembly import Assembly, build, sized

__all__ = ["Assembly", "build", "sized"]
