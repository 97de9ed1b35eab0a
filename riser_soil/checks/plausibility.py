"""Plausibility warnings of an assembled scene, each with its numbers and a remedy."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from riser_soil.assembly import Assembly, LineAssembly
from riser_soil.assembly.packages import needs_petsc
from riser_soil.checks.bending_plausibility import bending_warnings
from riser_soil.checks.motion_plausibility import motion_warnings, refuse_unreachable
from riser_soil.core.arrays import BoolArray
from riser_soil.scene.line_checks import path_of_line
from riser_soil.scene.problem import dotted
from riser_soil.scene.scene import Scene
from riser_soil.scene.sizes import doubts
from riser_soil.scene.stages import DynamicStage, Load, OfBody, Stage, StaticStage, VaryingLoad


def physical_warnings(assembly: Assembly) -> Iterator[str]:
    """All plausibility warnings, each with its numbers, those of several lines behind their names, unless they begin
    with a key of that line; collective.
    """
    yield from (f"{dotted(path)}: {text}" for path, text in doubts(assembly.scene.model_dump(by_alias=True)))
    yield from _options_without_petsc(assembly)
    if not assembly.scene.lines:
        yield from _of_one(assembly.riser)
        return
    warnings = {name: [_placed(each, name) for each in _of_one(line)] for name, line in assembly.lines.items()}
    for warning in dict.fromkeys(each for of_line in warnings.values() for each in of_line):
        names = [name for name, of_line in warnings.items() if warning in of_line]
        of_its_own = names[0] in warning.partition(":")[0].split(".")
        yield warning if of_its_own else f"{', '.join(names)}: {warning}"
    yield from _body_loads_that_end(assembly.scene)
    if (bodies_and_joints := assembly.bodies_and_joints) is not None and bodies_and_joints.contacts:
        from riser_soil.checks.body_plausibility import body_warnings

        yield from body_warnings(bodies_and_joints)


def _options_without_petsc(assembly: Assembly) -> Iterator[str]:
    """Options for PETSc in the environment, where it solves nothing."""
    scene, given = assembly.scene, os.environ.get("PETSC_OPTIONS", "").split()
    options = [each for each in given if each.startswith("-riser_soil_")]
    if options and not needs_petsc(scene):
        yield (
            f"PETSC_OPTIONS: {' '.join(options)}: not used, as a riser alone is solved without PETSc; "
            "solver: {newton: snes} hands it to SNES"
        )


def refuse_impossible(scene: Scene) -> None:
    """Raises SceneError where motions take ends to where their lines can't be."""
    if any(not isinstance(stage, StaticStage) for stage in scene.stages):
        refuse_unreachable(scene)


def _placed(warning: str, line: str) -> str:
    """A warning of one of several lines, that begins with the path that its key has in the whole scene."""
    path, colon, words = warning.partition(":")
    return dotted(path_of_line(tuple(path.split(".")), line)) + colon + words


def _of_one(riser: LineAssembly) -> Iterator[str]:
    yield from _light_pipes(riser)
    yield from bending_warnings(riser)
    if riser.contacts:
        from riser_soil.checks.ground_plausibility import ground_warnings

        yield from ground_warnings(riser)
    if riser.scene.code_check:
        from riser_soil.checks.code_plausibility import code_check_warnings

        yield from code_check_warnings(riser.scene)
    yield from _beyond_the_rao(riser)
    yield from _loads_that_end(riser.scene)
    if riser.scene.water is not None and riser.scene.water.waves is not None:
        from riser_soil.checks.wave_plausibility import wave_warnings

        yield from wave_warnings(riser.scene)
    if _moves(riser.scene):
        yield from motion_warnings(riser)


def _moves(scene: Scene) -> bool:
    """Whether ends move in any stage, or waves come in a dynamic one."""
    waves = scene.water is not None and scene.water.waves is not None
    moved = (stage.move if isinstance(stage, StaticStage) else stage.motion for stage in scene.stages)
    return any(each is not None for each in moved) or (waves and scene.has_dynamic_stage)


def _light_pipes(riser: LineAssembly) -> Iterator[str]:
    """Warnings of pipes that float although neither a buoyancy module nor anything else is meant to lift them."""
    weight, arc = riser.elements.weight, riser.line.arc
    light = np.flatnonzero((weight < 0.0) & ~_meant_to_float(riser) & ~_in_air(riser))
    if light.size:
        yield (
            f"submerged weight is negative, {weight[light].min():.4g} N/m, from arc {arc[light[0]]:.4g} m on: the "
            "pipe floats; check mass, contents and diameters, or give submerged_weight"
        )


