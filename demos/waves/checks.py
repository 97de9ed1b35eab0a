"""Checks of the storm: riser_soil's results against a cable, the weight, and the vessel's motion worked out anew."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import trapezoid

from demos.page import table
from demos.waves.rao import responses
from riser_soil.core.arrays import Array
from riser_soil.results import Run
from riser_soil.sea.spectra import components as jonswap_waves

# What the scene says.
GRAVITY, WATER, CONTENTS, SURFACE = 9.81, 1025.0, 800.0, 120.0
FLEXIBLE, BUOYANT = (0.26, 0.20, 85.0), (0.55, 0.20, 165.0)  # outer and inner diameter [m], mass [kg/m]
BUOYANT_LENGTH = 45.0
HS, TP, GAMMA, HEADING = 6.0, 13.0, 2.0, np.radians(195.0)
COMPONENTS, SEED = 100, 1
MIDSHIP, ARM = np.array([20.0, 0.0, 120.0]), np.array([130.0, 0.0, 6.0])  # m, and from there to the turret

Check = tuple[str, str, float, float]


def weight(kind: tuple[float, float, float], submerged: bool) -> float:
    """N/m of a flooded pipe."""
    outer, inner, mass = kind
    filled = mass + CONTENTS * np.pi * inner**2 / 4.0
    return float(GRAVITY * (filled - submerged * WATER * np.pi * outer**2 / 4.0))


def at_rest(run: Run) -> Iterator[Check]:
    """A scene without waves and current: the cable between sag bend and hang-off, and the weight on its supports."""
    position, tension = run["position"][0], run["effective_tension"][0]
    force = run["end_force"][0]
    arc, z = run.arc, position[:, 2]
    sag = (arc > 115.0) & (arc < 160.0)
    low = arc[sag][z[sag].argmin()]
    fit = np.polyfit(arc[np.abs(arc - low) < 6.0], z[np.abs(arc - low) < 6.0], 2)
    lowest, bottom = -fit[1] / (2.0 * fit[0]), fit[2] - fit[1] ** 2 / (4.0 * fit[0])
    wet = float(np.interp(SURFACE, z[arc > lowest], arc[arc > lowest]))
    w, dry = weight(FLEXIBLE, True), weight(FLEXIBLE, False)
    hanging = w * (wet - lowest) + dry * (arc[-1] - wet)
    yield "vertical force at the turret, weight from the lowest point up", "kN", force[2] / 1e3, hanging / 1e3
    cable = force[0] + w * (SURFACE - bottom) + dry * (z[-1] - SURFACE)
    yield "tension at the turret, H + weight × height as of a cable", "kN", tension[-1] / 1e3, cable / 1e3
    whole = w * (wet - BUOYANT_LENGTH) + weight(BUOYANT, True) * BUOYANT_LENGTH + dry * (arc[-1] - wet)
    supported = run["start_force"][0] + force + run["contact_force_sum"][0]
    yield "vertical forces of supports and seabed, weight of the whole riser", "kN", supported[2] / 1e3, whole / 1e3


def in_waves(run: Run, since: float) -> Iterator[Check]:
    """Standard deviations of the turret's motion: from the formulas behind rao.csv, for this very sea wave by wave, and
    for all seas with its spectrum.
    """
    window = run.time >= since
    moved = run["position"][window, -1].std(axis=0)
    for against, expected in (("this sea", answer(run.time[window]).std(axis=1)), ("its spectrum", deviations())):
        for name, value, other in zip(("x", "y", "z"), moved, expected, strict=True):
            yield f"standard deviation of the turret's {name}, {against}", "m", float(value), float(other)


def deviations() -> Array:
    """(3,) m: square root of the integral of |RAO|^2 S over all frequencies."""
    w = 2.0 * np.pi / TP * np.linspace(0.5, 5.0, 4000)
    return np.asarray(np.sqrt(trapezoid(np.abs(turret(w)) ** 2 * jonswap(w), w, axis=1)))


def answer(t: Array) -> Array:
    """Displacements (3, nt) [m] of the turret at t (nt,) [s] to the waves of the scene's sea, to first order."""
    sea = jonswap_waves(HS, TP, GAMMA, COMPONENTS, SEED, HEADING, GRAVITY, SURFACE)
    ahead = sea.wave_number * (MIDSHIP[0] * np.cos(sea.direction) + MIDSHIP[1] * np.sin(sea.direction)) + sea.phase
    waves = sea.amplitude[:, None] * np.exp(1j * (sea.frequency[:, None] * t - ahead[:, None]))
    return np.asarray((turret(sea.frequency) @ waves).real)


def turret(w: Array) -> Array:
    """Complex responses (3, n) [m/m] of the turret to exp(i w t) at midship, w (n,) [rad/s]."""
    response = responses(w, HEADING)
    return response[:3] + np.cross(response[3:], ARM, axisa=0, axisb=0, axisc=0)


def jonswap(w: Array) -> Array:
    """One-sided spectrum [m2 s/rad], normalised as in DNV-RP-C205 (2010), section 3.5.5."""
    peak = 2.0 * np.pi / TP
    width = np.where(w <= peak, 0.07, 0.09)
    bump = GAMMA ** np.exp(-0.5 * ((w / peak - 1.0) / width) ** 2)
    return (1.0 - 0.287 * np.log(GAMMA)) * 5.0 / 16.0 * HS**2 * peak**4 / w**5 * np.exp(-1.25 * (peak / w) ** 4) * bump


def page(checks: list[Check]) -> str:
    """The checks as Markdown."""
    rows = []
    for name, unit, value, expected in checks:
        difference = f"{100.0 * (value / expected - 1.0):.2f} %"
        rows.append([f"{name} [{unit}]", f"{value:.4g}", f"{expected:.4g}", difference])
    return table(["quantity, and what it is compared with", "found", "expected", "difference"], rows)
