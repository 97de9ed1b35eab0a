"""Trial of a law of one's own before a run: what it does wrong at some points, along some paths of strain.

From its start each point is compressed, and sheared in several ways, by strains that grow a thousandfold. Its response
must be finite and of the right shapes, leave its inputs as they are, start from the initial stress, and follow dt only
where it says so. Its tangent must be the derivative of its stress, by differences: off by no more than `OFF` of the
elastic moduli, stress and strain being scaled by their square roots, so that a stiff volume hides no error of shear.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil import mandel
from riser_soil.soil.law import PLACES
from riser_soil.soil.law_source import LawError
from riser_soil.soil.own_formula import OwnFormula, at_point, infinite

POINTS = 6
SIZES = (1e-5, 1e-4, 1e-3, 1e-2)  # sizes of the strain
STEPS = (1e-3, 1e-5)  # of differences, over the increment: at a kink of the stress one of them may lie across it
OFF, UNSYMMETRIC, SAME = 1e-4, 1e-6, 1e-6
ZERO_MODULUS = 1e-12  # a modulus below this share of their sum counts as zero
SECOND = 1.0
DIRECTIONS = (  # compression of the volume; simple shear; compression along z and shear at constant volume
    -mandel.UNIT / np.sqrt(3.0),
    np.array([0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    np.array([0.5, 0.5, -1.0, 0.0, 0.0, 0.0]) / np.sqrt(1.5),
    np.array([0.4, -0.1, -0.3, 0.5, -0.6, 0.3]) / np.sqrt(0.96),
)
Make = Callable[[Array, Array], OwnFormula]

_MOVES = np.concatenate([np.zeros((1, 6)), *(sign * step * np.eye(6) for step in STEPS for sign in (1.0, -1.0))])


def try_out(make: Make, depth: Array, initial: Array) -> None:
    """Raises LawError for what the law does wrong at some of the points, depths (n,) [m], initial stress (n, 6) [Pa].

    make: the formula at depths and initial stress. Where that is beyond the law's own limit there is no trial: the
    scene is refused anyway.
    """
    order = np.argsort(depth)
    at = order[np.unique(np.linspace(0, len(order) - 1, POINTS).round().astype(int))]
    at = at[make(depth[at], initial[at]).overstress(initial[at]) <= 1.0]
    if not at.size:
        return
    with np.errstate(all="ignore"):  # values that are not finite get a message of their own
        _begins_at_rest(make(depth[at], initial[at]))
        each = np.repeat(at, len(_MOVES))
        law = make(depth[each], initial[each])
        for direction in DIRECTIONS:
            for dt in (math.inf, SECOND, 0.0) if law.by_rate else (math.inf,):
                _follow(law, direction, dt)


def _begins_at_rest(law: OwnFormula) -> None:
    """Check the law at rest: history, elastic moduli, and no change of stress where there is no strain."""
    start, none = law.start(), np.zeros((len(law.depth), 6))
    if not np.isfinite(start).all():
        raise LawError(f"start() is not finite at a depth of {law.depth[_first(start)]:.4g} m")
    scale = np.abs(law.initial).max(axis=1) + 1e-9 * np.abs(law.shear)
    _same(start[:, :6], law, scale, "start() begins with another stress than the initial one")
    for name, values in (("bulk", law.bulk), ("shear", law.shear)):
        wrong = np.flatnonzero(~((values > ZERO_MODULUS * (law.bulk + law.shear)) & np.isfinite(values)))
        if wrong.size:
            where = f"at a depth of {law.depth[wrong[0]]:.4g} m"
            raise LawError(f"{where} its {name} modulus at rest is {values[wrong[0]]:.4g} Pa, and must be above 0")
    stress = law.response(none, start, 0.0 if law.by_rate else math.inf)[0]
    hint = "an increment of no strain, within no time, changes the stress (is the initial one more than it bears?)"
    _same(stress, law, scale, hint)


def _same(stress: Array, law: OwnFormula, scale: Array, wrong: str) -> None:
    off = np.abs(stress - law.initial).max(axis=1)
    bad = np.flatnonzero(~(off <= SAME * scale))
    if bad.size:
        raise LawError(f"at a depth of {law.depth[bad[0]]:.4g} m {wrong}, by {off[bad[0]]:.4g} Pa")


def _first(values: Array) -> int:
    """The first row with a number that is not finite."""
    return int(np.argmin(np.isfinite(values).all(axis=tuple(range(1, values.ndim)))))


def _follow(law: OwnFormula, direction: Array, dt: float) -> None:
    """Follow the law from the start, in increments of growing size."""
    history, before = law.start(), 0.0
    for size in SIZES:
        length = size - before
        increments = np.tile(length * (direction + _MOVES), (len(law.depth) // len(_MOVES), 1))
        response = _responded(law, increments, history, dt)
        _check_tangent(law, increments, response[0], response[1], length)
        if not law.by_rate:
            _check_time(law, increments, history, response[0])
        history, before = np.repeat(response[2][:: len(_MOVES)], len(_MOVES), axis=0), size


def _responded(law: OwnFormula, increments: Array, history: Array, dt: float) -> Sequence[Array]:
    """The law's response to increments and history; LawError where it fails, changes these inputs, or is not finite."""
    strain, before = increments.copy(), history.copy()
    try:
        response = law.response(strain, before, dt)
    except LawError as err:
        raise LawError(f"{at_point(law.depth[0], increments[0])}: {err}") from err
    for name, given, after in (("increment", increments, strain), ("history", history, before)):
        if not np.array_equal(given, after):
            raise LawError(f"{at_point(law.depth[0], increments[0])}: it changes its input {name}; copy it first")
    for values in response:
        if not np.isfinite(values).all():
            at = _first(values)
            place = infinite(law.depth[at], increments[at])
            raise LawError(place.replace("stress or tangent", _named(response, values)))
    return response


