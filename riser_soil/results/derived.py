"""Derived results: reactions in the riser's vertical plane, peak values between samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.results.read import Run


@dataclass(frozen=True, eq=False)
class Reactions:
    """Forces of the supports on the riser (nt,) [N] at its start (1) and end (2).

    V is positive upwards. H lies along the horizontal from start to end and is positive where it pulls the riser
    taut: a riser at rest without current or friction has H1 = H2.
    """

    H1: Array
    V1: Array
    H2: Array
    V2: Array


def along(position: Array) -> Array:
    """Horizontal unit vector (3,) from start to end of an axis (nn, 3) [m]; x where they lie above each other."""
    chord = (position[-1] - position[0]) * [1.0, 1.0, 0.0]
    length = float(np.linalg.norm(chord))
    return chord / length if length > 0.0 else np.array([1.0, 0.0, 0.0])


def reactions(run: Run) -> Reactions:
    """Reactions at all recorded times, in the vertical plane in which start and end lie at the first of them."""
    start, end, direction = run["start_force"], run["end_force"], along(run["position"][0])
    return Reactions(-start @ direction, start[:, 2], end @ direction, end[:, 2])


def peak(x: Array, q: Array) -> Array:
    """Largest value of q (..., n) along its last axis, sampled at growing x (n,), n at least 3.

    Taken between the samples, from the parabola through the largest one and its two neighbours: third order in their
    distance where q is smooth. The sample itself where it is the first or the last.
    """
    largest = q.argmax(axis=-1)
    i = np.clip(largest, 1, q.shape[-1] - 2)
    a, b, c = (np.take_along_axis(q, (i + k)[..., None], axis=-1)[..., 0] for k in (-1, 0, 1))
    before, after = x[i] - x[i - 1], x[i + 1] - x[i]
    bend = ((c - b) / after - (b - a) / before) / (before + after)
    slope = (b - a) / before + bend * before
    vertex = (i == largest) & (bend < 0.0)
    return np.where(vertex, b - slope**2 / np.where(vertex, 4.0 * bend, 1.0), q.max(axis=-1))
