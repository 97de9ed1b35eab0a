"""Capacity of a pipe wished in place, smooth and rough, from two meshes, against slip lines, a published fit and
published bounds.
"""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from tests.support.pages import Tell
from tests.support.pipe_in_place import chord, pipe_in_place, resistance, rough_by_slip_lines, smooth_by_slip_lines

PRANDTL = 2.0 + np.pi
FEW, MORE = (9, 19), (13, 27)  # strips of the groove
WITHIN, COARSE, FALLS = 0.04, 0.03, 3e-3  # shares of the capacity
#: By w/D and roughness, V/(D su) from limit analyses, below and above; as they have been told, the source not at hand.
BOUNDS = {
    (0.1, False): (2.67, 2.80),
    (0.3, False): (3.77, 3.96),
    (0.1, True): (3.00, 3.09),
    (0.5, True): (5.51, np.inf),
}


def fitted(w: float, rough: bool) -> float:
    """V/(D su) = a (w/D)^b, w <= D/2, fitted by Aubeny, Shi & Murff (2005) to finite elements; a, b from memory."""
    return 6.73 * w**0.29 if rough else 4.97 * w**0.23


def fallen(load: Array) -> float:
    """By how much the load ever falls below what it has been, over its peak."""
    return float(np.max(np.maximum.accumulate(load) - load) / load.max())


@pytest.mark.parametrize("w", [0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5])
def test_slip_lines_lie_between_what_is_known(w: float) -> None:
    """Prandtl's strip on the chord is the most that a smooth and the least that a rough pipe bears by them."""
    strip = PRANDTL * chord(w)
    assert smooth_by_slip_lines(w) < strip
    assert rough_by_slip_lines(w) >= strip
    assert (rough_by_slip_lines(w) == pytest.approx(strip, rel=1e-12)) == (w < 0.1465)
    assert smooth_by_slip_lines(w) == pytest.approx(_summed(w), rel=1e-6)


def test_a_half_buried_pipe_by_hand() -> None:
    assert smooth_by_slip_lines(0.5) == pytest.approx(4.0)
    assert rough_by_slip_lines(0.5) == pytest.approx(1.0 + 0.5 * np.pi + 2.0 * np.sqrt(2.0))


def test_extrapolation_of_both_orders() -> None:
    for order in (1, 2):
        coarse, fine = (4.0 + 3.0 * float(n) ** -order for n in FEW)
        assert extrapolated(coarse, fine, FEW)[order - 1] == pytest.approx(4.0, rel=1e-12)


def _summed(w: float) -> float:
    """The pressure on a smooth pipe, summed over the surface in contact by the midpoint rule."""
    end, n = float(np.arccos(1.0 - 2.0 * w)), 4000
    angle = (np.arange(n) + 0.5) * end / n
    return float(np.sum((PRANDTL - 2.0 * angle) * np.cos(angle)) * end / n)


@pytest.mark.verify
@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
@pytest.mark.parametrize("w", [0.1, 0.2, 0.3, 0.4, 0.5])
def test_capacity_from_two_meshes(tell: Tell, w: float, rough: bool) -> None:
    """Midway between what first and second order make of them, rough by adhesion. A smooth pipe's load falls a little
    behind its peak.
    """
    strips = FEW if w < 0.35 else MORE
    loads = [resistance(pipe_in_place(w, n, rough)) for n in strips]
    coarse, fine = (float(load.max()) for load in loads)
    first, second = extrapolated(coarse, fine, strips)
    capacity = 0.5 * (first + second)
    between = dict.fromkeys(f"{each:.2f}" for each in sorted((first, second)))
    row = f"{coarse:.2f}, {fine:.2f} | {' to '.join(between)}"
    tell({f"in place {w:g} {'rough' if rough else 'smooth'}": row})
    known = rough_by_slip_lines(w) if rough else smooth_by_slip_lines(w), fitted(w, rough)
    assert (1.0 - WITHIN) * min(known) < capacity < (1.0 + WITHIN) * max(known)
    low, high = BOUNDS.get((w, rough), (0.0, np.inf))
    assert low < capacity < high
    assert abs(coarse / capacity - 1.0) < COARSE
    assert fallen(loads[-1]) < FALLS


def extrapolated(coarse: float, fine: float, strips: tuple[int, int]) -> tuple[float, float]:
    """To cells without size, by the first and by the second order."""
    ratio = strips[1] / strips[0]
    first, second = (fine + (fine - coarse) / (ratio**order - 1.0) for order in (1, 2))
    return first, second
