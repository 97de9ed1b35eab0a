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
    """Code of `rows.add_multiple`."""

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, len(N))
        to = builder.gep(_data(builder, out, given[0]), [given[1]])
        row = rows_of.load(builder.gep(_data(builder, rows, given[3]), [given[4]]))
        rows_of.store(rows_of.sum(rows_of.load(to), rows_of.times(rows_of.spread(given[2]), row)), to)
        return NOTHING

    return types.void(out, types.intp, types.float64, rows, types.intp, N), add


@intrinsic
def numbers_at(context: Any, values: Any, start: Any, D: Any) -> Any:
    """Code of `rows.numbers_at`."""
    found = types.UniTuple(types.float64, len(D))

    def read(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        first = builder.gep(_data(builder, values, given[0]), [given[1]])
        return made_tuple(builder, found, [builder.load(_at(builder, first, i)) for i in range(len(D))])

    return found(values, types.intp, D), read


@intrinsic
def combined(context: Any, terms: Any, D: Any) -> Any:
    """Code of `rows.combined`."""
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
    """Code of `rows.add_shares`."""
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
def two_polynomials(context: Any, c: Any, start: Any, x: Any, y: Any, N: Any) -> Any:
    """See `rows`; even and odd powers apart, so that their chains of products run side by side."""
    found, zero = types.UniTuple(types.float64, 8), [ir.Constant(ir.VectorType(DOUBLE, 4), [0.0] * 4)]

    def read(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of, first = _Rows(builder, 4), builder.gep(_data(builder, c, given[0]), [given[1]])
        once = _Turn(rows_of, given[2], given[3])
        square, sums = once.squared(), list[Any]()
        for parity in range(2):
            value = slope = zero
            for n in reversed(range(parity, len(N), 2)):
                slope = square.added(value, slope)
                value = square.added(rows_of.load(_at(builder, first, 4 * n)), value)
            sums.append((value, slope))
        (even, by_even), (odd, by_odd) = sums
        twice = once.added(by_even, by_odd)
        values, slopes = once.added(even, odd), once.added(odd, rows_of.sum(twice, twice))
        return made_tuple(builder, found, [*rows_of.numbers(values), *rows_of.numbers(slopes)])

    return found(c, types.intp, types.float64, types.float64, N), read


@intrinsic
def add_weighed(context: Any, S: Any, weights: Any, terms: Any, D: Any, R: Any) -> Any:
    """Code of `rows.add_weighed`; each row is read once."""

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
def write_weighed(context: Any, S: Any, stations: Any, D: Any, R: Any) -> Any:
    """Code of `rows.write_weighed`; S is not read."""

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
def write_blocks(context: Any, S: Any, M: Any, factor: Any, rows: Any, D: Any, R: Any) -> Any:
    """Code of `rows.write_blocks`."""
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
    """Code of `rows.add_pulled_back`."""
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
        self.builder, self._places, self.n = builder, list[tuple[int, int]](), n
        while (at := sum(width for _, width in self._places)) < n:
            self._places.append((at, next(width for width in WIDTHS if at + width <= n)))

    def load(self, first: Any) -> list[Any]:
        return [self.builder.load(self._vector(first, *place), align=8) for place in self._places]

    def store(self, row: list[Any], first: Any) -> None:
        for part, place in zip(row, self._places, strict=True):
            self.builder.store(part, self._vector(first, *place), align=8)

    def _vector(self, first: Any, at: int, width: int) -> Any:
        return self.builder.bitcast(_at(self.builder, first, at), ir.VectorType(DOUBLE, width).as_pointer())

    def times(self, one: list[Any], other: list[Any]) -> list[Any]:
        return [self.builder.fmul(a, b, flags=FUSED) for a, b in zip(one, other, strict=True)]

    def sum(self, one: list[Any], other: list[Any]) -> list[Any]:
        """No vectors are no row."""
        if not one:
            return other
        return [self.builder.fadd(a, b, flags=FUSED) for a, b in zip(one, other, strict=True)]

    def spread(self, value: Any) -> list[Any]:
        """A row of the same number."""
        kind = ir.VectorType(DOUBLE, 1)
        one = self.builder.insert_element(ir.Constant(kind, ir.Undefined), value, INDEX(0))
        return self.shuffled(one, [0] * self.n)

    def blocks(self, four: Any, D: Size, R: Size) -> list[Any]:
        """A row of four numbers, each as often as its block has columns."""
        both = [*[0] * len(D), *[1] * len(R)]
        values = self.builder.load(self._vector(four, 0, 4), align=8)
        return self.shuffled(values, [*both, *(2 + k for k in both)])

    def repeated(self, four: Any, d: int) -> list[Any]:
        """A row of four numbers, each d times."""
        values = self.builder.load(self._vector(four, 0, 4), align=8)
        return self.shuffled(values, [k // d for k in range(4 * d)])

    def tiled(self, numbers: Any, d: int) -> list[Any]:
        """A row of a tuple of d numbers, again and again."""
        values = ir.Constant(ir.VectorType(DOUBLE, d), ir.Undefined)
        for i in range(d):
            values = self.builder.insert_element(values, self.builder.extract_value(numbers, i), INDEX(i))
        return self.shuffled(values, [k % d for k in range(self.n)])

    def numbers(self, row: list[Any]) -> list[Any]:
        """The single numbers of a row."""
        both = zip(row, self._places, strict=True)
        return [self.builder.extract_element(part, INDEX(k)) for part, (_, width) in both for k in range(width)]

    def shuffled(self, values: Any, which: list[int]) -> list[Any]:
        """A row of single numbers of a vector."""
        return [self._parts(values, which[at : at + width]) for at, width in self._places]

    def _parts(self, values: Any, which: list[int]) -> Any:
        where = ir.Constant(ir.VectorType(INDEX, len(which)), which)
        return self.builder.shuffle_vector(values, ir.Constant(values.type, ir.Undefined), where)


class _Turn:
    """Products of x + i y with rows of two complex numbers, real part before imaginary part."""

    def __init__(self, rows_of: _Rows, x: Any, y: Any) -> None:
        self._rows_of, self._x, self._y = rows_of, x, y
        signs = ir.Constant(ir.VectorType(DOUBLE, 4), [-1.0, 1.0, -1.0, 1.0])
        self._real, self._imaginary = rows_of.spread(x), rows_of.times(rows_of.spread(y), [signs])

    def added(self, row: list[Any], product: list[Any]) -> list[Any]:
        """A row and the product with another one."""
        rows_of = self._rows_of
        crossed = rows_of.times(rows_of.shuffled(product[0], [1, 0, 3, 2]), self._imaginary)
        return rows_of.sum(rows_of.sum(row, rows_of.times(product, self._real)), crossed)

    def squared(self) -> _Turn:
        """Products with (x + i y)^2."""
        x, y, builder = self._x, self._y, self._rows_of.builder
        real = builder.fsub(builder.fmul(x, x), builder.fmul(y, y))
        half = builder.fmul(x, y)
        return _Turn(self._rows_of, real, builder.fadd(half, half))
