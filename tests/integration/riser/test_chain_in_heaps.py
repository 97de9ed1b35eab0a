"""Elements of chain in a heap, whose chords are short: forces and tangent of one energy, down to no chord at all."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.riser.structural_damping import StructuralDamping
from riser_soil.riser.tension_only import Heaped, TensionOnly
from riser_soil.riser.tension_only import heaped as heaped_state
from tests.support.dense_chain import residual, tangent
from tests.support.differences import WEIGHTS, difference_tangent, error, moved, slope
from tests.support.on_ranks import ROOT, environment, finished
from tests.support.pipes import pipe

CHAIN: dict[str, Any] = {"EA": 4.0e5, "EI": 0.0, "GJ": 3.0, "submerged_weight": 700.0, "damping": 0.2}
SHARES = np.array([0.95, 0.86, 0.8, 0.7, 0.6, 0.52, 0.3, 1e-3])  # of their lengths: chords, those in between most
LENGTH = 1.5
STATIC = Weights(0.0, 1.0, 0.0, 0.0)
dimensions = pytest.mark.parametrize("dimension", [2, 3])
formulas = pytest.mark.usefixtures("uncompiled")


def heaped(dimension: int, shares: Array) -> Beam:
    """A zigzag of chords along x, straight before; weight has a slope."""
    e = pipe(LENGTH * shares.size, shares.size, **CHAIN)
    ahead = np.where(np.arange(shares.size) % 3 == 2, -1.0, 1.0)
    x, up = np.append(0.0, np.cumsum(LENGTH * shares * ahead)), 1e-2 * np.sin(np.arange(shares.size + 1))
    position = np.column_stack([x, 0.0 * x, up * np.append(shares, 1.0)])
    level = np.broadcast_to([1.0, 0.0, 0.0], (shares.size, 2, 3))
    layout = shapes.layout(e.arc, e.outer_diameter, shapes.straight(e.arc), shapes.Curve(position, level))
    line = Line(dimension, layout, End(prescribed=True), End(prescribed=False), loose=e.loose)
    return Beam(line, e, load=np.array([90.0, 0.0, -40.0]))


def placed(u: Array) -> State:
    """At rest after increments (nn, ndof)."""
    return State(0.0, u.ravel(), 0.0 * u.ravel(), 0.0 * u.ravel())


def shaken(beam: Beam, seed: int) -> State:
    """Turned by up to some radian, and moved by little beside the chords in between."""
    u = np.random.default_rng(seed).normal(size=(beam.line.nodes, beam.line.ndof))
    u[:, : beam.line.dimension] *= 2e-3
    u[:, beam.line.dimension :] *= 0.25
    return placed(u)


@formulas
@dimensions
def test_forces_are_the_gradient_of_the_energy(dimension: int) -> None:
    beam = heaped(dimension, SHARES)
    state = shaken(beam, 1)

    def energy(s: float, direction: Array) -> Array:
        return np.array(beam.energy(moved(state, s * direction, STATIC)).total)

    gradient = [slope(partial(energy, direction=d), 1e-4) for d in np.eye(state.u.size)]
    assert error(residual([beam], state, STATIC), np.array(gradient)) < 1e-8


@formulas
@dimensions
def test_tangent_is_the_derivative_of_the_forces(dimension: int) -> None:
    beam = heaped(dimension, SHARES)
    state = shaken(beam, 2)
    K = tangent([beam], state, STATIC)
    assert error(K, difference_tangent(beam, state, STATIC, h=1e-5)) < 1e-8
    assert np.abs(K - K.T).max() < 1e-12 * np.abs(K).max()


@formulas
@dimensions
def test_damping_has_its_exact_tangent_too(dimension: int) -> None:
    """And takes out energy, with no chord as well: by r EA/L times the damping and the chord's rate."""
    beam = heaped(dimension, SHARES)
    damping = StructuralDamping(beam.line, beam._elements)
    v = 0.3 * np.random.default_rng(4).normal(size=beam.line.size)
    state = replace(shaken(beam, 2), v=v)
    assert error(tangent([damping], state, WEIGHTS), difference_tangent(damping, state, WEIGHTS, h=1e-5)) < 1e-8
    assert residual([damping], state, WEIGHTS) @ v > 0.0
    beam = heaped(dimension, np.zeros(1))
    damping, still = StructuralDamping(beam.line, beam._elements), placed(np.zeros((2, beam.line.ndof)))
    moving = replace(still, v=np.append(np.zeros(beam.line.ndof), np.full(beam.line.ndof, 0.3)))
    forces = residual([damping], moving, STATIC).reshape(2, -1)
    assert forces[1, :dimension] == pytest.approx(0.2 * 1e-4 * 700.0 * 0.3)
    assert np.isfinite(tangent([damping], moving, WEIGHTS)).all()


