"""Elements that are folded, or swing too far in a step, and what is said of them."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit


@njit
def write_folded(
    chord0: Array, tangent0: Array, chord: Array, tangent: Array, wound: int, loose: Array, out: IntArray
) -> None:
    """Write the numbers (2,) of the first element that is folded or wound up, and of the first that swings too far from
    one configuration to another, see `Line.inadmissible`; ne without any. loose: see `first_folded`.
    """
    out[0] = min(first_folded(chord, tangent, loose), wound)
    out[1] = first_swung(chord0, tangent0, chord, tangent, loose, MOST_SWING)


@njit
def first_folded(chord: Array, tangent: Array, loose: Array) -> int:
    """First element with an end whose tangent points against the chord; ne without any. loose (ne,): chords [m] below
    which an element lies in a heap, where neither its direction nor that of its ends counts.
    """
    for e in range(chord.shape[0]):
        if _is_shorter(chord[e], loose[e]):
            continue
        for side in range(2):
            ahead = 0.0
            for i in range(chord.shape[1]):
                ahead += chord[e, i] * tangent[e, side, i]
            if ahead <= 0.0:
                return e
    return chord.shape[0]


@njit
def _is_shorter(chord: Array, length: float) -> bool:
    square = 0.0
    for i in range(chord.size):
        square += chord[i] ** 2
    return square < length * length


@njit
def first_swung(chord0: Array, tangent0: Array, chord: Array, tangent: Array, loose: Array, most: float) -> int:
    """First element with an end whose tangent turns against the chord by more than `most` [rad], from one configuration
    to another; ne without any. Chords (ne, d), turned from one to the other the shortest way; tangents (ne, 2, d);
    loose: see `first_folded`.
    """
    ne, d = chord.shape
    first, second, least = np.empty(d), np.empty(d), math.cos(most)
    for e in range(ne):
        if _is_shorter(chord0[e], loose[e]) or _is_shorter(chord[e], loose[e]):
            continue
        _write_unit(chord0[e], first)
        _write_unit(chord[e], second)
        for side in range(2):
            if _cosine_of_swing(first, tangent0[e, side], second, tangent[e, side]) < least:
                return e
    return ne


@njit
def _write_unit(vector: Array, out: Array) -> None:
    square = 0.0
    for i in range(out.size):
        square += vector[i] ** 2
    length = math.sqrt(square)
    for i in range(out.size):
        out[i] = vector[i] / length


@njit
def _cosine_of_swing(chord0: Array, tangent0: Array, chord: Array, tangent: Array) -> float:
    """Cosine of the angle between a tangent and one that turned along with the chord; all are unit vectors."""
    between, tangents, along0, along, both0, both = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(chord.size):
        between += chord0[i] * chord[i]
        tangents += tangent0[i] * tangent[i]
        along0 += chord0[i] * tangent0[i]
        along += chord[i] * tangent[i]
        both0 += (chord0[i] + chord[i]) * tangent0[i]
        both += (chord0[i] + chord[i]) * tangent[i]
    if between <= -1.0:
        return -1.0
    return tangents - both0 * both / (1.0 + between) + 2.0 * along0 * along


MOST_SWING = 0.2  # rad by which an element's end may turn against its chord in a time step
BENT_DOUBLE = 1.2  # rad from its chord, beyond which an end was on its way to be folded


def swinging(arc: float) -> str:
    """Reason why a step is refused: the element at an arc length [m] bends too far in it."""
    return f"the element at arc {arc:.6g} m bends by more than {MOST_SWING:g} rad in the step"


def folded(arc: float, length: float, diameter: float, ends: Array, chord: Array) -> str:
    """Reason why a state is refused: the element at an arc length is folded. length, diameter [m].

    Tangents (2, d) at its ends and chord (d,) as accepted: where the element was bent double before, the reason gives
    its bend, which no shorter step prevents.
    """
    fold = (
        f"the riser is folded at arc {arc:.6g} m, where an element's end turns by more than 90 degrees from its chord"
    )
    first, second = _swings(ends, chord / np.linalg.norm(chord))
    swing = max(abs(first), abs(second))
    if swing < BENT_DOUBLE:
        return f"{fold}; start nearer to the shape sought, or take shorter elements or steps"
    radius = length / abs(first - second)
    return (
        f"{fold}; it had come to {math.degrees(swing):.0f} degrees before: loads or motion close a bend there, "
        f"whose radius is down to {radius:.3g} m, {radius / diameter:.2g} diameters, on an "
        f"element of {length:.3g} m; much shorter elements follow it further, and show whether it becomes a kink"
    )


def _swings(ends: Array, chord: Array) -> tuple[float, float]:
    """Angles [rad] from a unit chord to the tangents; the second's is positive where it turns to the first's side."""
    along = ends @ chord
    across = ends - np.outer(along, chord)
    first, second = np.arctan2(np.linalg.norm(across, axis=1), along)
    return float(first), math.copysign(second, float(across[0] @ across[1]))
