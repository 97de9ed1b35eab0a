"""The line solver of a riser alone: its kernels are those of the parts, and its steps are those of SNES.

`tests/verification/test_line_solver.py` has the same in space, on a floor and in moving water, which takes longer.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import solve_banded

from riser_soil.contact.law import Penalty
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core import banded
from riser_soil.core.arrays import Array
from riser_soil.errors import SolveError
from riser_soil.seabed.grounds import Plane
from riser_soil.solve.convergence import ITERATING, Convergence, StopLimits
from riser_soil.solve.packed_line import PackedLine
from riser_soil.solve.step import NotConvergedError
from tests.support.dense_chain import tangent
from tests.support.differences import WEIGHTS, error
from tests.support.line_solver import (
    Compiled,
    all_parts,
    require_kernels_of_parts,
    require_mass,
    require_steps_of_snes,
    require_tangles,
    walked,
)
from tests.support.sample_line import START, sample


def test_kernels_in_a_plane_are_those_of_the_parts() -> None:
    require_kernels_of_parts(2)


def test_the_mass_in_a_plane_is_that_of_the_parts() -> None:
    at = sample(2)
    require_mass(at, all_parts(at))


@pytest.mark.parametrize("case", ["surge in a plane", "midpoint rule in a plane"])
def test_steps_in_a_plane_are_those_of_snes(case: str) -> None:
    require_steps_of_snes(case)


def test_tangles_in_a_plane_are_those_of_the_line() -> None:
    require_tangles(2)


def test_a_step_that_ends_in_a_tangle_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = walked("surge in a plane", "compiled", 1)
    monkeypatch.setattr(PackedLine, "folding", (1, 1))
    with pytest.raises(NotConvergedError, match="folded at arc"):
        stage.newton.solve(stage.stepper.next_step(stage.control))


@pytest.mark.parametrize("diagonal", [0.0, 1e-13])  # pivots must be exchanged
@pytest.mark.parametrize(("n", "b"), [(3, 2), (9, 2), (40, 5), (66, 11)])
def test_banded_factors_solve(n: int, b: int, diagonal: float) -> None:
    rng = np.random.default_rng(n)
    ab, band = banded.workspace(n, b)
    columns = np.zeros((2 * b + 1, n))  # as scipy has them: entry (i, j) at [b + i - j, j]
    for i in range(n):
        for j in range(max(0, i - b), min(n, i + b + 1)):
            ab[i, j - i + b] = columns[b + i - j, j] = diagonal if i == j else rng.normal()
    load, pivots = rng.normal(size=n), np.zeros(n, dtype=np.int64)
    expected = solve_banded((b, b), columns, load)
    assert banded.factorise(ab, pivots, band)
    banded.solve(ab, pivots, load, band)
    np.testing.assert_allclose(load, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize(("n", "b"), [(1, 0), (4, 0), (1, 2), (2, 3), (4, 1), (5, 2)])
def test_narrow_and_short_bands_are_solved_for(n: int, b: int) -> None:
    rng, (ab, band), pivots = np.random.default_rng(b), banded.workspace(n, b), np.zeros(n, dtype=np.int64)
    dense, load = 9.0 * np.eye(n), rng.normal(size=n)
    for i in range(n):
        for j in range(max(0, i - b), min(n, i + b + 1)):
            dense[i, j] += rng.normal()
            ab[i, j - i + b] = dense[i, j]
    solution = load.copy()
    assert banded.factorise(ab, pivots, band)
    banded.solve(ab, pivots, solution, band)
    np.testing.assert_allclose(solution, np.linalg.solve(dense, load), rtol=1e-12)


@pytest.mark.parametrize(("n", "b"), [(40, 5), (66, 11)])
def test_fill_of_some_rows_alone_is_solved_for(n: int, b: int) -> None:
    """Rows are exchanged in the middle, so that those before and after it have no fill."""
    rng, (ab, band) = np.random.default_rng(n), banded.workspace(n, b)
    dense, load, pivots = np.zeros((n, n)), rng.normal(size=n), np.zeros(n, dtype=np.int64)
    for i in range(n):
        for j in range(max(0, i - b), min(n, i + b + 1)):
            ab[i, j - i + b] = dense[i, j] = rng.normal() * (0.01 if i > j else 1.0) + (9.0 if i == j else 0.0)
    ab[n // 2 + b, 0] = dense[n // 2 + b, n // 2] = 1e4  # beside a pivot that is far smaller
    solution = load.copy()
    assert banded.factorise(ab, pivots, band)
    assert pivots[n // 2] == n // 2 + b
    assert (pivots[: n // 2] == np.arange(n // 2)).all()
    assert (pivots[n // 2 + b + 1 :] == np.arange(n // 2 + b + 1, n)).all()
    banded.solve(ab, pivots, solution, band)
    np.testing.assert_allclose(solution, np.linalg.solve(dense, load), rtol=1e-9, atol=1e-12)


def test_rows_stay_where_their_pivots_are_large_enough() -> None:
    ab, band = banded.workspace(5, 1)
    pivots = np.zeros(5, dtype=np.int64)
    for pivot, row in ((0.2, 0), (0.05, 1)):
        ab[...] = 0.0
        ab[:5, 1] = 1.0
        ab[0, 1], ab[0, 2], ab[1, 0] = pivot, 1.0, 1.0
        assert banded.factorise(ab, pivots, band)
        np.testing.assert_array_equal(pivots, [row, 1, 2, 3, 4])


@pytest.mark.parametrize("wrong", [0.0, np.nan, np.inf])
def test_a_singular_matrix_is_reported(wrong: float) -> None:
    ab, band = banded.workspace(3, 1)
    ab[:3, 1] = 1.0
    ab[1, 1] = wrong
    assert not banded.factorise(ab, np.zeros(3, dtype=np.int64), band)


def test_a_step_that_fails_says_why_as_snes_does() -> None:
    messages = []
    for newton in ("compiled", "snes"):
        stage = walked("surge in a plane", newton, 1)
        asked = stage.newton if stage.newton.lines is not None else stage.newton.by_parts
        asked.settings = replace(asked.settings, tolerance=1e-12, max_iterations=1)
        if stage.newton.lines is None:
            stage.newton.by_parts.loop.max_iterations = 1
        with pytest.raises(SolveError, match="no convergence") as failure:
            stage.walk(200)
        messages.append(str(failure.value))
    assert messages[0] == messages[1]


@pytest.mark.parametrize("newton", ["compiled", "snes"])
def test_increments_of_accepted_states_stay_zero(newton: str) -> None:
    """All accepted states share them."""
    stage = walked("surge in a plane", newton, 3)
    assert stage.stepper.before.u is stage.system.no_increments
    assert not stage.system.no_increments.any()


@pytest.mark.parametrize(
    ("norms", "apart", "kept"),
    [
        ([1.0], [1.0], False),
        ([1.0, 0.02], [1.0, 0.02], True),  # it falls fast
        ([1.0, 0.2], [1.0, 0.2], False),
        ([1.0, 0.2], [1.0, 0.002], True),  # contact alone keeps it from falling
        ([1.0, 0.6], [1.0, 0.002], False),  # nor does it fall
        ([1.0, np.nan], [1.0, np.nan], False),
    ],
)
def test_the_tangent_beside_contact_is_kept_while_little_is_left_there(
    norms: list[float], apart: list[float], kept: bool
) -> None:
    convergence = Convergence(StopLimits(0.0, 0.0, 0.03, 20, 0, True))
    for norm, beside in zip(norms, apart, strict=True):
        convergence.add(norm, beside)
    assert convergence.keeps_tangent == kept


def test_contact_alone_is_found_anew_beside_a_kept_tangent() -> None:
    """The sum of contact's tangent where the line is, and of all others' where it was; of translations, as what turns
    with the ends counts among the others.
    """
    at = sample(2)
    others: list[Any] = [at.beam(), at.inertia()]
    places = np.arange(at.line.size) % 3 < 2
    contact = SeabedContact(at.line, np.full(at.line.length.size, 0.1), Plane.level(START[2]), Penalty(1e6, 0.3))
    first, moved = at.state(1), at.state(1)
    compiled = Compiled(at, [*others, contact], at.state(3), first)
    change = 0.1 * np.sin(np.arange(at.line.nodes))
    for u in (compiled.line.step.u, at.line.nodal(moved.u)):
        u[:, 1] += change
    compiled.riser.evaluate()
    convergence = compiled.riser.convergence
    convergence.limits, convergence.norms[:] = convergence.limits._replace(reuse=0.1), [1.0, 0.01]
    assert convergence.keeps_tangent
    assert compiled.riser.improve() == ITERATING
    computed, own, stale, rest = (
        matrix[places][:, places]
        for matrix in (
            assembled(compiled.line.workspace.K),
            tangent([contact], moved, WEIGHTS),
            tangent([contact], first, WEIGHTS),
            tangent(others, first, WEIGHTS),
        )
    )
    assert error(computed, rest + own) < 1e-12
    assert error(computed, rest + stale) > 1e-4


def assembled(K: Array) -> Array:
    """A chain's matrix (n, n) from those of its elements (ne, m, m)."""
    ne, m, _ = K.shape
    out = np.zeros(2 * ((ne + 1) * (m // 2),))
    for e in range(ne):
        out[e * m // 2 : e * m // 2 + m, e * m // 2 : e * m // 2 + m] += K[e]
    return out
