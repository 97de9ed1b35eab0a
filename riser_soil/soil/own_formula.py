"""Formulas of laws of one's own: what a user's class answers, as the program asks for it.

A class has one of three methods. Components are those of `mandel`, tension positive, unless said otherwise.

- `update(increment, history, dt)`, as of `law.Formula`: it returns stress (n, 6), tangent (n, 6, 6) and history
  (n, nh), and may return energy stored (n,) and elastic strain (n, 6) behind them. `columns` names what the history
  holds, the six of the stress first; six columns from name_xx to name_yz are a tensor that turns with the material.
  `start()` is the history at first: by default the initial stress, and zeros. `symmetric` says that the tangent is,
  `by_rate = False` that dt does not matter, `overstress(stress)` what share of its strength is used.
- `evaluate(t, del_t, grad_del_u, stress, tangent, history)` of fenics-constitutive: flat arrays, overwritten; which of
  its two last components is yz, and which xz, has changed between its releases, and is found out by a trial.
- `psi(eps)`: energy density by the strain since the start, a tensor of UFL; `psi(eps, depth)` with the depth [m].
"""

from __future__ import annotations

import math
import re
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any
from weakref import WeakSet

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil import mandel
from riser_soil.soil.law import PLACES, STRESS, StressUpdate
from riser_soil.soil.law_source import LawError, failure_in_words

SHORTEST, LONGEST = 1e-9, 1e12  # s; "at once" and "slow" for a law that divides by the time
PROBE = 1e-6  # strain
_WARNED = WeakSet[type]()  # classes of which a failure has been reported


def call_user_code(call: Callable[[], Any]) -> Any:
    """Return value of user code; LawError, with its place, where it fails."""
    try:
        return call()
    except LawError:
        raise
    except Exception as err:
        raise LawError(failure_in_words(err)) from err


class OwnFormula(ABC):
    """A user's law at n points, depths (n,) [m] and initial stress (n, 6) [Pa]. label: of its messages."""

    columns: tuple[str, ...]

    def __init__(self, law: Any, depth: Array, initial: Array, label: str) -> None:
        self.law, self.depth, self.initial, self.label = law, depth, initial, label

    @property
    def symmetric(self) -> bool:
        return bool(getattr(self.law, "symmetric", False))

    @property
    def by_rate(self) -> bool:
        return bool(getattr(self.law, "by_rate", True))

    @property
    def bulk(self) -> Array:
        return self._elastic[0]

    @property
    def shear(self) -> Array:
        return self._elastic[1]

    @cached_property
    def _elastic(self) -> tuple[Array, Array]:
        """Bulk and shear modulus (n,) [Pa] nearest to the tangent of an increment that is none."""
        dt = 0.0 if self.by_rate else math.inf
        C = self.response(np.zeros((len(self.depth), 6)), self.start(), dt)[1]
        bulk = np.einsum("i,nij,j->n", mandel.UNIT, C, mandel.UNIT) / 9.0
        return bulk, np.einsum("ij,nij->n", mandel.DEVIATOR, C) / 10.0

    def start(self) -> Array:
        return np.column_stack((self.initial, np.zeros((len(self.initial), len(self.columns) - 6))))

    @abstractmethod
    def response(self, increment: Array, history: Array, dt: float) -> Sequence[Array]:
        """Stress, tangent, history, and where it is known energy stored and elastic strain; LawError."""

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        """An response that is none, nan, makes the solver try a smaller step."""
        try:
            response = self.response(strain_increment, history, dt)
            self._warn_of_infinite(strain_increment, response[0], response[1])
        except LawError as err:
            self._warn(f"{err}: the step is tried again with a smaller one")
            response = [np.full((len(self.depth), *shape), np.nan) for shape in ((6,), (6, 6), (len(self.columns),))]
        return self._with_energy(response)

    def _with_energy(self, response: Sequence[Array]) -> StressUpdate:
        if len(response) == 5:
            return StressUpdate(*response)
        change = response[0] - self.initial
        elastic = mandel.elastic_strain(self.bulk, self.shear, change)
        return StressUpdate(response[0], response[1], response[2], 0.5 * mandel.product(change, elastic), elastic)

    def _warn_of_infinite(self, increment: Array, stress: Array, tangent: Array) -> None:
        finite = np.isfinite(stress).all(axis=1) & np.isfinite(tangent).all(axis=(1, 2))
        if not finite.all():
            at = int(np.argmin(finite))
            self._warn(f"{infinite(self.depth[at], increment[at])}: the step is tried again with a smaller one")

    def _warn(self, text: str) -> None:
        """Once of a class: what follows is likely to be the same."""
        if type(self.law) not in _WARNED:
            print(f"warning: {self.label}: {text}", file=sys.stderr)
        _WARNED.add(type(self.law))

    def overstress(self, stress: Array) -> Array:
        own = getattr(self.law, "overstress", None)
        if own is None:
            return np.zeros(len(stress))
        return as_array(call_user_code(lambda: own(stress)), (len(stress),), "overstress")


