"""Rows of numbers as whole vectors, for compiled code.

A loop over a short row isn't vectorised, as its compiler can't know that what is written lies apart from what is read.
Here a row whose length is known beforehand is read as one vector before anything is written.
"""

from __future__ import annotations

from typing import Any

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


@intrinsic
def _add(context: Any, out: Any, at: Any, factor: Any, rows: Any, start: Any, N: Any) -> Any:
    """What `add_multiple` does."""
    for array in (out, rows):
        assert array.layout == "C"
        assert array.dtype == types.float64
    vector = ir.VectorType(DOUBLE, len(N))

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        def place(n: int) -> Any:
            data = target.make_array(signature.args[n])(target, builder, given[n]).data
            return builder.bitcast(builder.gep(data, [given[n + 1]]), vector.as_pointer())

        to, of = place(0), place(3)
        row, before = builder.load(of, align=8), builder.load(to, align=8)
        every = ir.Constant(ir.VectorType(ir.IntType(32), len(N)), [0] * len(N))
        one = builder.insert_element(ir.Constant(vector, ir.Undefined), given[2], ir.IntType(32)(0))
        factors = builder.shuffle_vector(one, ir.Constant(vector, ir.Undefined), every)
        builder.store(builder.fadd(before, builder.fmul(factors, row, flags=FUSED), flags=FUSED), to, align=8)
        return target.get_dummy_value()

    return types.void(out, types.intp, types.float64, rows, types.intp, N), add
