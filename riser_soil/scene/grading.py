"""Graded element lengths: geometric growth along a segment."""

import math


def graded_lengths(length: float, first: float, last: float) -> tuple[float, ...]:
    """Lengths [m] that add up to `length`, each the same multiple of the one before, from about `first` to `last`.

    Their number n is the least for which none exceeds the given length: n - 1 equal quotients lead from `first` to
    `last`, and a common factor, between 1 - 1/n and 1 for n > 2, makes the sum right. first = last: n equal lengths.
    """
    n = graded_count(length, first, last)
    if n == 1 or first == last:
        return (length / n,) * n
    terms = [first * (last / first) ** (k / (n - 1)) for k in range(n)]
    scale = length / math.fsum(terms)
    return tuple(scale * term for term in terms)


def graded_count(length: float, first: float, last: float) -> int:
    """How many elements there are; found by bisection, as more of them are always longer together."""
    too_few, enough = 0, max(1, math.ceil(length / min(first, last)) + 1)
    while enough - too_few > 1:
        n = (too_few + enough) // 2
        if _sum(n, first, last) >= length * (1.0 - 1e-9):
            enough = n
        else:
            too_few = n
    return enough


def _sum(n: int, first: float, last: float) -> float:
    """Sum of the n terms of the geometric series from `first` to `last`; of one term the smaller."""
    growth = math.log(last / first)
    if n == 1 or growth == 0.0:
        return n * min(first, last)
    return first * math.expm1(growth * n / (n - 1)) / math.expm1(growth / (n - 1))
