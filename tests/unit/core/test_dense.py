"""Dense factors in compiled code, beside LAPACK's."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core import dense


@pytest.mark.parametrize("n", [0, 1, 2, 7, 40])
def test_it_solves(n: int) -> None:
    random = np.random.default_rng(n)
    a, b = random.normal(size=(n, n)), random.normal(size=n)
    if n > 1:
        a[0, 0] = 0.0  # rows must be exchanged
    factors, x, pivots = a.copy(), b.copy(), np.zeros(n, dtype=dense.PIVOT)
    assert dense.factorise(factors, pivots)
    dense.solve(factors, pivots, x)
    np.testing.assert_allclose(x, np.linalg.solve(a, b), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_matrix_without_an_inverse_is_reported(value: float) -> None:
    a = np.eye(4)
    a[2, 2] = value
    assert not dense.factorise(a, np.zeros(4, dtype=dense.PIVOT))
