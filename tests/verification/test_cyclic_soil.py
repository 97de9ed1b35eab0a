"""Riser on cyclic clay: the whole system's matrix, Newton's iterations, energy, memory of the clay."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.driven_stage import FirstStep, built
from tests.support.scenes import LAY, Mapping, heave, touchdown
from tests.support.stage_histories import HeavedSoil

LAWS: dict[str, Mapping] = {
    "kinematic-hardening": {"elastic_share": 0.2},
    "iwan": {"elements": 8},
}
KINDS = pytest.mark.parametrize("kind", LAWS)


def on_clay(kind: str, *stages: Mapping) -> Mapping:
    scene = touchdown(LAY, *stages, su=1000.0)
    constants = {key: scene["soil"]["law"][key] for key in ("su", "su_gradient", "E_over_su", "nu")}
    scene["soil"]["law"] = {"kind": kind} | constants | LAWS[kind]
    return scene


@KINDS
def test_the_matrix_is_the_slope_of_the_residual(kind: str) -> None:
    assembly = built(on_clay(kind, heave(1.0, time_step=0.01)))
    step = FirstStep(assembly)
    rng = np.random.default_rng(5)
    x = 2e-3 * rng.normal(size=step.free)
    matrix, h = step.matrix(x), 1e-5
    for _ in range(3):
        direction = 2e-3 * rng.normal(size=step.free)
        wanted = step.slope(x, direction, h)
        assert np.linalg.norm(matrix @ direction - wanted) < 1e-5 * np.linalg.norm(wanted)


@pytest.mark.parametrize("kind", ["kinematic-hardening", pytest.param("iwan", marks=pytest.mark.verify)])
def test_heave_takes_energy_in_every_cycle(kind: str) -> None:
    """Three cycles of the same motion: the clay takes work each time, Newton converges in few iterations."""
    heaved = HeavedSoil(on_clay(kind, heave(9.0, 0.15)))
    steps = list(zip(heaved.lost, heaved.times, strict=True))
    cycles = [sum(w for w, t in steps if a < t <= a + 3.0 + 1e-9) for a in (0.0, 3.0, 6.0)]
    assert min(heaved.lost) > -1e-9 * max(cycles)
    assert min(cycles) > 0.0
    assert np.mean(heaved.iterations) < 6.0
    assert heaved.plastic_strain > 1e-4
