"""Rows of numbers as whole vectors, for compiled code.

A loop over a short row isn't vectorised, as its compiler can't know that what is written lies apart from what is read.
Here a row whose length is known beforehand is read as one vector before anything is written.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from riser_soil.core.arrays import Array

DOUBLE, FUSED = ir.DoubleType(), ("contract",)
Size = tuple[int, ...]  # of `compiled.fixed`; or an array, where a length is not known as it is compiled


def add_multiple(out: Array, at: int, factor: float, rows: Array, start: int, N: Size) -> None:
    """Add `factor` times len(N) numbers of `rows`, from `start` on, to those of `out` from `at` on.

    out, rows: contiguous, of any shape; at and start count single numbers in them.
    """
    flat, given = out.reshape(-1), rows.reshape(-1)
    flat[at : at + len(N)] += factor * given[start : start + len(N)]


@overload(add_multiple, inline="always", strict=False)
def _chosen(out: Any, at: Any, factor: Any, rows: Any, start: Any, N: Any) -> Any:
    if isinstance(N, types.BaseTuple) and len(N) == 0:
        return lambda out, at, factor, rows, start, N: None
    if isinstance(N, types.BaseTuple):
        return lambda out, at, factor, rows, start, N: _add(out, at, factor, rows, start, N)

    def one_by_one(out: Array, at: int, factor: float, rows: Array, start: int, N: Array) -> None:
        flat, given = out.reshape(out.size), rows.reshape(rows.size)
        for n in range(N.size):
            flat[at + n] += factor * given[start + n]

    return one_by_one


def add_shaped(
    out: Array, at: int, four: Array, first: int, A: Array, row: int, rows: Array, start: int, D: Size, R: Size
) -> None:
    """Add row `row` of A (d, d) times `rows` (d, n), its blocks of d, r, d and r columns times four factors.

    out, four, A, rows: contiguous, of any shape; at, first and start: where in them what is meant begins, counted in
    single numbers. n = 2 (d + r), d = len(D), r = len(R).
    """
    d, n = len(D), 2 * (len(D) + len(R))
    factors = np.repeat(four.reshape(-1)[first : first + 4], [d, len(R)] * 2)
    product = A.reshape(-1)[row * d : row * d + d] @ rows.reshape(-1)[start : start + d * n].reshape(d, n)
    out.reshape(-1)[at : at + n] += factors * product


@overload(add_shaped, inline="always", strict=False)
def _shaped(
    out: Any, at: Any, four: Any, first: Any, A: Any, row: Any, rows: Any, start: Any, D: Any, R: Any
) -> Any:
    return lambda out, at, four, first, A, row, rows, start, D, R: _add_shaped(
        out, at, four, first, A, row * len(D), rows, start, D, R
    )


@intrinsic
def _add(context: Any, out: Any, at: Any, factor: Any, rows: Any, start: Any, N: Any) -> Any:
    """What `add_multiple` does."""
    signature = types.void(out, types.intp, types.float64, rows, types.intp, N)

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        place = _Places(target, builder, signature, given)
        to = place(0, len(N))
        before, row = builder.load(to, align=8), builder.load(place(3, len(N)), align=8)
        factors = _spread(builder, [given[2]], [0] * len(N))
        builder.store(builder.fadd(before, builder.fmul(factors, row, flags=FUSED), flags=FUSED), to, align=8)
        return target.get_dummy_value()

    return signature, add


@intrinsic
def _add_shaped(
    context: Any, out: Any, at: Any, four: Any, first: Any, A: Any, row: Any, rows: Any, start: Any, D: Any, R: Any
) -> Any:
    """What `add_shaped` does; row: where it begins in A."""
    d, n = len(D), 2 * (len(D) + len(R))
    blocks = [*[0] * d, *[1] * len(R), *[2] * d, *[3] * len(R)]
    signature = types.void(out, types.intp, four, types.intp, A, types.intp, rows, types.intp, D, R)

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        place = _Places(target, builder, signature, given)
        to = place(0, n)
        before = builder.load(to, align=8)
        factors = _spread(builder, [builder.load(place(2, shift=k)) for k in range(4)], blocks)
        product = None
        for j in range(d):
            by = _spread(builder, [builder.load(place(4, shift=j))], [0] * n)
            part = builder.fmul(by, builder.load(place(6, n, shift=j * n), align=8), flags=FUSED)
            product = part if product is None else builder.fadd(product, part, flags=FUSED)
        builder.store(builder.fadd(before, builder.fmul(factors, product, flags=FUSED), flags=FUSED), to, align=8)
        return target.get_dummy_value()

    return signature, add


class _Places:
    """Pointers to a number, or to n of them, in arrays that are given each with the place of the first number."""

    def __init__(self, target: Any, builder: Any, signature: Any, given: Any) -> None:
        self._target, self._builder, self._kinds, self._given = target, builder, signature.args, given

    def __call__(self, k: int, n: int | None = None, shift: int = 0) -> Any:
        kind, builder = self._kinds[k], self._builder
        assert kind.layout == "C"
        assert kind.dtype == types.float64
        data = self._target.make_array(kind)(self._target, builder, self._given[k]).data
        first = builder.gep(builder.gep(data, [self._given[k + 1]]), [self._target.get_constant(types.intp, shift)])
        return first if n is None else builder.bitcast(first, ir.VectorType(DOUBLE, n).as_pointer())


def _spread(builder: Any, values: list[Any], blocks: list[int]) -> Any:
    """A vector of numbers; blocks: which of the values stands where."""
    kind = ir.VectorType(DOUBLE, len(values))
    few = ir.Constant(kind, ir.Undefined)
    for n, value in enumerate(values):
        few = builder.insert_element(few, value, ir.IntType(32)(n))
    where = ir.Constant(ir.VectorType(ir.IntType(32), len(blocks)), blocks)
    return builder.shuffle_vector(few, ir.Constant(kind, ir.Undefined), where)
