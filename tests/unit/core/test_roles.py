"""Roles of parts: what is declared is there, and what is there is declared; otherwise a stage does not start."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.core.part import Model, State, Traits
from riser_soil.core.roles import Adaptive, MomentumCorrecting, Predictor, owners, with_role
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.core.system import System, Timer, total
from riser_soil.solve.time_scheme import Static
from tests.support.said import telling
from tests.support.toy_chain import Chain, Floor


def _fail(*_: object) -> NoReturn:
    raise AssertionError


FAIL: Any = _fail


class Foreseen(Floor):
    """A floor that predicts."""

    traits = Traits("E", symmetric=True, roles=(Predictor,))

    def predict(self, guess: State) -> Array:
        return guess.u


class Misspelt(Floor):
    traits = Traits("E", symmetric=True, roles=(Predictor,))

    def predcit(self, guess: State) -> Array:
        return guess.u


class Undeclared(Foreseen):
    traits = Traits("E", symmetric=True)


class Asleep(Floor):
    """A floor that this rank does not evaluate, and that would fail."""

    active = False
    blocks = residual = tangent = energy = work = commit = FAIL


class Keeping(Floor):
    """A floor that remembers."""

    traits = Traits("E", symmetric=True, roles=(Stateful,))

    def state(self) -> Saved:
        return {}

    def restore(self, saved: Saved) -> None:
        pass


def start(kind: type[Floor]) -> System:
    chain = Chain(np.array([1.0, 2.0]))
    return System(MPI.COMM_SELF, Model([chain], [kind(chain, 1e3)]), Timer.new())


def test_a_declared_role_is_played() -> None:
    system = start(Foreseen)
    assert len(with_role(system.model.parts, Predictor)) == 1
    assert all(not with_role(system.model.parts, role) for role in (Adaptive, MomentumCorrecting, Stateful))
    system.destroy()


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        (Misspelt, 'part "contact": the role Predictor, predict, is declared and not there'),
        (Undeclared, 'part "contact": the role Predictor, predict, is there and not declared'),
    ],
)
def test_a_misspelt_or_undeclared_role_is_an_error_at_the_start(kind: type[Floor], says: str) -> None:
    with pytest.raises(TypeError, match=says):
        start(kind)


def test_what_keeps_a_state_has_a_name_of_its_own() -> None:
    """Two of one name would be saved as one, and the other's state lost."""
    chain = Chain(np.array([1.0, 2.0]))
    one, other, forgetful = Keeping(chain, 1e3), Keeping(chain, 1e3), Floor(chain, 1e3)
    assert owners(Model([chain], [one, forgetful])) == {"fields/chain": chain, "parts/contact": one}
    with pytest.raises(ValueError, match=telling("more than one", '"parts/contact"')):
        System(MPI.COMM_SELF, Model([chain], [one, forgetful, other]), Timer.new())
    with pytest.raises(ValueError, match=telling("more than one", '"fields/chain"')):
        System(MPI.COMM_SELF, Model([chain, Chain(np.zeros(1))]), Timer.new())


def test_a_part_that_is_not_active_is_asked_for_nothing() -> None:
    system = start(Asleep)
    state = State.at_rest(0.0, 2)
    assert not np.any(total(system.forces(state)))
    system.assemble(state, Static().weights(1.0))
    assert system.energy(state).total == 0.0
    assert list(system.work(state, state)) == ["contact"]
    system.commit(state)
    system.destroy()
