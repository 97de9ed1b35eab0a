"""What `rows` does in machine code: a row is read as vectors of four numbers, two and one before any is written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from riser_soil.core.machine_code import INDEX, NOTHING, WORD, items, made_tuple

DOUBLE, FUSED = ir.DoubleType(), ("contract",)
WIDTHS = 4, 2, 1  # of vectors that make up a row
Size = tuple[int, ...]  # of `compiled.fixed`; or an array, where a length is not known as it is compiled


@intrinsic
def add_multiple(context: Any, out: Any, at: Any, factor: Any, rows: Any, start: Any, N: Any) -> Any:
    """See `rows`."""

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, len(N))
        to = builder.gep(_data(builder, out, given[0]), [given[1]])
        row = rows_of.load(builder.gep(_data(builder, rows, given[3]), [given[4]]))
        rows_of.store(rows_of.sum(rows_of.load(to), rows_of.times(rows_of.spread(given[2]), row)), to)
        return NOTHING

    return types.void(out, types.intp, types.float64, rows, types.intp, N), add


@intrinsic
def numbers_at(context: Any, values: Any, start: Any, D: Any) -> Any:
    """See `rows`."""
    found = types.UniTuple(types.float64, len(D))

    def read(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        first = builder.gep(_data(builder, values, given[0]), [given[1]])
        return made_tuple(builder, found, [builder.load(_at(builder, first, i)) for i in range(len(D))])

    return found(values, types.intp, D), read


@intrinsic
def combined(context: Any, terms: Any, D: Any) -> Any:
    """See `rows`."""
    found = types.UniTuple(types.float64, len(D))

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of, total = _Rows(builder, len(D)), list[Any]()
        for t, kinds in enumerate(terms):
            factor, values, at = (builder.extract_value(builder.extract_value(given[0], t), i) for i in range(3))
            row = rows_of.load(builder.gep(_data(builder, kinds[1], values), [at]))
            total = rows_of.sum(total, rows_of.times(rows_of.spread(factor), row))
        return made_tuple(builder, found, rows_of.numbers(total))

    return found(terms, D), add


@intrinsic
def add_shares(context: Any, F: Any, start: Any, four: Any, first: Any, f: Any, D: Any) -> Any:
    """See `rows`."""
    d = len(D)

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, 4 * d)
        to = builder.gep(_data(builder, F, given[0]), [given[1]])
        weights = builder.gep(_data(builder, four, given[2]), [given[3]])
        shares = rows_of.times(rows_of.repeated(weights, d), rows_of.tiled(given[4], d))
        rows_of.store(rows_of.sum(rows_of.load(to), shares), to)
        return NOTHING

    return types.void(F, types.intp, four, types.intp, f, D), add


@intrinsic
def add_weighed(context: Any, S: Any, weights: Any, terms: Any, D: Any, R: Any) -> Any:
    """See `rows`; each row is read once."""

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, 2 * (len(D) + len(R)))
        change = _change(builder, rows_of, terms, given[2], D, R)
        to, weight = _data(builder, S, given[0]), _data(builder, weights, given[1])
        for a, i, at in _rows_of_shapes(builder, rows_of, to, len(D)):
            by = rows_of.spread(builder.load(_at(builder, weight, a)))
            rows_of.store(rows_of.sum(rows_of.load(at), rows_of.times(by, change[i])), at)
        return NOTHING

    return types.void(S, weights, terms, D, R), add


@intrinsic
def put_weighed(context: Any, S: Any, stations: Any, D: Any, R: Any) -> Any:
    """See `rows`; S is not read."""

    def put(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of, each = _Rows(builder, 2 * (len(D) + len(R))), list[tuple[Any, Any]]()
        for k, (weights, terms) in enumerate(stations):
            weight, values = (builder.extract_value(builder.extract_value(given[1], k), i) for i in range(2))
            change = _change(builder, rows_of, terms, values, D, R)
            each.append((_data(builder, weights, weight), change))
        for a, i, at in _rows_of_shapes(builder, rows_of, _data(builder, S, given[0]), len(D)):
            total = list[Any]()
            for weight, change in each:
                by = rows_of.spread(builder.load(_at(builder, weight, a)))
                total = rows_of.sum(total, rows_of.times(by, change[i]))
            rows_of.store(total, at)
        return NOTHING

    return types.void(S, stations, D, R), put


def _change(builder: Any, rows_of: _Rows, terms: Any, values: Any, D: Size, R: Size) -> list[list[Any]]:
    """Sum of the terms of `rows.add_weighed`: d rows."""
    d, change = len(D), [list[Any]() for _ in range(len(D))]
    for t, kinds in enumerate(terms):
        term = builder.extract_value(values, t)
        four, A, rows = (_data(builder, k, builder.extract_value(term, i)) for i, k in enumerate(kinds))
        factors = rows_of.blocks(four, D, R)
        for j in range(d):
            row = rows_of.times(factors, rows_of.load(_at(builder, rows, j * 2 * (d + len(R)))))
            for i in range(d):
                by = rows_of.spread(builder.load(_at(builder, A, i * d + j)))
                change[i] = rows_of.sum(change[i], rows_of.times(by, row))
    return change


def _rows_of_shapes(builder: Any, rows_of: _Rows, to: Any, d: int) -> Iterator[tuple[int, int, Any]]:
    """Shape function, coordinate and place of each row of S (4, d, n)."""
    for a in range(4):
        for i in range(d):
            yield a, i, _at(builder, to, (a * d + i) * rows_of.n)


@intrinsic
def put_blocks(context: Any, S: Any, M: Any, factor: Any, rows: Any, D: Any, R: Any) -> Any:
    """See `rows`."""
    d, n = len(D), 2 * (len(D) + len(R))

    def put(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, n)
        to, four, of = (_data(builder, kind, given[k]) for k, kind in ((0, S), (1, M), (3, rows)))
        whole = rows_of.spread(given[2])
        each = [rows_of.times(whole, rows_of.load(_at(builder, of, i * n))) for i in range(d)]
        for a in range(4):
            factors = rows_of.blocks(_at(builder, four, 4 * a), D, R)
            for i in range(d):
                rows_of.store(rows_of.times(factors, each[i]), _at(builder, to, (a * d + i) * n))
        return NOTHING

    return types.void(S, M, types.float64, rows, D, R), put


@intrinsic
def add_pulled_back(context: Any, out: Any, P: Any, S: Any, D: Any, R: Any) -> Any:
    """See `rows`."""
    d, r, ndof = len(D), len(R), len(D) + len(R)
    n = 2 * ndof

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, n)
        to, turn, of = (_data(builder, kind, given[k]) for k, kind in ((0, out), (1, P), (2, S)))
        for side in range(2):
            first = 2 * side * d
            for i in range(d):
                at = _at(builder, to, (side * ndof + i) * n)
                row = rows_of.load(_at(builder, of, (first + i) * n))
                rows_of.store(rows_of.sum(rows_of.load(at), row), at)
            turned = [rows_of.load(_at(builder, of, (first + d + i) * n)) for i in range(d)]
            for k in range(r):
                at = _at(builder, to, (side * ndof + d + k) * n)
                total = rows_of.load(at)
                for i in range(d):
                    by = builder.load(_at(builder, turn, (side * d + i) * r + k))
                    total = rows_of.sum(total, rows_of.times(rows_of.spread(by), turned[i]))
                rows_of.store(total, at)
        return NOTHING

    return types.void(out, P, S, D, R), add


def _data(builder: Any, kind: Any, value: Any) -> Any:
    """Pointer to the first number of an array."""
    assert kind.layout == "C"
    assert kind.dtype == types.float64
    return items(builder, value)


def _at(builder: Any, data: Any, shift: int) -> Any:
    return builder.gep(data, [WORD(shift)])


class _Rows:
    """Arithmetic of rows of n numbers, each a list of vectors."""

    def __init__(self, builder: Any, n: int) -> None:
        self._builder, self._places, self.n = builder, list[tuple[int, int]](), n
        while (at := sum(width for _, width in self._places)) < n:
            self._places.append((at, next(width for width in WIDTHS if at + width <= n)))

    def load(self, first: Any) -> list[Any]:
        return [self._builder.load(self._vector(first, *place), align=8) for place in self._places]

    def store(self, row: list[Any], first: Any) -> None:
        for part, place in zip(row, self._places, strict=True):
            self._builder.store(part, self._vector(first, *place), align=8)

    def _vector(self, first: Any, at: int, width: int) -> Any:
        return self._builder.bitcast(_at(self._builder, first, at), ir.VectorType(DOUBLE, width).as_pointer())

    def times(self, one: list[Any], other: list[Any]) -> list[Any]:
        return [self._builder.fmul(a, b, flags=FUSED) for a, b in zip(one, other, strict=True)]

    def sum(self, one: list[Any], other: list[Any]) -> list[Any]:
        """No vectors are no row."""
        if not one:
            return other
        return [self._builder.fadd(a, b, flags=FUSED) for a, b in zip(one, other, strict=True)]

    def spread(self, value: Any) -> list[Any]:
        """A row of the same number."""
        kind = ir.VectorType(DOUBLE, 1)
        one = self._builder.insert_element(ir.Constant(kind, ir.Undefined), value, INDEX(0))
        return self._shuffled(one, [0] * self.n)

    def blocks(self, four: Any, D: Size, R: Size) -> list[Any]:
        """A row of four numbers, each as often as its block has columns."""
        both = [*[0] * len(D), *[1] * len(R)]
        values = self._builder.load(self._vector(four, 0, 4), align=8)
        return self._shuffled(values, [*both, *(2 + k for k in both)])

    def repeated(self, four: Any, d: int) -> list[Any]:
        """A row of four numbers, each d times."""
        values = self._builder.load(self._vector(four, 0, 4), align=8)
        return self._shuffled(values, [k // d for k in range(4 * d)])

    def tiled(self, numbers: Any, d: int) -> list[Any]:
        """A row of a tuple of d numbers, again and again."""
        values = ir.Constant(ir.VectorType(DOUBLE, d), ir.Undefined)
        for i in range(d):
            values = self._builder.insert_element(values, self._builder.extract_value(numbers, i), INDEX(i))
        return self._shuffled(values, [k % d for k in range(self.n)])

    def numbers(self, row: list[Any]) -> list[Any]:
        """The single numbers of a row."""
        both = zip(row, self._places, strict=True)
        return [self._builder.extract_element(part, INDEX(k)) for part, (_, width) in both for k in range(width)]

    def _shuffled(self, values: Any, which: list[int]) -> list[Any]:
        return [self._parts(values, which[at : at + width]) for at, width in self._places]

    def _parts(self, values: Any, which: list[int]) -> Any:
        where = ir.Constant(ir.VectorType(INDEX, len(which)), which)
        return self._builder.shuffle_vector(values, ir.Constant(values.type, ir.Undefined), where)
