"""Plausibility of a run's results at the recorded instants: of its lines, its soil, its bodies and joints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.saved_state import Stateful
from riser_soil.core.snapshot import Records
from riser_soil.results.plausibility import Plausibility
from riser_soil.results.soil_plausibility import PressedSoil, SoilPlausibility
from riser_soil.results.stage_tally import StageTally
from riser_soil.results.step_buffer import BufferedStep
from riser_soil.scene.stages import Stage

if TYPE_CHECKING:
    from riser_soil.results.bodies_and_joints import BodiesAndJointsReader


class PlausibilityChecks:
    """Checks of all that a run has, which put their warnings into the stage's tally.

    Results are checked on the rank that has the recorder; `begin_stage` and `measure_soil_boundary` are for all ranks.
    """

    def __init__(self, assembly: Assembly, bodies_and_joints: BodiesAndJointsReader | None) -> None:
        self._lines = {name: Plausibility(line) for name, line in assembly.lines.items()}
        self._soil, self._name_on_soil = _soil_plausibility(assembly), assembly.name_on_soil
        self._bodies_and_joints = bodies_and_joints

    def begin_stage(self, stage: Stage) -> None:
        """Begin the checks of a stage."""
        for line in self._lines.values():
            line.begin_stage(stage)
        if self._soil is not None:
            self._soil.begin_stage(stage)

    def measure_soil_boundary(self) -> None:
        """Take in the stress at the soil's boundary, at a stage's end; collective."""
        if self._soil is not None:
            self._soil.measure_boundary()

    def pressed_soil(self, state: State) -> PressedSoil | None:
        """The soil under the riser at an accepted state; None where there is none."""
        return None if self._soil is None else self._soil.pressed(state)

    def check(self, steps: Sequence[BufferedStep], times: Array, records: Records, tally: StageTally) -> None:
        """Check the recorded ones of some steps, at times (n,) of the run [s]; where pictures are made, also whether
        the elements resolve the bending.
        """
        recorded = [n for n, each in enumerate(steps) if each.due.series]
        if not recorded:
            return
        pictured = [n for n in recorded if steps[n].due.pictures]
        for name, line in self._lines.items():
            if pictured:
                line.follow_bending(times[pictured], records[name].at(pictured))
            line.follow(times[recorded], records[name].at(recorded))
            of_line = tally.lines[name]
            of_line.implausible, of_line.indicators.bending = line.warnings(), line.bending()
        if self._soil is not None:
            name = self._name_on_soil
            for n in recorded:
                if (pressed := steps[n].pressed) is not None:
                    self._soil.follow(float(times[n]), pressed, records[name].at(n))
            tally.lines[name].implausible += self._soil.warnings()
        if self._bodies_and_joints is not None:
            tally.implausible = tuple(self._bodies_and_joints.warnings(tally.bodies_and_joints.nested))

    @property
    def owners(self) -> dict[str, Stateful]:
        """What a run saves of them, by name."""
        owners: dict[str, Stateful] = {
            f"plausibility/{name}" if name else "plausibility": line for name, line in self._lines.items()
        }
        return owners if self._soil is None else owners | {"soil plausibility": self._soil}


def _soil_plausibility(assembly: Assembly) -> SoilPlausibility | None:
    lying = assembly.line_on_soil
    return None if lying is None or lying.soil is None else SoilPlausibility(lying, lying.soil)
