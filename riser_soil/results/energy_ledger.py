"""Energy balance of a stage, step by step: the energy ledger.

Two errors of the time integration are distinguished. With F the forces of group F, E those of group E, and W the work
of supports, all that acts takes

    B = du.((F(n) + F(n+1))/2 + E(n+1)) - W

out of the motion in a step (`AcceptedStep.braking`). What the kinetic energy loses beyond it, -(K(n+1) - K(n)) - B, is
the time scheme's own: with linear inertia exactly what alpha_m, alpha_f, beta and gamma dissipate, zero to round-off
for average acceleration (for Newmark's scheme: Hughes, The Finite Element Method, 1987, section 9.4). Forces E take

    A = du.(E(n+1) - E(n))/2

more than by their mean. Where they stop a motion, as in an impact, it loses A. Where supports or weight press slowly
into the ground, they give what the mean asks for, and K does not change: then B = A, and the scheme's own is -A, which
is booked but moves nothing (`Ledger.made`).

The difference between the change of the parts' energies and B is the residual: the error of the mean of nonlinear
forces over a step, zero for linear ones and else of second order. Inertia that turns adds its own such error to the
scheme's share.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict

import numpy as np

from riser_soil.checks.inventory import SPLIT
from riser_soil.core.part import Energy, Work
from riser_soil.core.saved_state import Saved, packed, unpacked
from riser_soil.core.snapshot import Ledger
from riser_soil.solve.time_stepper import AcceptedStep

SPRINGS = ("start spring", "end spring")  # a spring works only as its support turns


class EnergyLedger:
    """Ledger of a stage that begins with some energy [J]. A static stage's does not balance.

    dissipating, working: names of what may dissipate and put in, as the scene has it. They are the ledger's accounts,
    booked on or not.
    """

    def __init__(self, start: Energy, static: bool, dissipating: Sequence[str], working: Sequence[str]) -> None:
        self._start, self._static = start.total, static
        self.ledger = Ledger(
            *(start.kinetic, start.strain, start.potential),
            dissipated_by=dict.fromkeys(dissipating, 0.0),
            work_by=dict.fromkeys(working, 0.0),
        )

    def add(self, energy: Energy, step: AcceptedStep) -> float:
        """Book a step; energy: stored after it. The step's own residual [J]."""
        before, turned = self.ledger, _by_kind(step.turned)
        dissipated_by = _added(before.dissipated_by, (lost for name, work in turned for lost in _losses(name, work)))
        work_by = _added(before.work_by, ((name, work.external) for name, work in turned))
        dissipated, work = (math.fsum(accounts.values()) for accounts in (dissipated_by, work_by))
        numerical = 0.0 if self._static else before.numerical + before.kinetic - energy.kinetic - step.braking
        self.ledger = Ledger(
            *(energy.kinetic, energy.strain, energy.potential),
            dissipated=dissipated,
            numerical=numerical,
            work=work,
            residual=np.nan if self._static else energy.total - self._start + dissipated + numerical - work,
            ahead=before.ahead + step.ahead,
            turned_over=max(before.turned_over, energy.kinetic, energy.strain, abs(dissipated), abs(work)),
            dissipated_by=dissipated_by,
            work_by=work_by,
        )
        return self.ledger.residual - before.residual

    def state(self) -> Saved:
        return {"begun": np.array(self._start), "ledger": packed(asdict(self.ledger))}

    def restore(self, saved: Saved) -> None:
        self._start, self.ledger = float(saved["begun"]), Ledger(**unpacked(saved["ledger"]))


def _by_kind(turned: Mapping[str, Work]) -> list[tuple[str, Work]]:
    return [("supports" if name in SPRINGS else name.replace(" ", "_"), work) for name, work in turned.items()]


def _losses(name: str, work: Work) -> list[tuple[str, float]]:
    """Energy [J] that a part has dissipated, by account."""
    if name not in SPLIT:
        return [(name, work.dissipated)]
    own, of_scheme = SPLIT[name]
    return [(own, work.dissipated - work.by_scheme), (of_scheme, work.by_scheme)]


def _added(before: Mapping[str, float], more: Iterable[tuple[str, float]]) -> dict[str, float]:
    """Sums by name; KeyError for a part that turns energy over and has no account."""
    after = dict(before)
    for name, value in more:
        if name in after or value != 0.0:
            after[name] += value
    return after
