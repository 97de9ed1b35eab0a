"""Element lengths as curvature asks for them: short where moment or tension bends along the riser, long elsewhere.

Between two nodes a straight line misses a curve by h^2 |f''|/8. The lengths h are such that it misses, at any time of a
run, the largest moment by at most a share of it, and the least tension by the same share of its scale. Where a moment
is far below the largest, or a tension far above the least, it may be missed by more, as no headline quantity is there.
A tension T bends elements into shapes that a cubic can't follow, which leaves T h^4 k''/384 in the moments (see
`riser.resolution`): that keeps to the share, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from riser_soil.accuracy.headlines import FORCE_FLOOR
from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import Instant
from riser_soil.scene.riser import Segment

GAP = 0.5  # of the accuracy asked: what falls between nodes
FORGIVEN = 0.2  # of how far a moment is below the largest, or a tension above the least
FEWEST = 12  # elements along the whole riser
GROWTH = 0.3  # of the length of elements from one to the next
SHRINK = 6.0  # at most, from one run to the next: what is not resolved yet asks for more than it needs
STRAIGHT = 0.15  # in the logarithm of h, what a stretch of steadily growing elements may be off
SAMPLES = 400


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


def graded(segments: Sequence[Segment], envelope: CurveEnvelope, share: float) -> tuple[Segment, ...]:
    """The segments, each in stretches of steadily growing elements, by a run's envelope."""
    arc, lengths = _smooth(envelope.arc, envelope.lengths(share))
    stretches, begin = list[Segment](), 0.0
    for segment in segments:
        stretches += _stretches(segment, begin, arc, lengths)
        begin += segment.length
    return tuple(stretches)


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


def _smooth(arc: Array, lengths: Array) -> tuple[Array, Array]:
    """Lengths between the nodes, too, that grow slowly from where they are least; arc and lengths (n,)."""
    beside = np.minimum(lengths, np.minimum(np.append(lengths[1:], np.inf), np.insert(lengths[:-1], 0, np.inf)))
    fine = np.union1d(arc, np.linspace(arc[0], arc[-1], SAMPLES))
    reach = beside[None, :] + GROWTH * np.abs(fine[:, None] - arc[None, :])
    return fine, np.minimum(reach.min(axis=1), (arc[-1] - arc[0]) / FEWEST)


def _stretches(segment: Segment, begin: float, arc: Array, lengths: Array) -> list[Segment]:
    end = begin + segment.length
    inner = arc[(arc > begin) & (arc < end)]
    at = np.concatenate([[begin], inner, [end]])
    h = np.minimum(np.interp(at, arc, lengths), 0.5 * segment.length)
    corners = _long_enough(at, h, _corners(at, np.log(h)))
    given = segment.model_dump(exclude={"length", "elements", "element_length"})
    return [
        Segment(**given, length=float(at[j] - at[i]), element_length=(_told(h[i]), _told(h[j])))
        for i, j in pairwise(corners)
    ]


def _corners(x: Array, y: Array) -> list[int]:
    """Indices at which a polygon that follows y(x) has its corners (Ramer 1972; Douglas and Peucker 1973)."""
    off = np.abs(y - np.interp(x, x[[0, -1]], y[[0, -1]]))
    worst = int(off.argmax())
    if off[worst] <= STRAIGHT:
        return [0, len(x) - 1]
    return [*_corners(x[: worst + 1], y[: worst + 1]), *(worst + i for i in _corners(x[worst:], y[worst:])[1:])]


def _long_enough(x: Array, h: Array, corners: list[int]) -> list[int]:
    """Without corners that leave less than two elements between them; the shorter length stays."""
    kept = corners[:1]
    for at in corners[1:-1]:
        if x[at] - x[kept[-1]] >= 2.0 * h[at] and x[corners[-1]] - x[at] >= 2.0 * h[at]:
            kept.append(at)
    return [*kept, corners[-1]]


def _told(length: float) -> float:
    """To four figures."""
    return float(f"{length:.4g}")