def _in_air(riser: LineAssembly) -> BoolArray:
    """Elements (ne,) above the water's surface in the first shape, whose buoyancy does not act."""
    water, line = riser.scene.water, riser.line
    if water is None or water.surface_level is None:
        return np.zeros(line.length.size, dtype=bool)
    dry = line.to_global(line.x)[:, 2] > water.surface_level
    return np.asarray(dry[1:] & dry[:-1])


def _meant_to_float(riser: LineAssembly) -> BoolArray:
    """Elements (ne,) whose buoyancy is meant: those of a riser that weighs something as a whole, attachments included,
    which lie between heavier ones, as the buoyant section of a lazy wave, or whose submerged_weight is given.
    """
    scene, weight = riser.scene, riser.elements.weight
    given = [scene.line_types[segment.line_type].submerged_weight is not None for segment in scene.line.segments]
    meant = np.repeat(given, [segment.element_count for segment in scene.line.segments])
    heavy = np.flatnonzero(weight > 0.0)
    if heavy.size:
        meant[heavy[0] : heavy[-1]] = True
    net_weight = float(weight @ riser.elements.length) + sum(each.net_weight for each in riser.attachments)
    return np.asarray(meant & (net_weight > 0.0))


def _beyond_the_rao(riser: LineAssembly) -> Iterator[str]:
    """Waves outside the frequencies of a vessel's table."""
    for path, beyond in (riser.vessels.beyond if riser.vessels is not None else {}).items():
        yield (
            f"{path}: {100.0 * beyond.below:.3g} % of the waves' energy lies below the table's first frequency, "
            f"{beyond.first:.4g} rad/s, where the vessel moves as there, and {100.0 * beyond.above:.3g} % above its "
            f"last, {beyond.last:.4g} rad/s, where it doesn't move: by the table's ends that is little; a longer table "
            "would show"
        )


def _loads_that_end(scene: Scene) -> Iterator[str]:
    for n, load, after in _left_out(scene.stages, [stage.loads for stage in scene.stages]):
        yield _ends(f"stages.{n}.loads", load, after, "the riser")


def _body_loads_that_end(scene: Scene) -> Iterator[str]:
    for name in scene.bodies:
        given = [stage.bodies.get(name, OfBody()).loads for stage in scene.stages]
        for n, load, after in _left_out(scene.stages, given):
            yield _ends(f"stages.{n}.bodies.{name}.loads", load, after, f"body {name}")


def _left_out(
    stages: Sequence[Stage], given: Sequence[Sequence[VaryingLoad]]
) -> Iterator[tuple[int, tuple[int, VaryingLoad], Stage]]:
    """Loads, given by stage, of stages without inertia that the next stage does not have, and so takes away: the number
    of the stage, the load with its own, and the next stage.
    """
    for n, (stage, after) in enumerate(pairwise(stages)):
        if isinstance(stage, DynamicStage):
            continue
        acting_after = [_acting(other) for other in given[n + 1]]
        for m, load in enumerate(given[n]):
            if not load.keep and not _has_ended(load, stage) and _acting(load) not in acting_after:
                yield n, (m, load), after


def _ends(path: str, numbered: tuple[int, VaryingLoad], after: Stage, what: str) -> str:
    m, load = numbered
    back = "springs back at once" if isinstance(after, DynamicStage) else "comes back"
    return (
        f"{path}.{m}: {_load_in_words(load)} ends with its stage; {after.name} is without it, and {what} {back}: "
        "give it keep: true if it stays"
    )


def _has_ended(load: VaryingLoad, stage: Stage) -> bool:
    """Whether a load's own history brings it to nothing by the end of its stage."""
    if load.history is None:
        return False
    times, factors = zip(*load.history, strict=True)
    return float(np.interp(stage.end, times, factors)) == 0.0


def _acting(load: VaryingLoad) -> dict[str, object]:
    """What a load is, whatever its size in time."""
    return load.model_dump(exclude={"history", "keep"})


def _load_in_words(load: VaryingLoad) -> str:
    units = {"force": "N", "moment": "N.m", "distributed": "N/m"}
    given = {key: getattr(load, key, None) for key in units}
    parts = [f"{key} {[float(f'{x:.4g}') for x in v]} {units[key]}" for key, v in given.items() if v is not None]
    return " and ".join(parts) + (f" at {load.at}" if isinstance(load, Load) and load.at is not None else "")
