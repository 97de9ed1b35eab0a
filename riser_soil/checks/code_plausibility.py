"""Plausibility of code checks: line types without one, and what their formulas were not made for."""

from __future__ import annotations

from collections.abc import Iterator

from riser_soil.scene.code_check import LEAST_SLENDER, MOST_SLENDER, DnvCheck, checks_of
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import StaticStage


def _environment_at_rest(scene: Scene) -> str:
    """What of the environment acts from the beginning, in words; "" for nothing. An offset of the vessel is a move."""
    if scene.water is not None and scene.water.current is not None:
        return "a current acts in all stages"
    first = scene.stages[0]
    moved = isinstance(first, StaticStage) and first.move is not None
    return f"the first stage, {first.name}, moves an end, perhaps by an offset" if moved else ""


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
        if (acts := _environment_at_rest(scene)) and check.limit_state == "ULS" and check.functional_run is None:
            yield (
                f"code_check.{n}: {acts}: its load effects count as functional, with a factor of 1.1, and "
                "not as environmental, with 1.3; give functional_run, a run without it"
            )
        given = check.functional_stage is not None or check.functional_run is not None
        if not given and not isinstance(scene.stages[0], StaticStage):
            yield (
                f"code_check.{n}: no static stage comes before {scene.stages[0].name}: load effects of the run's first "
                "instant count as functional; give functional_stage, or begin with a static stage"
            )