def infinite(depth: float, increment: Array) -> str:
    """Place of an infinite value, in words."""
    return f"{at_point(depth, increment)}: stress or tangent is not finite"


def at_point(depth: float, increment: Array) -> str:
    """A depth [m], and a strain increment (6,) in the engineer's components, in words."""
    names = ("eps_xx", "eps_yy", "eps_zz", "gamma_xy", "gamma_xz", "gamma_yz")
    values = increment * np.array([1.0, 1.0, 1.0, *[math.sqrt(2.0)] * 3])
    strain = ", ".join(f"{name} {value:.3g}" for name, value in zip(names, values, strict=True) if value != 0.0)
    return f"at a depth of {depth:.4g} m, for a strain increment of {strain or '0'}"


def as_array(values: Any, shape: tuple[int, ...], name: str) -> Array:
    """LawError where the shape is another one."""
    try:
        array = np.asarray(values, dtype=float, order="C")
    except (TypeError, ValueError) as err:
        raise LawError(f"{name} is no array of numbers") from err
    if array.shape != shape:
        raise LawError(f"{name} has the shape {array.shape}, and must have {shape}")
    return array


class UpdateFormula(OwnFormula):
    """Law by a user's class with this program's `update`."""

    def __init__(self, law: Any, depth: Array, initial: Array, label: str) -> None:
        super().__init__(law, depth, initial, label)
        self.columns = _checked_columns(getattr(law, "columns", STRESS))

    def start(self) -> Array:
        own = getattr(self.law, "start", None)
        if own is None:
            return super().start()
        return as_array(call_user_code(own), (len(self.depth), len(self.columns)), "start()")

    def response(self, increment: Array, history: Array, dt: float) -> Sequence[Array]:
        response = call_user_code(lambda: self.law.update(increment, history, dt))
        if not isinstance(response, tuple | list) or len(response) not in (3, 5):
            what = "stress, tangent, history, and may return stored and elastic behind them"
            raise LawError(f"update must return {what}, and returns {_kind(response)}")
        n = len(self.depth)
        shapes = ((n, 6), (n, 6, 6), (n, len(self.columns)), (n,), (n, 6))
        return [as_array(*each) for each in zip(response, shapes, StressUpdate._fields, strict=False)]


def _kind(value: Any) -> str:
    return f"{len(value)} values" if isinstance(value, tuple | list) else type(value).__name__


