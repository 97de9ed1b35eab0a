"""Array types for signatures.

Arrays are of double precision and of 64-bit integers. Their types leave the width open: numpy 2 declares for many of
its functions only that they return a floating or an integer type, and one annotation has to hold for numpy 1 and 2.
"""

import math
from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.floating[Any]]
ComplexArray = npt.NDArray[np.complexfloating[Any, Any]]
IntArray = npt.NDArray[np.signedinteger[Any]]
BoolArray = npt.NDArray[np.bool_]


def as_list(values: npt.NDArray[Any]) -> list[Any]:
    """Numbers of an array, which has axes, as Python's own: a list of them, or of lists."""
    return cast(list[Any], values.tolist())


def views(vector: Array, shapes: Sequence[tuple[int, ...]]) -> list[Array]:
    """Arrays of these shapes, which lie one behind the other along a vector's last axis; axes before it stay."""
    first, arrays = 0, []
    for shape in shapes:
        end = first + math.prod(shape)
        arrays.append(vector[..., first:end].reshape(*vector.shape[:-1], *shape))
        first = end
    return arrays
