"""Rows of numbers as whole vectors, for compiled code. This is the one file with machine code by hand.

A loop over a short row isn't vectorised, as its compiler can't know that what is written lies apart from what is read.
Here a row whose length is known beforehand is read as whole vectors before anything is written, in LLVM's words. Each
function stands as plain loops, which say what it does, are what Python calls, and what a test compares with; beneath is
what compiled code has in its place. Without that, a step of a storm takes longer, see docs/kernels.md. Arrays are
contiguous, and what is written lies apart from what is read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from inspect import signature
from typing import Any

from llvmlite import binding, ir
from numba import types
from numba.extending import intrinsic, overload, register_jitable

from riser_soil.core.arrays import Array

Size = tuple[int, ...]  # of `compiled.fixed`; or an array, where a length is not known as it is compiled
Term = tuple[Array, Array, Array]
Vector = Array | tuple[float, ...]

WORD, INDEX, DOUBLE = ir.IntType(64), ir.IntType(32), ir.DoubleType()
NOTHING = ir.Constant(ir.IntType(8).as_pointer(), None)  # what a function returns that returns nothing
ITEMS = 4  # the field of an array, as numba has it, that says where its items lie
FUSED = ("contract",)
WIDTHS = 4, 2, 1  # of vectors that make up a row
ONE, EIGHT = (0,), (0,) * 8  # lengths of rows


def machine_code_of(plain: Any) -> Callable[[Any], Any]:
    """A decorator: compiled code has this, a function for numba's `intrinsic`, where it calls the plain function."""
    names = ", ".join(signature(plain).parameters)

    def take(typed: Any) -> Any:
        made: dict[str, Any] = {"code": intrinsic(typed)}
        exec(f"def call({names}):\n    return code({names})\n", made)
        overload(plain, inline="always", strict=False)(lambda *_: made["call"])
        return made["code"]

    return take


def name_in_machine_code(name: str, address: int) -> None:
    """Let a name stand for what lies at an address of this process, such as a C function."""
    binding.add_symbol(name, address)


def as_tuple(values: Vector, D: Size) -> tuple[float, ...]:
    """Two or three numbers, as D says, apart from the array: what is written later can't change them."""
    return tuple(values[: len(D)])


@overload(as_tuple, inline="always", strict=False)
def _as_tuple(values: Any, D: Any) -> Any:
    if len(D) == 2:
        return lambda values, D: (values[0], values[1])
    return lambda values, D: (values[0], values[1], values[2])


def times(factor: float, vector: tuple[float, ...]) -> tuple[float, ...]:
    """A vector of two or three numbers times a factor."""
    return tuple(factor * each for each in vector)


@overload(times, inline="always", strict=False)
def _times(factor: Any, vector: Any) -> Any:
    if len(vector) == 2:
        return lambda factor, vector: (factor * vector[0], factor * vector[1])
    return lambda factor, vector: (factor * vector[0], factor * vector[1], factor * vector[2])


def add_multiple(out: Array, at: int, factor: float, rows: Array, start: int, N: Size) -> None:
    """Add `factor` times len(N) numbers of `rows`, from `start` on, to those of `out` from `at` on.

    out, rows: of any shape; at and start count single numbers in them.
    """
    to, given = out.reshape(out.size), rows.reshape(rows.size)
    for n in range(len(N)):
        to[at + n] += factor * given[start + n]


@overload(add_multiple, inline="always", strict=False)
def _chosen(out: Any, at: Any, factor: Any, rows: Any, start: Any, N: Any) -> Any:
    if not isinstance(N, types.BaseTuple):
        return lambda out, at, factor, rows, start, N: _add_by_eights(out, at, factor, rows, start, N)
    if len(N) == 0:
        return lambda out, at, factor, rows, start, N: None
    return lambda out, at, factor, rows, start, N: _add_multiple(out, at, factor, rows, start, N)


def _add_by_eights(out: Array, at: int, factor: float, rows: Array, start: int, N: Array) -> None:
    """Rows whose length is not known as this is compiled."""
    n = 0
    while n + 8 <= len(N):
        _add_multiple(out, at + n, factor, rows, start + n, EIGHT)
        n += 8
    while n < len(N):
        _add_multiple(out, at + n, factor, rows, start + n, ONE)
        n += 1


