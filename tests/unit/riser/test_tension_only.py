"""The axial law of elements that go slack, and its constants."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.riser import tension_only
from riser_soil.riser.slack import law_of
from riser_soil.riser.tension_only import Linear, SlackElement, TensionOnly
from tests.support.differences import slope

pytestmark = pytest.mark.usefixtures("uncompiled")

SLACK = SlackElement(share=0.03, soft=0.2, fold=5.0)
BENDS = SlackElement(share=1.0, soft=1.0, fold=0.0)
STRAINS = (-0.9, -0.5, -0.15, 0.0, 0.07, 0.2, 0.5)  # slack, in between and taut
pulled, stored = (each.kernels[SlackElement] for each in (tension_only.pulled, tension_only.stored))
with_fold, with_fold_change, with_fold_energy = (
    each.kernels[SlackElement]
    for each in (tension_only.with_fold, tension_only.with_fold_change, tension_only.with_fold_energy)
)


@pytest.mark.parametrize("strain", STRAINS)
def test_the_pull_is_the_derivative_of_what_is_stored(strain: float) -> None:
    pull, stiffness = pulled(SLACK, strain)
    assert pull == pytest.approx(slope(lambda s: np.array(stored(SLACK, strain + s)), 1e-3), rel=1e-8)
    assert stiffness == pytest.approx(slope(lambda s: np.array(pulled(SLACK, strain + s)[0]), 1e-3), rel=1e-8)


def test_taut_it_is_linear_and_slack_it_pulls_weakly() -> None:
    for strain in (0.3, 1.0):
        assert pulled(SLACK, strain) == (strain, 1.0)
        assert stored(SLACK, strain) - stored(SLACK, 0.3) == pytest.approx(0.5 * (strain**2 - 0.09))
    for strain in (-0.9, -0.3):
        assert pulled(SLACK, strain) == (0.03 * (1.0 + strain), 0.03)
        assert stored(SLACK, strain) == pytest.approx(0.5 * 0.03 * (1.0 + strain) ** 2)
    everywhere = np.linspace(-0.999, 1.0, 500)
    pulls = np.array([pulled(SLACK, strain) for strain in everywhere])
    assert pulls.min() > 0.0
    assert np.abs(np.diff(pulls, axis=0)).max() < 0.02


def test_an_element_that_bends_bears_compression() -> None:
    """On a line of its own, and on one with chain."""
    for kind, law in ((SlackElement, BENDS), (Linear, Linear())):
        assert tension_only.pulled.kernels[kind](law, -0.4) == (-0.4, 1.0)
        assert tension_only.stored.kernels[kind](law, -0.4) == 0.5 * 0.4**2
        assert tension_only.with_fold.kernels[kind](law, -0.4, 0.3) == -0.4
        assert tension_only.with_fold_change.kernels[kind](law, -0.4, 2.0, 0.3, 0.1) == -0.4
        assert tension_only.with_fold_energy.kernels[kind](law, -0.4, 0.3) == -0.4


def test_what_unfolds_is_the_derivative_of_its_energy() -> None:
    force = with_fold(SLACK, 7.0, 0.3) - 7.0
    assert force == pytest.approx(slope(lambda s: np.array(with_fold_energy(SLACK, 2.0, 0.3 + s)), 1e-3), rel=1e-8)
    change = slope(lambda s: np.array(with_fold(SLACK, 7.0, 0.3 + s)), 1e-3)
    assert with_fold_change(SLACK, 7.0, 2.0, 0.3, 0.1) == pytest.approx(7.0 + 2.0 * 0.1 * change, rel=1e-8)


def test_a_slack_element_pulls_by_a_ten_thousandth_of_the_lines_weight() -> None:
    """The first of 4 elements of 5 m and 200 N/m bends."""
    bends = np.array([True, False, False, False])
    law = law_of(bends, np.full(4, 200.0), np.full(4, 5.0), np.full(4, 1e8))
    assert isinstance(law, TensionOnly)
    share, soft, fold = law
    assert (share[0], soft[0], fold[0]) == (1.0, 1.0, 0.0)
    assert share[1:] * 1e8 == pytest.approx(1e-4 * 4000.0)
    assert soft[1:] == pytest.approx(0.1 * 1000.0 / 1e8)
    assert fold[1:] == pytest.approx(500.0 * 1000.0)


def test_a_line_that_bends_all_over_has_no_constants() -> None:
    assert law_of(np.full(3, True), np.full(3, 200.0), np.full(3, 5.0), np.full(3, 1e8)) == Linear()
