"""Slip lines below a strip against Prandtl, equilibrium, a published fit; the soil's collapse load against them."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.pages import Tell, signed_percent
from tests.support.slip_lines import ROUGH, SMOOTH, bearing_factor, field, forces
from tests.support.strip import CLAY, SU, press_graded_strip

PRANDTL = 2.0 + np.pi


def test_slip_lines_of_constant_strength_are_prandtls() -> None:
    below = np.array([line[-1] for line in field(10, 1.0, SMOOTH, k=0.0)])
    np.testing.assert_allclose(below[:, 2] + 1.0, PRANDTL, rtol=1e-13)
    np.testing.assert_allclose(below[:, 0], -np.linspace(0.0, 1.0, 11), atol=1e-13)


@pytest.mark.parametrize("at_strip", [SMOOTH, ROUGH], ids=["smooth", "rough"])
def test_slip_lines_are_in_equilibrium(at_strip: float) -> None:
    """What the strip loads passes through the field's last line: nothing through the free surface."""
    missing = np.array([_unbalanced(lines, at_strip) for lines in (10, 20, 40)])
    assert np.all(missing[-1] < 1e-3)
    assert np.all(np.log2(missing[:-1] / missing[1:]) > 1.8)


def _unbalanced(lines: int, at_strip: float) -> float:
    """Difference of the forces through the strip and through the last line, over the strip's load."""
    rows = field(lines, 1.5, at_strip)
    strip, last = (forces(np.array(points)).sum(axis=0) for points in ([line[-1] for line in rows], rows[-1]))
    return float(np.linalg.norm(strip - last) / strip[1])


@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
@pytest.mark.parametrize("ratio", [2.0, 6.0])
def test_bearing_factor_converges_at_second_order(ratio: float, rough: bool) -> None:
    coarse, middle, fine = (bearing_factor(ratio, rough, lines) for lines in (10, 20, 40))
    assert 1.8 < np.log2((coarse - middle) / (middle - fine)) < 2.5
    assert abs(middle - fine) < 5e-4


@pytest.mark.parametrize("ratio", [0.5, 2.0, 6.0, 10.0])
def test_bearing_factor_is_near_a_published_fit(ratio: float) -> None:
    """API RP 2GEO (2011), equation A.17, with the coefficients that groundhog's capacity.py has for it."""
    smooth = 1.372 + 0.07 * ratio - np.hypot(0.07 * ratio - 0.128, 0.342)
    rough = 2.56 + 0.457 * ratio - np.hypot(0.457 * ratio + 0.713, 1.38)
    assert bearing_factor(ratio, False, 20) == pytest.approx(smooth, rel=0.015)
    assert bearing_factor(ratio, True, 20) == pytest.approx(rough, rel=0.015)


@pytest.mark.verify
@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
@pytest.mark.parametrize("ratio", [2.0, 6.0])
def test_strip_on_clay_that_grows_stronger_bears_what_slip_lines_tell(tell: Tell, ratio: float, rough: bool) -> None:
    """V/B = F ((2 + π) su0 + k B/4), B = 2 m: from above, at about first order in the cells below it."""
    law = CLAY.model_copy(update={"su_gradient": ratio * SU / 2.0})
    exact = bearing_factor(ratio, rough, 40) * (PRANDTL + 0.25 * ratio)
    sizes = 1.0 / 16.0, 1.0 / 32.0
    pressed = [press_graded_strip(size, 0.25, law, rough=rough, fine=1.0, depth=0.1) for size in sizes]
    errors = np.array([strip.load[-1] for strip in pressed]) / exact - 1.0
    rate, extrapolated = np.log2(errors[0] / errors[1]), 2.0 * errors[1] - errors[0]
    row = f"{signed_percent(errors)} | {rate:.1f} | {signed_percent([extrapolated])}"
    tell({f"growing {ratio:g} {'rough' if rough else 'smooth'}": row})
    assert pressed[1].load[-1] - pressed[1].load[-2] < 1e-3 * exact, "the load still rises"
    assert 0.0 < errors[1] < (0.05 if rough else 0.02)
    assert rate > 0.65
    assert abs(extrapolated) < 0.015
