"""Plausibility of code checks: line types without one, and what their formulas were not made for."""

from __future__ import annotations

from collections.abc import Iterator

from riser_soil.scene.code_check import LEAST_SLENDER, MOST_SLENDER, DnvCheck, SteelCheck, checks_of
from riser_soil.scene.line_types import LineType
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import StaticStage


def code_check_warnings(scene: Scene) -> Iterator[str]:
    """Warnings of the code checks of one line's scene."""
    unchecked = [name for name in scene.used_line_types if not checks_of(scene.code_check, name)]
    if unchecked:
        yield f"code_check: no check is for {', '.join(unchecked)}: add one, or know that it is not checked"
    for n, check in enumerate(scene.code_check):
        checked = {name: line for name, line in scene.used_line_types.items() if check.applies_to(name)}
        key = f"code_check.{n}"
        if isinstance(check, SteelCheck):
            yield from _two_strengths(key, check, checked)
        if isinstance(check, DnvCheck) and checked:
            yield from _thick_walls(key, check, checked)
            yield from _not_functional(key, check, scene)


def _two_strengths(key: str, check: SteelCheck, checked: dict[str, LineType]) -> Iterator[str]:
    for name, line in checked.items():
        given = line.wall.yield_stress if line.wall is not None else None
        if given is not None and given != check.yield_stress:
            yield (
                f"{key}: its yield_stress is {check.yield_stress:.4g} Pa, and that of line_types.{name}.wall "
                f"{given:.4g} Pa: correct one of the two"
            )


def _thick_walls(key: str, check: DnvCheck, checked: dict[str, LineType]) -> Iterator[str]:
    for name, line in checked.items():
        outer, inner = line.pipe_diameters
        slender = outer / (0.5 * (outer - inner) - check.corrosion_allowance)
        if slender < LEAST_SLENDER:
            yield (
                f"{key}: {name} has D/t = {slender:.4g} without its corrosion_allowance, and the formula of "
                f"propagating buckling was fitted from {LEAST_SLENDER:g} to {MOST_SLENDER:g}: judge that "
                "utilisation by itself"
            )


def _not_functional(key: str, check: DnvCheck, scene: Scene) -> Iterator[str]:
    """Load effects that count as functional without being so."""
    if check.functional_run is not None:
        return
    if (acts := _environment_at_rest(scene)) and check.limit_state == "ULS":
        yield (
            f"{key}: {acts}: its load effects count as functional, with a factor of 1.1, and not as environmental, "
            "with 1.3; give functional_run, a run without it"
        )
    if check.functional_stage is None and not isinstance(scene.stages[0], StaticStage):
        yield (
            f"{key}: no static stage comes before {scene.stages[0].name}: load effects of the run's first instant "
            "count as functional; give functional_stage, or begin with a static stage"
        )


def _environment_at_rest(scene: Scene) -> str:
    """What of the environment acts from the beginning, in words; "" for nothing. An offset of the vessel is a move."""
    if scene.water is not None and scene.water.current is not None:
        return "a current acts in all stages"
    first = scene.stages[0]
    moved = isinstance(first, StaticStage) and first.move is not None
    return f"the first stage, {first.name}, moves an end, perhaps by an offset" if moved else ""
