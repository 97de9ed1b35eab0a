"""Element lengths that curvature requires: short where moment or tension curves along the riser, long elsewhere.

Between two nodes linear interpolation of f has an error of h^2 |f''|/8. With lengths h it is, at any time of a run, at
most a share of the largest moment, and the same share of the least tension's scale. Where a moment is far below the
largest, or a tension far above the least, the error may be larger, as no key result is there. A tension T bends
elements into shapes that no cubic has, which leaves an error T h^4 k''/384 in the moments (`results.bending_misfit`).
This keeps to the share, too.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import Record
from riser_soil.variants.key_results import FORCE_FLOOR

INTERPOLATION = 0.5  # error between nodes, over the accuracy asked for
FORGIVEN = 0.2  # error that is allowed, over a moment's distance below the largest, or a tension's above the least
MOST_FINER = 6.0  # ratio of lengths from one run to the next: curves that are not resolved yet require too much


@dataclass
class CurveEnvelope:
    """Envelope of moment and tension along the riser over a run, and of their second derivatives.

    arc: (nn,) m. moment, least: (nn,) largest moment [N m], least tension [N]. second: (2, nn) largest second
    derivatives of moment and tension. pull: (nn,) largest tension over EI [1/m2]. force: largest tension or shear [N].
    """

    arc: Array = field(default_factory=lambda: np.zeros(0))
    moment: Array = field(default_factory=lambda: np.zeros(0))
    least: Array = field(default_factory=lambda: np.zeros(0))
    second: Array = field(default_factory=lambda: np.zeros((2, 0)))
    pull: Array = field(default_factory=lambda: np.zeros(0))
    force: float = 0.0

    def add(self, riser: Record) -> None:
        """Extend the envelope by the record of one more instant."""
        arc = riser.arc
        second = np.stack([_second(arc, riser.moment_vector), _second(arc, riser.effective_tension[:, None])])
        if not self.arc.size:
            self.arc, self.second, self.pull = arc, second, np.zeros(arc.size)
            self.moment, self.least = riser.bending_moment, riser.effective_tension
        with np.errstate(divide="ignore", invalid="ignore"):
            flexibility = np.nan_to_num(riser.curvature / riser.bending_moment, posinf=0.0)
        self.pull = np.maximum(self.pull, flexibility * riser.effective_tension)
        self.second = np.maximum(self.second, second)
        self.moment = np.maximum(self.moment, riser.bending_moment)
        self.least = np.minimum(self.least, riser.effective_tension)
        self.force = max(self.force, float(np.abs(riser.effective_tension).max()), _shear(arc, riser.moment_vector))

    def lengths(self, share: float) -> Array:
        """Element lengths (nn,) [m] required at the nodes for a relative accuracy `share`; inf if all is straight."""
        allowed = INTERPOLATION * share
        largest = self.moment.max()
        of_moment = allowed * largest + FORGIVEN * (largest - self.moment)
        of_tension = allowed * FORCE_FLOOR * self.force + FORGIVEN * (self.least - self.least.min())
        of_moment_curve, of_tension_curve = self.second
        with np.errstate(divide="ignore", invalid="ignore"):
            lengths = np.stack([
                np.sqrt(8.0 * of_moment / of_moment_curve),
                np.sqrt(8.0 * of_tension / of_tension_curve),
                (384.0 * allowed * largest / (self.pull * of_moment_curve)) ** 0.25,
            ])  # fmt: skip
        required = np.nan_to_num(lengths, nan=np.inf, posinf=np.inf).min(axis=0)
        return np.maximum(required, _present(self.arc) / MOST_FINER)

    def length_ratio(self, share: float) -> float:
        """Largest ratio of an element's length to the length required there."""
        required = self.lengths(share)
        return float((np.diff(self.arc) / np.minimum(required[1:], required[:-1])).max())


def _second(arc: Array, values: Array) -> Array:
    """Size of the second derivative (nn,) of values (nn, m) by arc; at the ends that of the neighbours."""
    if arc.size < 3:
        return np.zeros(arc.size)
    slope = np.diff(values, axis=0) / np.diff(arc)[:, None]
    inner = np.linalg.norm(np.diff(slope, axis=0), axis=1) / (0.5 * (arc[2:] - arc[:-2]))
    return np.concatenate([inner[:1], inner, inner[-1:]])


def _shear(arc: Array, moment: Array) -> float:
    """Largest shear force [N], the slope of moments (nn, 3) [N m]."""
    return float((np.linalg.norm(np.diff(moment, axis=0), axis=1) / np.diff(arc)).max())


def _present(arc: Array) -> Array:
    """Length of the shorter element at each node (nn,) [m]."""
    length = np.diff(arc)
    return np.minimum(np.append(length, length[-1]), np.insert(length, 0, length[0]))
