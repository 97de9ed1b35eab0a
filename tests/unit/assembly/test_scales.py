"""Characteristic scales of a riser: of lines whose weight, diameter and stiffness are known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.assembly.scales import scales_of
from riser_soil.riser.sections import Elements, joined
from tests.support.pipes import pipe

EA, LENGTH = 2.0e8, 50.0


def line(*weights: float, EI: float = 0.0, diameter: float = 0.0) -> Elements:
    """Segments of ten elements each, LENGTH long altogether."""
    given: dict[str, Any] = {"EA": EA, "EI": EI, "outer_diameter": diameter}
    return joined([pipe(LENGTH / len(weights), 10, **given, submerged_weight=w) for w in weights])


def test_the_heaviest_or_most_buoyant_segment_tells_the_weight() -> None:
    assert scales_of(line(100.0, 30.0)).weight == 100.0
    assert scales_of(line(100.0, -300.0)).weight == 300.0


def test_what_weighs_nothing_has_a_weight_that_strains_it_by_a_millionth() -> None:
    assert scales_of(line(0.0)).weight == pytest.approx(1e-6 * EA / LENGTH)


def test_the_thickest_segment_tells_the_diameter() -> None:
    both = [pipe(10.0, 2, EA=EA, EI=1e4, outer_diameter=D) for D in (0.2, 0.3)]
    assert scales_of(joined(both)).diameter == 0.3


def test_without_a_diameter_it_is_that_of_a_solid_bar() -> None:
    """A bar of 0.1 m: EA = E pi D^2/4, EI = E pi D^4/64."""
    E = EA / (np.pi * 0.1**2 / 4.0)
    assert scales_of(line(1.0, EI=E * np.pi * 0.1**4 / 64.0)).diameter == pytest.approx(0.1)
    assert scales_of(line(1.0)).diameter == pytest.approx(LENGTH / 1000.0), "a chain"


def test_forces_that_count_as_zero_are_some_roundings_of_the_stiffness() -> None:
    """More would hide the small loads of stiff lines, less be below what the residual is known to."""
    rounding = np.finfo(float).eps * EA
    assert 10.0 * rounding < scales_of(line(1.0)).force_floor < 100.0 * rounding
