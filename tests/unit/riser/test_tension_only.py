"""Elements that go slack: their axial law, and forces and tangents of elements under it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.riser.slack import law_of
from riser_soil.riser.tension_only import pulled, stored, unfolding
from tests.support import planar_elements, spatial_elements
from tests.support.differences import slope
from tests.unit.riser.test_beam_elements import NE, TOLERANCE, derivative, difference, loaded_space, plane

SHARE, SOFT = 0.03, 0.2
STRAINS = (-0.9, -0.5, -0.15, 0.0, 0.07, 0.2, 0.5)  # slack, in between and taut


@pytest.mark.parametrize("strain", STRAINS)
def test_the_pull_is_the_derivative_of_what_is_stored(strain: float) -> None:
    pull, stiffness = pulled(strain, SHARE, SOFT)
    assert pull == pytest.approx(slope(lambda s: np.array(stored(strain + s, SHARE, SOFT)), 1e-3), rel=1e-8)
    assert stiffness == pytest.approx(slope(lambda s: np.array(pulled(strain + s, SHARE, SOFT)[0]), 1e-3), rel=1e-8)


def test_taut_it_is_linear_and_slack_it_pulls_weakly() -> None:
    for strain in (0.3, 1.0):
        assert pulled(strain, SHARE, SOFT) == (strain, 1.0)
        assert stored(strain, SHARE, SOFT) - stored(0.3, SHARE, SOFT) == pytest.approx(0.5 * (strain**2 - 0.09))
    for strain in (-0.9, -0.3):
        assert pulled(strain, SHARE, SOFT) == (SHARE * (1.0 + strain), SHARE)
        assert stored(strain, SHARE, SOFT) == pytest.approx(0.5 * SHARE * (1.0 + strain) ** 2)
    everywhere = np.linspace(-0.999, 1.0, 500)
    pulls = np.array([pulled(strain, SHARE, SOFT) for strain in everywhere])
    assert pulls.min() > 0.0
    assert np.abs(np.diff(pulls, axis=0)).max() < 0.02


def test_an_element_that_bends_bears_compression() -> None:
    assert pulled(-0.4, 1.0, 1.0) == (-0.4, 1.0)
    assert stored(-0.4, 1.0, 1.0) == 0.5 * 0.4**2


def test_what_unfolds_is_the_derivative_of_its_energy() -> None:
    force, stiffness = unfolding(0.3, 5.0)
    assert force == pytest.approx(slope(lambda s: np.array(5.0 * (0.3 + s) ** 3 / 3.0), 1e-3), rel=1e-8)
    assert stiffness == pytest.approx(slope(lambda s: np.array(unfolding(0.3 + s, 5.0)[0]), 1e-3), rel=1e-8)


def test_a_slack_element_pulls_by_a_ten_thousandth_of_the_lines_weight() -> None:
    """Of 4 elements of 5 m and 200 N/m the first bends."""
    bends = np.array([True, False, False, False])
    share, soft, fold = law_of(bends, np.full(4, 200.0), np.full(4, 5.0), np.full(4, 1e8))
    assert (share[0], soft[0], fold[0]) == (1.0, 1.0, 0.0)
    assert share[1:] * 1e8 == pytest.approx(1e-4 * 4000.0)
    assert soft[1:] == pytest.approx(0.1 * 1000.0 / 1e8)
    assert fold[1:] == pytest.approx(500.0 * 1000.0)


def going_slack(elements: Any, shorter: float, soft: float, fold: float) -> Any:
    """Elements in space or in a plane, their chords shortened."""
    constants = {"share": np.full(NE, SHARE), "soft": np.full(NE, soft), "fold": np.full(NE, fold)}
    return elements._replace(section=elements.section._replace(**constants), chord=shorter * elements.chord)


@pytest.mark.parametrize(("shorter", "soft"), [(0.96, 0.3), (0.6, 0.05)], ids=["in between", "slack"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_forces_and_tangent_follow_from_the_energy(dimension: int, shorter: float, soft: float) -> None:
    """And would not without any of the three constants."""
    build, module, n = (plane, planar_elements, 6) if dimension == 2 else (loaded_space, spatial_elements, 12)
    elements = going_slack(build(0.0, 0.4), shorter, soft, 2e5)
    assert difference(elements.call(module.forces), derivative(elements.energy, n)) < TOLERANCE

    def forces(moved: Array) -> Array:
        return np.asarray(elements.call(module.forces, moved))

    f, K = elements.call(module.forces_and_tangent)
    assert difference(f, forces(np.zeros((NE, n)))) < 1e-14
    assert difference(K, derivative(forces, n)) < TOLERANCE
    for constant, value in (("share", 1.0), ("soft", 2.0 * soft + 0.5), ("fold", 0.0)):
        other = elements._replace(section=elements.section._replace(**{constant: np.full(NE, value)}))
        assert difference(other.call(module.forces_and_tangent)[1], K) > 1e3 * TOLERANCE
