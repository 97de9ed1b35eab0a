"""The axial law of elements that go slack, and its constants."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.riser.slack import law_of
from riser_soil.riser.tension_only import pulled, stored, unfolding
from tests.support.differences import slope

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
