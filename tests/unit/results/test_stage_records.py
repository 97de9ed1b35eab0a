"""Quantities derived from a run's files."""

from pathlib import Path

import numpy as np
import pytest

from riser_soil.results import Run
from riser_soil.results.stage_records import along, peak, reactions
from tests.support.recorded_run import WEIGHT, Catenary, record


def test_peak_of_a_parabola_is_exact_on_uneven_samples() -> None:
    x = np.array([0.0, 0.3, 1.0, 1.4, 2.0])
    q = np.stack([5.0 - 2.0 * (x - c) ** 2 for c in (0.4, 1.1, 1.3)])
    assert peak(x, q) == pytest.approx(np.full(3, 5.0))


def test_peak_is_third_order_or_better() -> None:
    """e^x sin 2x peaks where tan 2x = -2."""
    top = 0.5 * (np.pi - np.arctan(2.0))
    errors = []
    for n in (20, 40, 80):
        x = np.linspace(0.0, 2.0, n)
        errors.append(abs(float(peak(x, np.exp(x) * np.sin(2.0 * x))) - np.exp(top) * np.sin(2.0 * top)))
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > 2.5)


@pytest.mark.parametrize("q", [[3.0, 2.0, 1.0], [1.0, 2.0, 3.0], [2.0, 2.0, 2.0]])
def test_peak_at_an_end_or_of_a_constant_is_the_sample(q: list[float]) -> None:
    assert float(peak(np.arange(3.0), np.array(q))) == max(q)


def test_along_the_chord() -> None:
    assert along(np.array([[1.0, 1.0, 0.0], [0.0, 0.0, 3.0], [1.0, -2.0, 9.0]])) == pytest.approx([0.0, -1.0, 0.0])
    assert along(np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 3.0]])) == pytest.approx([1.0, 0.0, 0.0])


def test_reactions_pull_the_riser_taut(tmp_path: Path) -> None:
    record(tmp_path)
    forces = reactions(Run(tmp_path))
    line = Catenary(32.0, 30.0)
    assert forces.H1[0] == pytest.approx(WEIGHT * line.a)
    assert forces.H2[0] == pytest.approx(WEIGHT * line.a)
    assert [forces.V1[0], forces.V2[0]] == pytest.approx([0.0, WEIGHT * (148.0 - line.s0)])
