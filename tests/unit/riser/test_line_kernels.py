"""How far ends of elements swing against their chords within a step: turns known beforehand."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.riser import rotations
from riser_soil.riser.line_kernels import first_folded, first_swung
from riser_soil.riser.vectors import vector


def turned(axis: Array, angle: float, v: Array) -> Array:
    return np.array(rotations.exp(vector(angle * axis))) @ v


def swung(spin: float, swing: float, twist: float, most: float, loose: float = 0.0) -> int:
    """The second of three elements spins as a whole, and its second end swings and twists beyond that; its chord is
    2 m long.
    """
    along, aside, up = np.eye(3)
    chord0 = 2.0 * np.stack([along, along, along])
    tangent0 = np.repeat(turned(up, 0.1, along)[None, None], 6, axis=0).reshape(3, 2, 3)
    chord, tangent = chord0.copy(), tangent0.copy()
    chord[1] = 2.0 * turned(aside, spin, along)
    tangent[1] = [turned(aside, spin, t) for t in tangent0[1]]
    tangent[1, 1] = turned(aside, spin, turned(along, twist, turned(aside, swing, tangent0[1, 1])))
    return int(first_swung(chord0, tangent0, chord, tangent, np.array([0.0, loose, 0.0]), most))


@pytest.mark.parametrize("spin", [0.0, 1.0, -3.0])
@pytest.mark.parametrize("swing", [0.25, -0.25])
def test_a_swing_counts_beyond_the_limit(spin: float, swing: float) -> None:
    assert swung(spin, swing, 0.0, 0.24) == 1
    assert swung(spin, swing, 0.0, 0.26) == 3


def test_a_turn_of_the_whole_element_does_not_count() -> None:
    assert swung(2.0, 0.0, 0.0, 1e-6) == 3
    assert swung(2.0, 0.0, 0.5, 0.06) == 3  # about its chord it turns a tangent that is 0.1 from it by 0.05


def test_an_element_that_points_back_has_swung() -> None:
    chord0, tangent0 = np.array([[1.0, 0.0]]), np.array([[[1.0, 0.0], [1.0, 0.0]]])
    assert first_swung(chord0, tangent0, -chord0, -tangent0, np.zeros(1), 3.0) == 0


def test_an_element_in_a_heap_may_fold_and_swing() -> None:
    """The element is shorter than the chord below which that does not count."""
    assert swung(0.0, 0.25, 0.0, 0.24, loose=1.9) == 1
    assert swung(0.0, 0.25, 0.0, 0.24, loose=2.1) == 3
    chord, tangent = np.array([[1.0, 0.0]]), np.array([[[-1.0, 0.0], [1.0, 0.0]]])
    assert first_folded(chord, tangent, np.array([0.9])) == 0
    assert first_folded(chord, tangent, np.array([1.1])) == 1