overload(_add_by_eights, jit_options={"forceinline": True}, strict=False)(lambda *_: _add_by_eights)


@intrinsic
def _add_multiple(context: Any, out: Any, at: Any, factor: Any, rows: Any, start: Any, N: Any) -> Any:
    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, len(N))
        to = builder.gep(_data(builder, out, given[0]), [given[1]])
        row = rows_of.load(builder.gep(_data(builder, rows, given[3]), [given[4]]))
        rows_of.store(rows_of.sum(rows_of.load(to), rows_of.times(rows_of.spread(given[2]), row)), to)
        return NOTHING

    return types.void(out, types.intp, types.float64, rows, types.intp, N), add


def numbers_at(values: Array, start: int, D: Size) -> tuple[float, ...]:
    """len(D) numbers of an array of any shape, from `start` on, counted in single numbers."""
    given = values.reshape(values.size)
    return tuple(float(given[start + i]) for i in range(len(D)))


@machine_code_of(numbers_at)
def _numbers_at(context: Any, values: Any, start: Any, D: Any) -> Any:
    found = types.UniTuple(types.float64, len(D))

    def read(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        first = builder.gep(_data(builder, values, given[0]), [given[1]])
        return _numbers(builder, [builder.load(_at(builder, first, i)) for i in range(len(D))])

    return found(values, types.intp, D), read


def combined(terms: Sequence[tuple[float, Array, int]], D: Size) -> tuple[float, ...]:
    """Sum of vectors (d,), each a factor times numbers of an array from a place on, as in `numbers_at`."""
    total = [0.0] * len(D)
    for factor, values, at in terms:
        vector = numbers_at(values, at, D)
        for i in range(len(D)):
            total[i] += factor * vector[i]
    return tuple(total)


@machine_code_of(combined)
def _combined(context: Any, terms: Any, D: Any) -> Any:
    found = types.UniTuple(types.float64, len(D))

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of, total = _Rows(builder, len(D)), list[Any]()
        for t, kinds in enumerate(terms):
            factor, values, at = (builder.extract_value(builder.extract_value(given[0], t), i) for i in range(3))
            row = rows_of.load(builder.gep(_data(builder, kinds[1], values), [at]))
            total = rows_of.sum(total, rows_of.times(rows_of.spread(factor), row))
        return _numbers(builder, rows_of.numbers(total))

    return found(terms, D), add


def add_shares(F: Array, start: int, four: Array, first: int, f: tuple[float, ...], D: Size) -> None:
    """Add to four vectors of `F`, from `start` on, f (d,) times one of `four`, from `first` on; as in `numbers_at`."""
    to, weights = F.reshape(F.size), four.reshape(four.size)
    for a in range(4):
        for i in range(len(D)):
            to[start + a * len(D) + i] += weights[first + a] * f[i]


@machine_code_of(add_shares)
def _add_shares(context: Any, F: Any, start: Any, four: Any, first: Any, f: Any, D: Any) -> Any:
    d = len(D)

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, 4 * d)
        to = builder.gep(_data(builder, F, given[0]), [given[1]])
        weights = builder.gep(_data(builder, four, given[2]), [given[3]])
        shares = rows_of.times(rows_of.repeated(weights, d), rows_of.tiled(given[4], d))
        rows_of.store(rows_of.sum(rows_of.load(to), shares), to)
        return NOTHING

    return types.void(F, types.intp, four, types.intp, f, D), add


def two_polynomials(c: Array, start: int, x: float, y: float, N: Size) -> tuple[float, ...]:
    """Two complex polynomials of len(N) terms at x + i y, real and imaginary part of each, and of their derivatives.

    c: for each power, the lowest first, real and imaginary part of both coefficients, from `start` on, as in
    `numbers_at`.
    """
    given, z = c.reshape(c.size), complex(x, y)
    one = one_by = two = two_by = 0.0j
    for n in range(len(N)):
        at = start + 4 * (len(N) - 1 - n)
        one_by, two_by = one_by * z + one, two_by * z + two
        one, two = one * z + complex(given[at], given[at + 1]), two * z + complex(given[at + 2], given[at + 3])
    return one.real, one.imag, two.real, two.imag, one_by.real, one_by.imag, two_by.real, two_by.imag


