"""A riser laid on soil, then heaved: what the soil takes in each step, and how many iterations that needs."""

from __future__ import annotations

from dataclasses import dataclass, field

from riser_soil.core.system import System
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.coupled_scenes import Mapping
from tests.support.driven_stage import built, take


@dataclass
class HeavedSoil:
    """The two stages of a scene, taken. By step of the second: time [s], energy lost in the soil [J], iterations."""

    scene: Mapping
    times: list[float] = field(default_factory=list)
    lost: list[float] = field(default_factory=list)
    iterations: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        assembly = built(self.scene)
        assert assembly.soil is not None
        lay, heave = assembly.scene.stages
        take(assembly, heave, take(assembly, lay), self._watch)
        self.plastic_strain = float(assembly.soil.output_fields().plastic_strain.max())

    def _watch(self, system: System, step: AcceptedStep) -> None:
        self.times.append(step.t)
        self.lost.append(step.turned["soil"].dissipated)
        self.iterations.append(step.solution.iterations)
