"""Response amplitude operators of a made-up FPSO; `python -m demos.waves.rao` writes rao.csv beside this file.

Illustrative: a box of 260 m by 46 m, 16 m deep in the water, without forward speed. Heave and pitch are by the closed
forms of Jensen, Mansour & Olsen (Ocean Engineering 31 (2004) 61-85); surge and sway follow the water averaged over the
length; roll is a damped oscillator driven by the wave's slope. Directions are those of riser_soil: 0 from astern, 180
from ahead.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from riser_soil.core.arrays import Array

FILE = Path(__file__).parent / "rao.csv"
LENGTH, BREADTH, DRAUGHT, GRAVITY = 260.0, 46.0, 16.0, 9.81
ROLL_PERIOD, ROLL_DAMPING = 14.0, 0.1  # s, part of critical
PERIODS = np.array([2.5, 3.0, 3.5, 4.0, 4.5, *np.arange(5.0, 16.1, 0.5), 17.0, 18.0, 20.0, 22.0, 25.0, 30.0])
DIRECTIONS = (150.0, 165.0, 180.0, 195.0, 210.0)
MODES = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def responses(w: Array, direction: float) -> Array:
    """Complex responses (6, n) [m/m, rad/m] to exp(i w t) at midship, w (n,) [rad/s], direction [rad]."""
    k = w**2 / GRAVITY
    along, across = np.cos(direction), np.sin(direction)
    half = 0.5 * k * np.abs(along) * LENGTH
    mean = np.sin(half) / half
    smith = np.exp(-k * np.abs(along) * DRAUGHT)
    radiated = (2.0 * np.sin(0.5 * k * BREADTH) * np.exp(-k * DRAUGHT)) ** 2 / (k * BREADTH)
    lift = smith * np.hypot(1.0 - k * DRAUGHT, radiated) / np.hypot(1.0 - 2.0 * k * DRAUGHT, radiated)
    pitch = lift * 6.0 / (half**2 * LENGTH) * (np.sin(half) - half * np.cos(half))
    drift = -1j * smith * mean
    ratio = w * ROLL_PERIOD / (2.0 * np.pi)
    roll = -1j * k * across * np.exp(-k * DRAUGHT) / (1.0 - ratio**2 + 2j * ROLL_DAMPING * ratio)
    return np.stack([along * drift, across * drift, lift * mean, roll, 1j * np.sign(along) * pitch, np.zeros_like(w)])


def text() -> str:
    """The table as riser_soil reads it."""
    units = ("m/m",) * 3 + ("deg/m",) * 3
    pairs = [f"{mode} [{unit}], {mode} phase [deg]" for mode, unit in zip(MODES[:5], units, strict=False)]
    lines = ["period [s], direction [deg], " + ", ".join(pairs)]
    for direction in DIRECTIONS:
        table = responses(2.0 * np.pi / PERIODS, np.radians(direction))[:5]
        table[3:] *= 180.0 / np.pi
        for period, row in zip(PERIODS, table.T, strict=True):
            cells = [f"{abs(z):.5f}, {-np.degrees(np.angle(z)) % 360.0 if abs(z) > 1e-9 else 0.0:.2f}" for z in row]
            lines.append(f"{period:g}, {direction:g}, " + ", ".join(cells))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    FILE.write_text(text(), encoding="utf-8")
    print(f"wrote {FILE}")