@machine_code_of(two_polynomials)
def _two_polynomials(context: Any, c: Any, start: Any, x: Any, y: Any, N: Any) -> Any:
    """even and odd powers apart, so that their chains of products run side by side."""
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
        return _numbers(builder, [*rows_of.numbers(values), *rows_of.numbers(slopes)])

    return found(c, types.intp, types.float64, types.float64, N), read


def add_weighed(S: Array, weights: Array, terms: Sequence[Term], D: Size, R: Size) -> None:
    """Add to each of S (4, d, n) its weight (4,) times a sum of terms: a matrix (d, d) times rows (d, n), whose blocks
    of d, r, d and r columns count with four factors (4,). A term is the three of them, factors first.

    n = 2 (d + r), d = len(D), r = len(R).
    """
    d, r = len(D), len(R)
    for four, A, rows in terms:
        for i in range(d):
            for c in range(2 * (d + r)):
                change = 0.0
                for j in range(d):
                    change += A[i, j] * rows[j, c]
                for a in range(4):
                    S[a, i, c] += weights[a] * four[_block(c, d, r)] * change


@register_jitable
def _block(c: int, d: int, r: int) -> int:
    """Which one of four blocks, of d, r, d and r columns, a column is in."""
    return 2 * (c // (d + r)) + (1 if c % (d + r) >= d else 0)


@machine_code_of(add_weighed)
def _add_weighed(context: Any, S: Any, weights: Any, terms: Any, D: Any, R: Any) -> Any:
    """each row is read once."""

    def add(target: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows_of = _Rows(builder, 2 * (len(D) + len(R)))
        change = _change(builder, rows_of, terms, given[2], D, R)
        to, weight = _data(builder, S, given[0]), _data(builder, weights, given[1])
        for a, i, at in _rows_of_shapes(builder, rows_of, to, len(D)):
            by = rows_of.spread(builder.load(_at(builder, weight, a)))
            rows_of.store(rows_of.sum(rows_of.load(at), rows_of.times(by, change[i])), at)
        return NOTHING

    return types.void(S, weights, terms, D, R), add


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


def write_weighed(S: Array, stations: Sequence[tuple[Array, Sequence[Term]]], D: Size, R: Size) -> None:
    """Write to S the sum over some stations, each its weights (4,) and its terms as in `add_weighed`."""
    S[...] = 0.0
    for weights, terms in stations:
        add_weighed(S, weights, terms, D, R)


@machine_code_of(write_weighed)
def _write_weighed(context: Any, S: Any, stations: Any, D: Any, R: Any) -> Any:
    """S is not read."""

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


def write_blocks(S: Array, M: Array, factor: float, rows: Array, D: Size, R: Size) -> None:
    """Write to S (4, d, n) rows (d, n), whose blocks of d, r, d and r columns count with `factor` times a row of
    M (4, 4).
    """
    d, r = len(D), len(R)
    for a in range(4):
        for i in range(d):
            for c in range(2 * (d + r)):
                S[a, i, c] = factor * M[a, _block(c, d, r)] * rows[i, c]


@machine_code_of(write_blocks)
def _write_blocks(context: Any, S: Any, M: Any, factor: Any, rows: Any, D: Any, R: Any) -> Any:
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


def add_pulled_back(out: Array, P: Array, S: Array, D: Size, R: Size) -> None:
    """Add to out (n, n) rows of S (4, d, n): the first and third d as they are, the second and fourth by the transposes
    of P (2, d, r).
    """
    d, r = len(D), len(R)
    for side in range(2):
        at = side * (d + r)
        for c in range(2 * (d + r)):
            for i in range(d):
                out[at + i, c] += S[2 * side, i, c]
                for k in range(r):
                    out[at + d + k, c] += P[side, i, k] * S[2 * side + 1, i, c]


@machine_code_of(add_pulled_back)
def _add_pulled_back(context: Any, out: Any, P: Any, S: Any, D: Any, R: Any) -> Any:
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
    return builder.extract_value(value, ITEMS)


def _at(builder: Any, data: Any, shift: int) -> Any:
    return builder.gep(data, [WORD(shift)])


def _numbers(builder: Any, values: Sequence[Any]) -> Any:
    """A tuple of numbers, an array of LLVM's."""
    whole = ir.Constant(ir.ArrayType(DOUBLE, len(values)), ir.Undefined)
    for n, value in enumerate(values):
        whole = builder.insert_value(whole, value, n)
    return whole


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
