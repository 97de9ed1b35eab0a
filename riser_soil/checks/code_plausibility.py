"""Plausibility of code checks: line types without one, and what their formulas were not made for."""

from __future__ import annotations

from collections.abc import Iterator

from riser_soil.scene.code_check import LEAST_SLENDER, MOST_SLENDER, DnvCheck, checks_of
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import StaticStage


def code_check_warnings(scene: Scene) -> Iterator[str]:
    """Of one line's scene, which has code checks."""
    unchecked = [name for name in scene.used_line_types if not checks_of(scene.code_check, name)]
    if unchecked:
        yield f"code_check: no check is for {', '.join(unchecked)}: add one, or know that it is not checked"
    for n, check in enumerate(scene.code_check):
        if not isinstance(check, DnvCheck):
            continue
        for name, line in scene.used_line_types.items():
            outer, inner = line.steel_diameters
            slender = outer / (0.5 * (outer - inner) - check.corrosion_allowance)
            if check.applies_to(name) and slender < LEAST_SLENDER:
                yield (
                    f"code_check.{n}: {name} has D/t = {slender:.4g} without its corrosion_allowance, and the formula "
                    f"of propagating buckling was fitted from {LEAST_SLENDER:g} to {MOST_SLENDER:g}: judge that "
                    "utilisation by itself"
                )
        if check.functional_stage is None and not isinstance(scene.stages[0], StaticStage):
            yield (
                f"code_check.{n}: no static stage comes before {scene.stages[0].name}: load effects of the run's first "
                "instant count as functional; give functional_stage, or begin with a static stage"
            )
