"""Finite strain within a step: closed forms, what turns, force and tangent as derivatives."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import logm
from scipy.spatial.transform import Rotation

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.soil import mandel
from riser_soil.soil.drucker_prager import DruckerPrager
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises
from tests.support.soil_bench import assemble
from tests.support.soil_cases import CLAY, KINDS, distorted, moved, small_block

SU = 4.0e3
SAND = DruckerPrager(
    kind="drucker-prager", friction_angle_deg=32.0, dilation_angle_deg=5.0, cohesion=1.0e3, E=2.0e7, nu=0.3
)
ROOT = np.sqrt(2.0)


def of(kind: Any, law: Any = CLAY, moves: bool = True, skewed: bool = True) -> Soil:
    grid = small_block(kind)
    return Soil(distorted(grid) if skewed else grid, law, level=0.0, unit_weight=0.0, moves=moves)


def brought(soil: Soil, F: Array) -> State:
    """The state in which all nodes have moved by a deformation gradient (3, 3)."""
    u = (soil.points @ (F - np.eye(3)).T).ravel()
    return State(1.0, u, u, u)


def force(soil: Soil, state: State) -> Array:
    forces = Forces.zeros(soil.field.size)
    soil.residual(state, forces)
    return forces.end


def stretched(log: Array, turn: Array | None = None) -> Array:
    """F of principal logarithmic strains, turned thereafter."""
    turned = np.eye(3) if turn is None else Rotation.from_rotvec(turn).as_matrix()
    return np.asarray(turned @ np.diag(np.exp(log)))


@pytest.mark.parametrize("kind", KINDS)
def test_strain_is_logarithmic_but_for_third_order(kind: str) -> None:
    """Exactly in volume; deviators off by two thirds of the strain cubed."""
    soil, shear = of(kind), np.array([[1.0, 0.2, 0.0], [0.0, 1.0, -0.1], [0.1, 0.0, 1.0]])
    for F in (stretched(np.array([0.03, -0.05, 0.01])), shear):
        exact = np.real(0.5 * logm(F.T @ F))
        found = soil.cells.strain(brought(soil, F).u)
        np.testing.assert_allclose(3.0 * mandel.mean(found), np.log(np.linalg.det(F)), rtol=1e-11, atol=1e-14)
        wanted = [exact[0, 0], exact[1, 1], exact[2, 2], ROOT * exact[0, 1], ROOT * exact[0, 2], ROOT * exact[1, 2]]
        assert np.abs(found - wanted).max() < np.linalg.norm(exact) ** 3


@pytest.mark.parametrize("kind", KINDS)
def test_what_turns_does_not_strain_and_forces_turn_along(kind: str) -> None:
    soil, log, turn = of(kind, VonMises(kind="von-mises", su=SU, E_over_su=300.0).at_points), [0.02, 0.01, -0.04], 1.1
    axis = turn * np.array([2.0, -1.0, 2.0]) / 3.0
    straight, turned = (stretched(np.array(log), by) for by in (None, axis))
    first = force(soil, brought(soil, straight)).reshape(-1, 3)
    found = force(soil, brought(soil, turned)).reshape(-1, 3)
    R = Rotation.from_rotvec(axis).as_matrix()
    np.testing.assert_allclose(found, first @ R.T, atol=1e-9 * np.abs(first).max())


@pytest.mark.parametrize("height", [0.7, 0.9, 1.2])
def test_clay_squeezed_in_one_step_bears_its_strength_on_the_width_that_it_has_then(height: float) -> None:
    """In plane strain at constant volume it is 1/height times as wide as at first. The strain ¼(λ² − λ⁻²) grows by
    ½(λ² + λ⁻²), 1 + 2 ln² λ, where the logarithm grows by 1.
    """
    law = VonMises(kind="von-mises", su=SU, E_over_su=1.0e5)
    soil = of("hex", law.at_points, skewed=False)
    on_top = np.flatnonzero(soil.points[:, 2] > soil.points[:, 2].max() - 1e-9)
    area = np.prod(np.ptp(soil.points[on_top], axis=0)[:2])
    found = force(soil, brought(soil, np.diag([1.0, 1.0 / height, height]))).reshape(-1, 3)[on_top, 2].sum() / area
    more = 0.5 * (height**2 + height**-2)
    assert found == pytest.approx(more * SU / height * np.sign(height - 1.0), rel=1e-6)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", [CLAY, SAND.at_points], ids=["clay", "sand"])
def test_the_tangent_is_the_slope_of_the_force(kind: str, law: Any) -> None:
    soil = of(kind, law)
    first = moved(soil, 2e-3, seed=1)
    soil.commit(first)
    soil.field.commit(first)
    pressed, scale = brought(soil, 0.85 * np.eye(3)).u, 1e-7  # away from the apex of sand
    state = replace(moved(soil, 8e-3, seed=2), u=pressed + moved(soil, 8e-3, seed=2).u)
    tangent, linear = assemble(soil, state), assemble(of(kind, law, moves=False), state)
    for seed in range(3):
        direction = moved(soil, 1.0, seed=10 + seed).u
        ahead, behind = (force(soil, replace(state, u=state.u + s * scale * direction)) for s in (1.0, -1.0))
        numeric = (ahead - behind) / (2.0 * scale)
        assert np.linalg.norm(tangent @ direction - numeric) < 1e-7 * np.linalg.norm(numeric)
        assert np.linalg.norm(linear @ direction - numeric) > 1e-2 * np.linalg.norm(numeric)
    if soil.law.symmetric:
        assert abs(tangent - tangent.T).max() < 1e-12 * abs(tangent).max()


@pytest.mark.parametrize("kind", KINDS)
def test_the_force_is_the_slope_of_the_energy(kind: str) -> None:
    soil = of(kind, LinearElastic(kind="linear-elastic", E=1.2e6, nu=0.4).at_points)
    state, direction = moved(soil, 1e-2), moved(soil, 1.0, seed=3).u
    ahead, behind = (soil.energy(replace(state, u=state.u + s * 1e-5 * direction)).total for s in (1, -1))
    assert (ahead - behind) / 2e-5 == pytest.approx(float(force(soil, state) @ direction), rel=1e-6)


def test_a_cell_turned_inside_out_has_no_strain() -> None:
    soil = of("hex")
    assert np.isnan(soil.cells.strain(brought(soil, np.diag([1.0, 1.0, -0.5])).u)[:, :3]).all()


@pytest.mark.parametrize("kind", KINDS)
def test_the_tangent_has_no_memory_but_of_what_it_may_keep(kind: str) -> None:
    soil = of(kind)
    for state in (moved(soil, 5e-3), State.at_rest(1.0, soil.field.size), moved(soil, 1e-3, seed=7)):
        found, wanted = assemble(soil, state), assemble(of(kind), state)
        assert abs(found - wanted).max() < 1e-3 * abs(wanted).max()
