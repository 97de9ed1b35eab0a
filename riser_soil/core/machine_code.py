"""Values in machine code as numba has them: arrays, tuples, nothing; for functions that `intrinsic` takes.

An array is a record of two references that count its users, its numbers of items and of bytes an item, where its items
lie, shape and strides: so `bound` lays it out in memory. A tuple of alike values is an array of LLVM's, another one a
record.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from llvmlite import ir
from numba import types

WORD, INDEX = ir.IntType(64), ir.IntType(32)
ADDRESS = ir.IntType(8).as_pointer()
NOTHING = ir.Constant(ADDRESS, None)  # what a function returns that returns nothing
REFERENCES, ITEMS = 2, 4  # how many fields of an array are references; the one that says where its items lie


def items(builder: Any, array: Any) -> Any:
    """Pointer to the first item of an array."""
    return builder.extract_value(array, ITEMS)


def made_tuple(builder: Any, kind: Any, values: Sequence[Any]) -> Any:
    """A tuple of values."""
    whole = ir.Constant(_record(kind, [value.type for value in values]), ir.Undefined)
    for n, value in enumerate(values):
        whole = builder.insert_value(whole, value, n)
    return whole


def borrowed(builder: Any, kind: Any, place: Any) -> Any:
    """The value that lies at a place, of whose arrays compiled code is told that it doesn't own them.

    Else it counts references at each row that a loop touches, which takes longer than most of the work there.
    """
    if isinstance(kind, types.BaseTuple):
        both = zip(kind.types, _fields(builder, place, len(kind.types)), strict=True)
        return made_tuple(builder, kind, [borrowed(builder, each, field) for each, field in both])
    if isinstance(kind, types.Array):
        array = ir.Constant(stored(kind), None)
        for n, field in enumerate(_fields(builder, place, len(array.type.elements))):
            array = builder.insert_value(array, builder.load(field), n) if n >= REFERENCES else array
        return array
    value = builder.load(place)
    return builder.icmp_unsigned("!=", value, value.type(0)) if isinstance(kind, types.Boolean) else value


def stored(kind: Any) -> Any:
    """LLVM's type of what lies in memory."""
    if isinstance(kind, types.BaseTuple):
        return _record(kind, [stored(each) for each in kind.types])
    if isinstance(kind, types.Array):
        sizes = ir.ArrayType(WORD, kind.ndim)
        return ir.LiteralStructType([ADDRESS, ADDRESS, WORD, WORD, stored(kind.dtype).as_pointer(), sizes, sizes])
    if isinstance(kind, types.Float):
        return {32: ir.FloatType(), 64: ir.DoubleType()}[kind.bitwidth]
    return ir.IntType(8 if isinstance(kind, types.Boolean) else kind.bitwidth)


def _record(kind: Any, each: Sequence[Any]) -> Any:
    alike = isinstance(kind, types.UniTuple | types.NamedUniTuple)
    return ir.ArrayType(each[0], len(each)) if alike else ir.LiteralStructType(each)


def _fields(builder: Any, place: Any, count: int) -> Iterator[Any]:
    """Pointers to the fields of a record or array at a place."""
    for n in range(count):
        yield builder.gep(place, [INDEX(0), INDEX(n)])