def _named(response: Sequence[Array], values: Array) -> str:
    names = ("the stress", "the tangent", "the history", "the energy stored", "the elastic strain")
    return next(name for name, each in zip(names, response, strict=False) if each is values)


def _check_tangent(law: OwnFormula, increments: Array, stress: Array, tangent: Array, length: float) -> None:
    rows = len(_MOVES)
    at = np.arange(0, len(law.depth), rows)
    moved, C = stress.reshape(-1, rows, 6), tangent[at]
    soft = _softened(law.bulk[at], law.shear[at])
    off = np.full(C.shape, np.inf)
    for n, step in enumerate(STEPS):
        first = 1 + 12 * n
        slopes = (moved[:, first : first + 6] - moved[:, first + 6 : first + 12]) / (2.0 * step * length)
        off = np.minimum(off, np.abs(soft @ (slopes.transpose(0, 2, 1) - C) @ soft))
    worst, k = _worst(off)
    if worst > OFF:
        i, j = np.unravel_index(off[k].argmax(), (6, 6))
        raise LawError(
            f"{at_point(law.depth[at[k]], increments[at[k]])}: the tangent is off its stress's differences by "
            f"{worst:.2g} of the elastic moduli, most in that of {PLACES[i]} by {PLACES[j]}; at most {OFF:g} is allowed"
        )
    skew, k = _worst(np.abs(soft @ (C - C.transpose(0, 2, 1)) @ soft))
    if law.symmetric and skew > UNSYMMETRIC:
        raise LawError(
            f"{at_point(law.depth[at[k]], increments[at[k]])}: it says that its tangent is symmetric, which is off by "
            f"{skew:.2g} of the elastic moduli; set symmetric = False"
        )


def _softened(bulk: Array, shear: Array) -> Array:
    """One over the square roots of the elastic moduli, (n, 6, 6)."""
    volume, shape = 1.0 / np.sqrt(3.0 * bulk), 1.0 / np.sqrt(2.0 * shear)
    return np.asarray(volume[:, None, None] * mandel.VOLUME / 3.0 + shape[:, None, None] * mandel.DEVIATOR)


def _worst(off: Array) -> tuple[float, int]:
    """The largest entry, and its point."""
    of_points = off.max(axis=(1, 2))
    k = int(of_points.argmax())
    return float(of_points[k]), k


def _check_time(law: OwnFormula, increments: Array, history: Array, slow: Array) -> None:
    fast = _responded(law, increments, history, SECOND)[0]
    off = np.abs(fast - slow).max(axis=1)
    bad = np.flatnonzero(off > SAME * np.abs(slow).max(axis=1))
    if bad.size:
        where = at_point(law.depth[bad[0]], increments[bad[0]])
        what = f"its stress within {SECOND:g} s is off by {off[bad[0]]:.4g} Pa from that of a slow increment"
        raise LawError(f"{where}: {what}, though by_rate is False; set by_rate = True")
