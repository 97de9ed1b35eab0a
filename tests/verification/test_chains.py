"""Lines without bending stiffness: the elastic catenary, no moments, no warnings about bending."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from scipy.optimize import fsolve

from riser_soil.assembly import build
from riser_soil.checks.bending_plausibility import bending_warnings
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from tests.support.said import telling
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import distance, stage_histories

W, EA, L, SPAN, RISE = 500.0, 1.0e6, 150.0, 90.0, 100.0
HEAVE = {"end": {"harmonic": {"amplitude": [1.0, 0.0, 1.0], "period": 5.0, "ramp": 5.0}}}


def hung(elements: int, dimension: int = 2, EI: float = 0.0, ends: str = "free", **more: Any) -> Mapping:
    pipe = {"EA": EA, "EI": EI, "GJ": 1.0, "mass": 60.0, "outer_diameter": 0.2, "submerged_weight": W}
    stages = (static(), dynamic(4.0, 0.1, motion=HEAVE)) if more.pop("moves", False) else (static(**more),)
    start, end = prescribed(0.0, 0.0, 0.0, rotation=ends), prescribed(SPAN, 0.0, RISE, rotation=ends)
    ends_of: Mapping = {"start": start, "end": end, "dimension": dimension, "gravity": 9.81}
    return riser_scene(*stages, pipe=pipe, length=L, elements=elements, **ends_of)


def catenary(arc: Array) -> tuple[float, Array]:
    """H [N] and places (n, 2) of the elastic catenary (Irvine, Cable Structures, 1981, section 1.3.2)."""

    def at(H: float, V: float, s: Array | float) -> Array:
        """V: upward force at the far end [N]; tension counted from the near end."""
        low = (V - W * L) / H
        x = H * s / EA + H / W * (np.arcsinh(low + W * s / H) - np.arcsinh(low))
        z = s / EA * (V - W * L + 0.5 * W * s) + H / W * (np.hypot(1.0, low + W * s / H) - np.hypot(1.0, low))
        return np.array([x, z])

    H, V = fsolve(lambda u: at(u[0], u[1], L) - [SPAN, RISE], [2e4, 7e4], xtol=1e-14)
    return float(H), at(H, V, arc).T


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_chain_hangs_as_the_catenary(dimension: int) -> None:
    """The chain agrees to fourth order, as curved elements follow it."""
    off = list[float]()
    for elements in (20, 40):
        history = stage_histories(hung(elements, dimension))[0]
        H, places = catenary(np.linspace(0.0, L, elements + 1))
        off.append(float(np.abs(history.position[-1][:, [0, 2]] - places).max()))
        assert history.end.end_force[0] == pytest.approx(H, rel=1e-5)
        assert history.end.bending_moment.max() == history.end.curvature.max() == 0.0
    assert off[1] < 1e-4
    assert off[0] / off[1] > 12.0


@pytest.mark.parametrize("dimension", [2, 3])
def test_bending_fades_out(dimension: int) -> None:
    """A line of hardly any bending stiffness moves as a chain does."""
    chain, line = (stage_histories(hung(40, dimension, EI, moves=True))[1] for EI in (0.0, 1e-6))
    assert distance(np.array(chain.position), np.array(line.position)) < 1e-6


@pytest.mark.parametrize("ends", ["free", "fixed"])
def test_nothing_is_said_of_its_bending(ends: str) -> None:
    assembly = build(scene_from_mapping(hung(20, ends=ends)), MPI.COMM_SELF)
    assert not list(bending_warnings(assembly.riser))


def test_a_moment_on_a_chain_is_refused() -> None:
    scene = hung(20, loads=[{"at": 75.0, "moment": [0.0, 10.0, 0.0]}])
    with pytest.raises(SceneError, match=telling("stages.0.loads.0.moment:", "line type pipe", "no bending stiffness")):
        scene_from_mapping(scene)
