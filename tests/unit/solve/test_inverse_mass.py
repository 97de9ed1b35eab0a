"""Accelerations by the banded mass against a dense solve."""

from __future__ import annotations

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.part import Model
from riser_soil.core.system import System, Timer
from riser_soil.solve.inverse_mass import InverseMass, projectors
from tests.support.toy_chain import Chain, Inertia, Springs


@pytest.mark.parametrize("prescribed", [False, True])
def test_against_a_dense_solve(prescribed: bool) -> None:
    chain = Chain(np.arange(5.0), prescribed=prescribed)
    inertia, springs = Inertia(chain, 2.0), Springs(chain, 1.0, 30.0)
    system = System(MPI.COMM_SELF, Model([chain], [springs, inertia]), Timer.new())
    force = np.array([1.0, -2.0, 0.5, 3.0, 0.1])
    a = InverseMass(system).accelerations(0.0, force)
    expected = force / inertia.nodal()
    expected[0] *= not prescribed
    assert a == pytest.approx(expected, rel=1e-14)
    system.destroy()


def test_massless_dofs_stay() -> None:
    chain = Chain(np.arange(3.0))
    system = System(MPI.COMM_SELF, Model([chain], [Inertia(chain, 0.0)]), Timer.new())
    assert InverseMass(system).accelerations(0.0, np.ones(3)) == pytest.approx(np.zeros(3))
    system.destroy()


def test_nodes_that_move_in_all_directions_are_projected_without_round_off() -> None:
    half = np.random.default_rng(3).normal(size=(4, 6, 6))
    blocks = half @ np.swapaxes(half, 1, 2)
    free = np.ones(15, dtype=bool)
    free[:3] = False
    matrices = projectors(blocks, free)
    assert np.array_equal(matrices[1:], np.broadcast_to(np.eye(3), (4, 3, 3)))
    assert np.array_equal(matrices[0], np.zeros((3, 3)))
