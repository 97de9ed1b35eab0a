"""Assembly: builds the parts of the model from a checked scene; nothing that the scene lacks is imported."""

from riser_soil.assembly.assembly import Assembly, build, sized
from riser_soil.assembly.line_assembly import LineAssembly

__all__ = ["Assembly", "LineAssembly", "build", "sized"]
