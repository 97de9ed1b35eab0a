"""Scales of pictures end at round numbers: of colours, and by how much the soil is magnified."""

import numpy as np
import pytest

from riser_soil.plots.scales import colour_scale, magnification


@pytest.mark.parametrize(
    ("largest", "scale"), [(1531.0, (1600.0, 5)), (3.0, (3.0, 4)), (0.0095, (0.01, 6)), (0.0, (1.0, 2))]
)
def test_colour_scales_end_at_round_numbers(largest: float, scale: tuple[float, int]) -> None:
    assert colour_scale(np.array([0.0, largest])) == pytest.approx(scale)


@pytest.mark.parametrize(
    ("largest", "factor"), [(0.04, 5.0), (0.00137, 100.0), (0.25, 1.0), (3.0, 1.0), (0.0, 1.0)]
)
def test_soil_is_magnified_by_a_round_factor(largest: float, factor: float) -> None:
    assert magnification(largest, depth=2.5) == factor