def _checked_columns(given: Any) -> tuple[str, ...]:
    columns = tuple(given) if isinstance(given, tuple | list) else ()
    if not columns or not all(isinstance(name, str) and re.fullmatch(r"[A-Za-z]\w*", name) for name in columns):
        raise LawError("columns must be a tuple of names, of letters, digits and underscores")
    if columns[:6] != STRESS:
        raise LawError(f"columns must begin with the stress, {', '.join(STRESS)}")
    if len({*columns}) < len(columns):
        raise LawError("columns has a name twice")
    unnamed = [*columns]
    for stem in [name[:-3] for name in columns if name.endswith(f"_{PLACES[0]}")]:
        tensor = [f"{stem}_{place}" for place in PLACES]
        if "/".join(tensor) in "/".join(columns):
            unnamed = [name for name in unnamed if name not in tensor]
    wrong = [name for name in unnamed if re.search("_(x|y|z|xx|yy|zz|xy|xz|yz)$", name)]
    if wrong:
        what = f"is named as a component of a tensor, and lacks the others beside it, {', '.join(PLACES)}"
        raise LawError(f"columns: {wrong[0]} {what}; give all six in this order, or another name")
    return columns


class ConstitutiveFormula(OwnFormula):
    """Law by a user's class with fenics-constitutive's `evaluate`. A history of six numbers is a tensor, which turns.
    """

    def __init__(self, law: Any, depth: Array, initial: Array, label: str) -> None:
        super().__init__(law, depth, initial, label)
        dimensions = call_user_code(lambda: getattr(law, "history_dim", None))
        self._sizes = {key: _size_of(key, size) for key, size in (dimensions or {}).items()}
        self.columns = _checked_columns((*STRESS, *(n for key, size in self._sizes.items() for n in _names(key, size))))
        full = call_user_code(lambda: getattr(law, "stress_strain_dim", 6))
        if full != 6:
            raise LawError(f"its constraint has {full} components of stress, and must be FULL, which has six")

    @cached_property
    def _order(self) -> list[int]:
        """Places of the six components in the law's vectors."""
        probe, start = np.zeros((len(self.depth), 6)), self.start()
        probe[:, 5] = PROBE
        answers = np.abs(self._evaluated(probe, start, SHORTEST, [*range(6)])[0] - self.initial)[:, 4:].max(axis=0)
        if not 4.0 * answers.min() < answers.max():
            raise LawError("whether yz or xz is its fifth component can't be seen from its response to a shear yz")
        return [0, 1, 2, 3, 4, 5] if answers[1] > answers[0] else [0, 1, 2, 3, 5, 4]

    def response(self, increment: Array, history: Array, dt: float) -> Sequence[Array]:
        return self._evaluated(increment, history, min(max(dt, SHORTEST), LONGEST), self._order)

    def _evaluated(self, increment: Array, history: Array, dt: float, order: list[int]) -> Sequence[Array]:
        n, first = len(increment), 6
        stress, tangent = history[:, :6][:, order].ravel(), np.zeros(36 * n)
        histories = dict[str, Array]()
        for key, size in self._sizes.items():
            values = history[:, first : first + size]
            histories[key], first = (values[:, order] if size == 6 else values).ravel(), first + size
        gradient = (increment[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]] * _GRADIENT).ravel()
        history_of_law = histories if self._sizes else None
        call_user_code(lambda: self.law.evaluate(0.0, dt, gradient, stress, tangent, history_of_law))
        after = [stress.reshape(n, 6)[:, order]]
        for key, size in self._sizes.items():
            values = as_array(histories.get(key), (n * size,), f"history {key}").reshape(n, size)
            after.append(values[:, order] if size == 6 else values)
        return after[0], np.ascontiguousarray(tangent.reshape(n, 6, 6)[:, order][:, :, order]), np.column_stack(after)


_GRADIENT = np.sqrt([1.0, 0.5, 0.5, 0.5, 1.0, 0.5, 0.5, 0.5, 1.0])


def _size_of(key: str, size: Any) -> int:
    if isinstance(size, int) and size > 0:
        return size
    raise LawError(f"history_dim: {key} has the dimension {size}, and must be a number, six of a symmetric tensor")


def _names(key: str, size: int) -> list[str]:
    if size == 6:
        return [f"{key}_{place}" for place in PLACES]
    return [key] if size == 1 else [f"{key}_{n}" for n in range(size)]