@formulas
@dimensions
def test_a_chord_of_no_length_is_a_spring(dimension: int) -> None:
    """The element's pull is r EA/L times the chord, whichever way that points, and its load that of a level element."""
    beam = heaped(dimension, np.zeros(1))
    line, d, stiffness = beam.line, dimension, 1e-4 * 700.0
    at_rest = placed(np.zeros((2, line.ndof)))
    still = residual([beam], at_rest, STATIC).reshape(2, -1)
    assert np.isfinite(still).all()
    assert still[:, d - 1] == pytest.approx([0.5 * 740.0 * LENGTH] * 2, rel=1e-5)
    for k in range(d):
        for sign in (1.0, -1.0):
            u = np.zeros((2, line.ndof))
            u[1, k] = sign * 1e-3
            pull = residual([beam], placed(u), STATIC).reshape(2, -1) - still
            assert pull[1, k] == pytest.approx(stiffness * u[1, k], rel=1e-6)
            assert pull[0, k] == pytest.approx(-stiffness * u[1, k], rel=1e-6)
    assert np.isfinite(tangent([beam], at_rest, STATIC)).all()


@formulas
@dimensions
def test_forces_across_a_chord_are_bounded(dimension: int) -> None:
    """Ends at right angles to a short chord don't turn it by more than the element weighs: without, they would by
    thousands of times that.
    """
    beam = heaped(dimension, np.array([1e-3]))
    u = np.zeros((2, beam.line.ndof))
    u[0, -1 if dimension == 2 else -2] = 0.5 * np.pi
    forces = residual([beam], placed(u), STATIC)
    assert np.abs(forces).max() < 740.0 * LENGTH


@formulas
def test_the_share_of_the_bow_grows_smoothly() -> None:
    """The share grows from nothing at half of the length to all of it at nine tenths, where the element is like any
    other.
    """
    law = TensionOnly(*(np.full(1, value) for value in (1e-4, 0.1, 5.0)))

    def state(share: float) -> Heaped:
        heap: Heaped = heaped_state.kernels[TensionOnly](law, 0, np.array([0.0, share * LENGTH]), LENGTH, 4e5)
        return heap

    def after(share: float, s: float) -> Array:
        return np.array(state(share + s)[:2])

    for share in (0.51, 0.6, 0.74, 0.89):
        at, by_share = state(share), slope(partial(after, share), 1e-4)
        assert [at.slope, at.bend] == pytest.approx(by_share, rel=1e-7)
        assert at.stiffness == pytest.approx(1e-4 * 4e5 / LENGTH)
    assert state(0.5)[:3] == state(0.0)[:3] == (0.0, 0.0, 0.0)
    assert state(0.9)[:3] == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)
    assert state(0.91)[:3] == state(2.0)[:3] == (1.0, 0.0, 0.0)
    assert state(0.89).g < 1.0


COMPILED = """
from numba.core import event
from riser_soil.riser.line_part import LineParts
from tests.support.sample_line import sample

beam = sample(2).beam()
with event.install_recorder("numba:compile") as seen:
    LineParts(beam.line, [beam]).energy(sample(2).state(1))
print(*(entry.data["dispatcher"].py_func.__name__ for _, entry in seen.buffer))
"""


@pytest.mark.verify
def test_nothing_of_heaps_is_compiled_for_a_line_that_bends(tmp_path: Path) -> None:
    """The line's forces and energy are compiled, from an empty cache."""
    given = environment() | {"NUMBA_CACHE_DIR": str(tmp_path)}
    done = finished([sys.executable, "-c", COMPILED], ROOT, given)
    assert done.returncode == 0, done.stderr
    compiled = set(done.stdout.split())
    assert {"_blend_planar_forces", "element_energy", "_blended_planar_energy"} <= compiled
    assert not {"heaped_energy", "heaped_load_potential", "blended", "blend_forces", "_square_of"} & compiled
