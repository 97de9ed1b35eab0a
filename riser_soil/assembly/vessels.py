"""Assembly of vessels: RAOs applied to the scene's waves, and the ends that each vessel carries."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from riser_soil.assembly.sea import SeaAssembly, wave_clock
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.quantities import Vector
from riser_soil.errors import SceneError
from riser_soil.motion.vessel import RaoTable, VesselAttachment, VesselMotion, VesselResponse
from riser_soil.scene.motions import Vessel as VesselScene
from riser_soil.scene.rao import MODES
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.sea.components import Components

# Part of a mode's energy that waves beyond the table's frequencies may have, judged by its first and last rows, and the
# share from which a warning is given.
MOST_BEYOND, REPORTED_BEYOND = 0.01, 1e-3

_Key = tuple[Path, Vector, float]


class EnergyOutsideTable(NamedTuple):
    """Waves beyond a table's frequencies: share of the waves' energy below and above, the table's range [rad/s]."""

    below: float
    above: float
    first: float
    last: float


class Vessels:
    """The scene's vessels and their responses to its waves; SceneError where a table doesn't cover the waves.

    An end has its mean position where it was before a vessel first moved it, and moves of static stages take it along.
    A vessel that moves the end again, after a stage in which it didn't or was another one, brings it from where it
    rests to the response about that mean.

    beyond: by the path of the table, where waves beyond its frequencies may matter a little.
    """

    def __init__(self, scene: Scene, sea: SeaAssembly) -> None:
        self._scene = scene
        self._responses: dict[_Key, VesselResponse] = {}
        self._last: dict[str, tuple[VesselMotion, float]] = {}  # by the end: what moved it last, and for how long [s]
        self.beyond: dict[str, EnergyOutsideTable] = {}
        assert sea.waves is not None  # the scene's checks have seen to it
        for path, vessel in _vessels(scene):
            if _key(vessel) not in self._responses:
                self._responses[_key(vessel)] = self._response(path, vessel, sea.waves.components)

    def motion(self, stage: Stage, end: str, origin: Array) -> VesselMotion:
        """The motion of an end that is at origin (3,) as a stage begins; to be called in the order of the stages."""
        given = _vessel(stage, end)
        assert given is not None
        since, first = _beginning(self._scene, stage, end, given)
        before = self._last.get(end)
        if before is None or since == 0.0:
            attachment, ramp = self._attachment(first, end, origin), self._ramp(first, again=before is not None)
        else:
            attachment, ramp = before[0].attachment, before[0].ramp
        vessel = VesselMotion(self._responses[_key(given)], attachment, ramp, wave_clock(self._scene, stage), since)
        self._last[end] = vessel, stage.duration if isinstance(stage, DynamicStage) else 0.0
        return vessel

    def move(self, end: str, by: Array) -> None:
        """An end was moved in a static stage, by (3,) [m]: its berth goes along."""
        if end in self._last:
            vessel, duration = self._last[end]
            attachment = replace(vessel.attachment, mean=vessel.attachment.mean + by)
            self._last[end] = replace(vessel, attachment=attachment), duration

    def _attachment(self, vessel: VesselScene, end: str, origin: Array) -> VesselAttachment:
        """Where the end was before a vessel first moved it; a vessel that moves it again finds it displaced."""
        reference = np.array(vessel.reference)
        if end not in self._last:
            return VesselAttachment(origin, reference, np.zeros(6))
        last, duration = self._last[end]
        mean = last.attachment.mean
        return VesselAttachment(mean, reference, np.concatenate([origin - mean, last(duration)[0][3:]]))

    def _ramp(self, vessel: VesselScene, again: bool) -> float:
        """Seconds to the full response: after a rest at least a (peak) period, as the end has to come back."""
        assert self._scene.water is not None
        assert self._scene.water.waves is not None
        waves = self._scene.water.waves
        ramp = waves.ramp if vessel.ramp is None else vessel.ramp
        return max(ramp, waves.period) if again else ramp

    def _response(self, path: str, vessel: VesselScene, waves: Components) -> VesselResponse:
        table = _table(vessel)
        responses = table.at(waves.frequency, waves.direction - np.radians(vessel.heading_deg))
        below, above = table.beyond(waves.frequency)
        if beyond := _beyond(path, vessel, waves, responses, (below, above)):
            self.beyond[path] = beyond
        responses[above] = 0.0
        return VesselResponse(waves.frequency, (responses * _crests(waves, vessel)[:, None]) @ _to_global(vessel))


