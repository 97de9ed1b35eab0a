"""The depth at which a seabed bears a pipe: of springs in closed form, of clay by the force at that depth."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.assembly.laid_guess import depth_at_rest
from riser_soil.contact.law import Penalty
from riser_soil.seabed.aubeny_biscontin import AubenyBiscontin
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin

D, W = 0.3, np.array([50.0, 400.0, 1200.0])  # m, N/m
CLAYS = (
    RandolphQuiggin(kind="randolph-quiggin", su=1.5e3, su_gradient=1.5e3, unit_weight=5e3),
    AubenyBiscontin(kind="aubeny-biscontin", su=1.5e3, su_gradient=1.5e3),
)


def test_on_springs() -> None:
    assert depth_at_rest(Penalty(2e4), W, D) == pytest.approx(W / 2e4, rel=1e-12)


def test_on_springs_with_a_rounded_corner() -> None:
    """k (d + s)^2/(4 s) within it, which the lightest is, and k d beyond."""
    k, s = 2e4, 0.01
    assert depth_at_rest(Penalty(k, s), W, D) == pytest.approx([np.sqrt(4.0 * s * W[0] / k) - s, *W[1:] / k], rel=1e-9)


@pytest.mark.parametrize("clay", CLAYS, ids=lambda clay: clay.kind)
def test_on_clay(clay: RandolphQuiggin | AubenyBiscontin) -> None:
    law = clay.of_pipe(D)
    depth = depth_at_rest(law, W, D)
    assert np.all((depth > 0.0) & (depth < D))
    assert law.update(depth, law.initial_history(depth.shape)).force == pytest.approx(W, rel=1e-9)


def test_what_is_too_heavy_finds_no_rest() -> None:
    soft = RandolphQuiggin(kind="randolph-quiggin", su=10.0).of_pipe(D)
    assert list(depth_at_rest(soft, np.array([1.0, 1e6]), D) < np.inf) == [True, False]
