"""Element lengths as curvature asks for them: short where moment or tension bends along the riser, long elsewhere.

Between two nodes a straight line misses a curve by h^2 |f''|/8. The lengths h are such that it misses, at any time of a
run, the largest moment by at most a share of it, and the least tension by the same share of its scale. Where a moment
is far below the largest, or a tension far above the least, it may be missed by more, as no key result is there.
A tension T bends elements into shapes that a cubic can't follow, which leaves T h^4 k''/384 in the moments (see
`results.bending_misfit`): that keeps to the share, too.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import Instant
from riser_soil.variants.key_results import FORCE_FLOOR

GAP = 0.5  # of the accuracy asked: what falls between nodes
FORGIVEN = 0.2  # of how far a moment is below the largest, or a tension above the least
SHRINK = 6.0  # at most, from one run to the next: what is not resolved yet asks for more than it needs


@dataclass
class CurveEnvelope:
    """Moment and tension along the riser over a run: extremes and second derivatives by their largest size.

    arc: (nn,) m. moment, least: (nn,) largest moment [N m], least tension [N]. bends: (2, nn) second derivatives of
    moment and tension. pull: (nn,) tension over EI [1/m2]. force: largest tension or shear [N].
    """

    arc: Array = field(default_factory=lambda: np.zeros(0))
    moment: Array = field(default_factory=lambda: np.zeros(0))
    least: Array = field(default_factory=lambda: np.zeros(0))
    bends: Array = field(default_factory=lambda: np.zeros((2, 0)))
    pull: Array = field(default_factory=lambda: np.zeros(0))
    force: float = 0.0

    def follow(self, seen: Instant) -> None:
        """One more instant."""
        riser, arc = seen.riser, seen.arc
        bends = np.stack([_bend(arc, riser.moment_vector), _bend(arc, riser.effective_tension[:, None])])
        if not self.arc.size:
            self.arc, self.bends, self.pull = arc, bends, np.zeros(arc.size)
            self.moment, self.least = riser.bending_moment, riser.effective_tension
        with np.errstate(divide="ignore", invalid="ignore"):
            flexibility = np.nan_to_num(riser.curvature / riser.bending_moment, posinf=0.0)
        self.pull = np.maximum(self.pull, flexibility * riser.effective_tension)
        self.bends = np.maximum(self.bends, bends)
        self.moment = np.maximum(self.moment, riser.bending_moment)
        self.least = np.minimum(self.least, riser.effective_tension)
        self.force = max(self.force, float(np.abs(riser.effective_tension).max()), _shear(arc, riser.moment_vector))

    def lengths(self, share: float) -> Array:
        """Lengths of elements (nn,) [m] at the nodes, for a share of accuracy; inf where all is straight."""
        gap = GAP * share
        largest = self.moment.max()
        of_moment = gap * largest + FORGIVEN * (largest - self.moment)
        of_tension = gap * FORCE_FLOOR * self.force + FORGIVEN * (self.least - self.least.min())
        by_moment, by_tension = self.bends
        with np.errstate(divide="ignore", invalid="ignore"):
            lengths = np.stack([
                np.sqrt(8.0 * of_moment / by_moment),
                np.sqrt(8.0 * of_tension / by_tension),
                (384.0 * gap * largest / (self.pull * by_moment)) ** 0.25,
            ])  # fmt: skip
        asked = np.nan_to_num(lengths, nan=np.inf, posinf=np.inf).min(axis=0)
        return np.maximum(asked, _present(self.arc) / SHRINK)

    def excess(self, share: float) -> float:
        """Length of the elements over what is asked for, where it is most."""
        asked = self.lengths(share)
        return float((np.diff(self.arc) / np.minimum(asked[1:], asked[:-1])).max())


def _bend(arc: Array, values: Array) -> Array:
    """Size of the second derivative (nn,) of values (nn, m); at the ends that of the neighbours."""
    if arc.size < 3:
        return np.zeros(arc.size)
    slope = np.diff(values, axis=0) / np.diff(arc)[:, None]
    inner = np.linalg.norm(np.diff(slope, axis=0), axis=1) / (0.5 * (arc[2:] - arc[:-2]))
    return np.concatenate([inner[:1], inner, inner[-1:]])


def _shear(arc: Array, moment: Array) -> float:
    """Largest shear force [N], the slope of moments (nn, 3) [N m]."""
    return float((np.linalg.norm(np.diff(moment, axis=0), axis=1) / np.diff(arc)).max())


def _present(arc: Array) -> Array:
    """The shorter of the elements at each node (nn,)."""
    length = np.diff(arc)
    return np.minimum(np.append(length, length[-1]), np.insert(length, 0, length[0]))