def _key(vessel: VesselScene) -> _Key:
    """Key that identifies a vessel."""
    return vessel.rao, vessel.reference, vessel.heading_deg


def _vessels(scene: Scene) -> Iterator[tuple[str, VesselScene]]:
    """Paths of the tables, and the vessels."""
    for n, stage in enumerate(scene.stages):
        for end in ("start", "end"):
            if vessel := _vessel(stage, end):
                yield f"stages.{n}.motion.{end}.vessel.rao", vessel


def _vessel(stage: Stage, end: str) -> VesselScene | None:
    """The vessel that carries an end in a stage."""
    if not isinstance(stage, DynamicStage) or stage.motion is None or end not in stage.motion.by_end:
        return None
    return stage.motion.by_end[end].vessel


def _beginning(scene: Scene, stage: Stage, end: str, vessel: VesselScene) -> tuple[float, VesselScene]:
    """How long the vessel has been moving without a break as the stage begins [s], and as what it began to."""
    since, names = 0.0, [other.name for other in scene.stages]
    for other in reversed(scene.stages[: names.index(stage.name)]):
        before = _vessel(other, end)
        if not isinstance(other, DynamicStage) or before is None or _key(before) != _key(vessel):
            break
        since, vessel = since + other.duration, before
    return since, vessel


def _table(vessel: VesselScene) -> RaoTable:
    given = vessel.table
    shape = len(given.direction), len(given.frequency)
    response = np.stack([np.array(given.response.get(mode, np.zeros(shape))) for mode in MODES], axis=2)
    return RaoTable(np.array(given.frequency), np.array(given.direction), response.astype(complex))


def _crests(waves: Components, vessel: VesselScene) -> Array:
    """Complex amplitudes (n,) of the surface at the reference: it rises by the sum of Re(amplitude exp(i w t))."""
    x, y, _ = vessel.reference
    along = x * np.cos(waves.direction) + y * np.sin(waves.direction)
    return np.asarray(waves.amplitude * np.exp(-1j * (waves.wave_number * along + waves.phase)))


def _to_global(vessel: VesselScene) -> Array:
    """(6, 6), rows: the modes, columns: displacements along and rotations about global axes."""
    axes = np.array([vessel.axes(mode) for mode in MODES[:3]])
    return np.kron(np.eye(2), axes)


def _beyond(
    path: str, vessel: VesselScene, waves: Components, responses: Array, beyond: tuple[BoolArray, BoolArray]
) -> EnergyOutsideTable | None:
    """Wave energy outside the table where the vessel may respond to it; SceneError where it would for sure."""
    energy = 0.5 * waves.amplitude**2
    below, above = (float(energy[part].sum() / energy.sum()) for part in beyond)
    first, last = vessel.table.frequency[0], vessel.table.frequency[-1]
    felt = energy[:, None] * np.abs(responses) ** 2
    share = felt[beyond[0] | beyond[1]].sum(axis=0) / np.maximum(felt.sum(axis=0), np.finfo(float).tiny)
    if share.max() > MOST_BEYOND:
        worst = int(np.argmax(share))
        raise SceneError(
            f"{path}: {vessel.rao} covers {first:.4g} to {last:.4g} rad/s, but {100.0 * below:.3g} % of the waves' "
            f"energy lies below and {100.0 * above:.3g} % above: by the table's first and last rows "
            f"{100.0 * share[worst]:.3g} % of the energy of {MODES[worst]}; add rows that cover "
            f"{waves.frequency.min():.4g} to {waves.frequency.max():.4g} rad/s"
        )
    return EnergyOutsideTable(below, above, first, last) if share.max() > REPORTED_BEYOND else None
