"""Assembly of what acts in dynamic stages alone, beside the water: inertia and damping."""

from __future__ import annotations

from collections.abc import Sequence

from riser_soil.core.part import Part
from riser_soil.riser.attachments import PointAttachment, masses
from riser_soil.riser.inertia import Inertia, RotaryInertia
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.stages import DynamicStage, MidpointScheme


def dynamic_parts(
    stage: DynamicStage, line: Line, elements: Elements, attachments: Sequence[PointAttachment] = ()
) -> list[Part]:
    """Parts of dynamic stages: inertia and damping."""
    parts = _inertia(line, elements, attachments)
    if isinstance(stage.scheme, MidpointScheme):
        from riser_soil.riser.midpoint_inertia import over_steps

        parts = [over_steps(part) for part in parts]
    if elements.damping.any():
        from riser_soil.riser.structural_damping import StructuralDamping

        parts.append(StructuralDamping(line, elements))
    return parts


def _inertia(line: Line, elements: Elements, attachments: Sequence[PointAttachment]) -> list[Part]:
    attached = masses(line, attachments) if attachments else None
    parts: list[Part] = [Inertia(line, elements.mass, attached)]
    if line.dimension == 3 or elements.rotary_inertia.any():
        parts.append(RotaryInertia(line, elements.rotary_inertia, elements.polar_inertia))
    return parts
