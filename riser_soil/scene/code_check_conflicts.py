"""Conflicts of code checks with the rest of a scene."""

from collections.abc import Iterator

from riser_soil.scene.code_check import MOST_SLENDER, DnvCheck, ResistanceCheck, SteelCheck, checks_of
from riser_soil.scene.line_types import LineType
from riser_soil.scene.problem import Path, Problem, hint
from riser_soil.scene.scene import Scene


def code_check_conflicts(scene: Scene) -> Iterator[Problem]:
    """Names that don't exist, line types checked twice, and pipes that a code says nothing of."""
    missing = [*_names(scene)]
    yield from missing or _checked_once(scene)
    if missing:
        return
    for n, check in enumerate(scene.code_check):
        if not isinstance(check, SteelCheck):
            continue
        if scene.water is not None and scene.water.surface_level is None:
            allowed = "needs the pressure outside, which is unknown without water.surface_level"
            yield Problem(("code_check", n, "kind"), allowed, "give water.surface_level [m]")
        for name, line in scene.used_line_types.items():
            if check.applies_to(name):
                yield from _wall(("code_check", n), check, name, line)


def _names(scene: Scene) -> Iterator[Problem]:
    stages = [stage.name for stage in scene.stages]
    for n, check in enumerate(scene.code_check):
        for m, name in enumerate(check.line_types or ()):
            if name not in scene.line_types:
                known = f"must be a key of line_types ({', '.join(scene.line_types)})"
                remedy = f"name one of them{hint(name, scene.line_types)}"
                yield Problem(("code_check", n, "line_types", m), known, remedy)
        if isinstance(check, DnvCheck):
            for key in ("functional_stage", "accidental_stage"):
                name = getattr(check, key)
                if name is not None and name not in stages:
                    known = f"must be the name of a stage ({', '.join(stages)})"
                    yield Problem(("code_check", n, key), known, f"name one of them{hint(name, stages)}")
            first, second = check.functional_stage, check.accidental_stage
            if first in stages and second in stages and stages.index(second) <= stages.index(first):
                allowed = f"must come after functional_stage ({first})"
                yield Problem(("code_check", n, "accidental_stage"), allowed, "name a later stage")


def _checked_once(scene: Scene) -> Iterator[Problem]:
    for name in scene.line_types:
        _, *again = checks_of(scene.code_check, name) or [0]
        for n in again:
            allowed = f"{name} is already checked by another of the list"
            yield Problem(("code_check", n, "line_types"), allowed, "name in each check the line types that it is for")


def _wall(path: Path, check: SteelCheck, name: str, line: LineType) -> Iterator[Problem]:
    outer, inner = line.pipe_diameters
    if not 0.0 < inner < outer:
        allowed = f"needs the wall of {name}, which has no outer_diameter and inner_diameter"
        yield Problem((*path, "kind"), allowed, f"give them in line_types.{name}, or name other line_types")
        return
    t = 0.5 * (outer - inner)
    if check.thinning >= t:
        allowed = f"leaves nothing of the wall of {name}, which is {t:g} m thick"
        remedy = "lower it or fabrication_tolerance, or give a thicker wall"
        yield Problem((*path, "corrosion_allowance"), allowed, remedy)
        return
    slender = outer / (t - check.corrosion_allowance)
    if isinstance(check, ResistanceCheck) and slender > MOST_SLENDER:
        allowed = f"holds up to D/t = {MOST_SLENDER:g}, and {name} has {slender:.4g} without its corrosion_allowance"
        yield Problem((*path, "kind"), allowed, "take a thicker wall, or leave the check of this line type out")
