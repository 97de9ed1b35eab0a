"""Bounds that every finished run keeps, whatever its scene: finite numbers, forces in equilibrium, energy balance."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from riser_soil.assembly.riser import attachments_of, elements_of
from riser_soil.results.read import Run
from riser_soil.results.summary import DOUBTFUL
from riser_soil.scene.reader import read_scene
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage, loads_in
from riser_soil.stress.answers import Answer, between

BALANCE = 1e-3  # of the largest force: what an equilibrium may miss
ENERGY = "energy residual"  # in the name of that bound, of which runs have a warning of their own
_ALONG_RISER = ("position", "effective_tension", "bending_moment")


def bounds(run: Run) -> Iterator[Answer]:
    """All that apply to a finished run."""
    wrong = sum(int((~np.isfinite(run[name])).sum()) for name in _ALONG_RISER if name in _recorded(run))
    yield between("numbers that are none", wrong, 0, 0)
    scene = read_scene(run.folder / "scene.yaml")
    for stage, told in zip(scene.stages, run.summary["stages"], strict=True):
        if isinstance(stage, DynamicStage):
            yield from _energy(told)
        else:
            yield from _balance(scene, stage, told)


def _recorded(run: Run) -> tuple[str, ...]:
    return ("position", *run.scene["output"]["fields"])


def worst_residual(stage: dict[str, Any]) -> float:
    """Largest residual of a stage's energy balance over the energy turned over; 0 where none is."""
    energy = stage["energy"]
    worst, turned = energy["worst_residual"]["value"], energy["turned_over"]
    return abs(worst) / turned if worst is not None and turned else 0.0


def _energy(stage: dict[str, Any]) -> Iterator[Answer]:
    yield between(f"{stage['name']}: {ENERGY} [-]", worst_residual(stage), 0.0, DOUBTFUL)


def _balance(scene: Scene, stage: Stage, told: dict[str, Any]) -> Iterator[Answer]:
    """Vertical forces at the stage's end: reactions, contact, loads and weight; and no tension beyond their sum."""
    if not _still_and_submerged(scene):
        return
    final, weight, load = told["final"], _weight(scene), _loads(scene, stage)
    up = [final["start"]["force"][2], final["end"]["force"][2], final["contact_force"], float(load[2]), -weight]
    forces = [*final["start"]["force"], *final["end"]["force"], *up]
    bending = final["max_bending_moment"]["value"] / scene.riser.length
    largest = max(bending, *(abs(x) for x in forces))
    if largest == 0.0:
        return
    missed = abs(sum(up)) / largest
    yield between(f"{stage.name}: vertical forces out of balance, of the largest [-]", missed, 0.0, BALANCE)
    most = 2.0 * bending + sum(abs(x) for x in forces) + float(np.abs(load).sum())
    tension = max(abs(final[end]["effective_tension"]) for end in ("start", "end"))
    yield between(f"{stage.name}: tension at an end [N]", tension, 0.0, most)


def _still_and_submerged(scene: Scene) -> bool:
    """Whether weight and buoyancy are all that acts along the riser, but for loads and a ground without friction."""
    water, contact = scene.water, scene.contact
    still = water is None or (water.surface_level is None and water.current is None)
    return still and (contact is None or contact.friction is None)


def _weight(scene: Scene) -> float:
    """Less buoyancy, downwards [N], attachments included."""
    elements = elements_of(scene)
    along = float(elements.weight @ np.diff(elements.arc))
    return along + sum(each.net_weight for each in attachments_of(scene))


def _loads(scene: Scene, stage: Stage) -> np.ndarray:
    """Sum of a stage's loads at its end (3,) [N]."""
    total = np.zeros(3)
    for load in loads_in(scene.stages, stage):
        factor = 1.0 if load.history is None else load.history[-1][1]
        total += factor * np.asarray(load.force or (0.0, 0.0, 0.0))
        total += factor * scene.riser.length * np.asarray(load.distributed or (0.0, 0.0, 0.0))
    return total
