"""The hose of the tank at rest against the elastica on a rigid floor and on springs: the penalty's error apart from the
mesh's.
"""

from __future__ import annotations

from dataclasses import astuple, fields
from pathlib import Path

import numpy as np
import pytest

from demos.compute import compute
from demos.tank.statics import ELEMENTS, METHODS, STIFFNESSES, Rest, at_rest, mesh_errors, orders, reference
from tests.support.touchdown_reference import AtRest, Hose, Rigid, Winkler

WEIGHT = 147.09975
ANGLES = (0.0, 20.0, -20.0)


def hose(angle_deg: float = 0.0) -> Hose:
    angle = np.radians(angle_deg)
    return Hose(1.0e6, 1.0e3, WEIGHT, 40.0, (28.0 + 2.0 * np.sin(angle), 17.0 - 2.0 * np.cos(angle)))


def springs(k: float, start: Rigid | None = None) -> AtRest:
    return Winkler(hose(), k, 0.1 * WEIGHT / k, start).at_rest


def rest(state: AtRest) -> Rest:
    return Rest(*(getattr(state, each.name) for each in fields(Rest)))


def test_rigid_reference_balances_moments() -> None:
    """About the touchdown point, of the top's force and of the hanging part's weight; bending leaves the floor with
    a kink of the curvature, R/EI.
    """
    rigid, given = Rigid(hose()), hose()
    V = given.w * (given.length - rigid.s0) - rigid.R
    x0 = rigid.s0 * (1.0 + rigid.H / given.EA)
    xi, weight = np.polynomial.legendre.leggauss(60)
    x = rigid.solution.sol(0.5 + 0.5 * xi)[0]
    hanging = given.w * (given.length - rigid.s0)
    pull = rigid.H * given.top[1] - V * (given.top[0] - x0) + hanging * 0.5 * float(weight @ (x - x0))
    assert abs(pull) < 1e-7 * V * given.top[0]
    kink = float(rigid.solution.sol(1e-6)[3]) / (1e-6 * (given.length - rigid.s0))
    assert kink == pytest.approx(rigid.R * (1.0 + rigid.H / given.EA), rel=1e-4)


def test_springs_close_on_the_rigid_floor() -> None:
    """With the order 3/4 in the stiffness, as the depth -R/(6 EI b³) of the hanging part's straight continuation to the
    touchdown point, where the order of its contact's end, 1/b, is 1/4. b⁴ = k/(4 EI).
    """
    rigid = Rigid(hose())
    k = np.array([1e6, 1e7, 1e8, 1e9])
    beds = [Winkler(hose(), each, 0.1 * WEIGHT / each, rigid) for each in k]
    H = np.array([bed.H / rigid.H - 1.0 for bed in beds])
    end = np.array([bed.contact_end - rigid.s0 for bed in beds])
    assert orders(k, H) == pytest.approx(0.75, abs=0.05)
    assert orders(k, end) == pytest.approx(0.25, abs=0.01)
    touchdown = np.array([bed.at_rest.touchdown - rigid.s0 for bed in beds])
    assert np.all(np.abs(touchdown) < [3e-5, 3e-6, 3e-6, 1e-6])


def test_written_reference_is_what_the_boundary_value_problems_give() -> None:
    rigid, beds = reference()
    for angle in ANGLES:
        assert astuple(rigid[angle]) == pytest.approx(astuple(rest(Rigid(hose(angle)).at_rest)), rel=2e-7)
    start = Rigid(hose())
    for k in STIFFNESSES:
        assert astuple(beds[k]) == pytest.approx(astuple(rest(springs(k, start))), rel=2e-7)


def test_line_contact_finds_the_springs(tmp_path: Path) -> None:
    """Elements of 0.2 m, a bed whose layer is 0.14 m long."""
    assert np.abs(at_rest(tmp_path, 200, 1e7).errors(reference()[1][1e7])).max() < 1e-4


@pytest.mark.parametrize("angle", ANGLES)
def test_stiff_line_contact_finds_the_rigid_floor(angle: float, tmp_path: Path) -> None:
    state = at_rest(tmp_path, 400, 1e9, "line", angle)
    assert np.abs(state.errors(reference()[0][angle])).max() < 1e-4


def test_corner_of_a_millimetre_lifts_the_hose() -> None:
    """A rounding s far beyond the depth at rest holds it at a height of s - 2 sqrt(s w/k): all heights are less."""
    k, s = 1e9, 1e-3
    lifted = Winkler(hose(), k, s)
    height = lifted.solution.sol(10.0)[1] * lifted.unit
    assert height == pytest.approx(s - 2.0 * np.sqrt(s * WEIGHT / k), rel=1e-6)
    slackened = lifted.H / Rigid(hose()).H - 1.0
    assert slackened == pytest.approx(-7.5e-4, abs=2e-5)


@pytest.mark.verify
@pytest.mark.parametrize("stiffness", STIFFNESSES)
@pytest.mark.parametrize("method", METHODS)
def test_convergence_in_elements(method: str, stiffness: float, tmp_path: Path) -> None:
    """Errors change their signs on the way, with the place of the contact's end within an element; hence fits."""
    errors = np.abs(mesh_errors(tmp_path, method, ELEMENTS, stiffness))
    fitted = orders(ELEMENTS, errors)
    H, tension, touchdown, moment = errors[ELEMENTS.index(200)]
    if method == "line":
        assert np.all(fitted > 1.9), fitted
        assert max(H, tension, moment, touchdown) < 1e-4
        assert errors[-1].max() < 5e-6
    else:  # the touchdown point is as near on 50 elements as on 400, and has no order
        assert np.all(fitted[[0, 1, 3]] > 1.6), fitted
        assert errors[:, 2].max() < 1e-2
        assert max(H, tension, moment) < 1e-3
        assert touchdown < 5e-3


@pytest.mark.verify
def test_swinging_hose_touches_down_where_no_stiffness_tells(tmp_path: Path) -> None:
    """A bed ten times softer lets the force end 0.15 m farther on; the touchdown point stays within 2 mm, and moves
    smoothly.
    """
    scene = Path(__file__).parents[1] / "scenes/tank.yaml"
    soft, stiff = (
        compute(scene, tmp_path / k, f"contact.stiffness={k}", "contact.smoothing=1.0e-4", "stages.1.duration=15.0")
        for k in ("1.0e5", "1.0e6")
    )
    first, second = soft["touchdown_arc"], stiff["touchdown_arc"]
    assert np.ptp(second) > 0.5
    assert np.abs(first - second).max() < 2e-3
    assert np.abs(np.diff(second[1:], 2)).max() < 0.01
