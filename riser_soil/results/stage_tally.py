"""Tally of one stage: all that the summary has of it, gathered while it runs: steps, energy, and line by line."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from riser_soil.core.saved_state import Saved, Stateful, gathered, packed, restore_all, unpacked
from riser_soil.core.snapshot import Ledger, RunFacts, StepRecord
from riser_soil.results.bodies_and_joints_figures import BodiesAndJointsExtremes
from riser_soil.results.indicators import StepIndicators, merged
from riser_soil.results.largest import Largest
from riser_soil.results.line_tally import LineTally

DOUBTFUL = 0.01  # share of the energy turned over above which what is wrong in its balance is a warning
_COUNTS = (
    *("time", "steps", "newton_iterations", "most_newton_iterations", "step_cuts"),
    *("relaxations", "settlings", "branch_switches"),
)


def energy_warnings(ledger: Ledger, worst: float, t: float) -> Iterator[str]:
    """worst: largest residual on the way [J], at time t [s]."""
    allowed = DOUBTFUL * ledger.turned_over
    if abs(worst) > allowed:
        yield (
            f"the energy balance is {worst:.3g} J off at {t:.5g} s, {abs(worst) / ledger.turned_over:.2%} of the "
            f"{ledger.turned_over:.3g} J exchanged, and {ledger.residual:.3g} J at the end: take a smaller time_step"
        )
    if abs(ledger.made) > allowed:
        done, own = ("removed" if ledger.made > 0.0 else "added"), abs(ledger.made)
        yield (
            f"the time scheme {done} {own:.3g} J, {own / ledger.turned_over:.2%} of the {ledger.turned_over:.3g} J "
            "exchanged: take a smaller time_step"
        )
    lost = ledger.dissipated_by.get("new_mesh", 0.0)
    if abs(lost) > allowed:
        yield (
            f"new meshes of the soil took {lost:.3g} J, {abs(lost) / ledger.turned_over:.2%} of the "
            f"{ledger.turned_over:.3g} J exchanged, as stress was transferred: take smaller cells under the riser"
        )
    given = -sum(ledger.dissipated_by.get(name, 0.0) for name in ("contact", "contact_time_scheme"))
    if given > allowed:
        yield (
            f"contact with the soil gave {given:.3g} J, {given / ledger.turned_over:.2%} of the "
            f"{ledger.turned_over:.3g} J exchanged: the pipe sank through the soil's surface, past its axis, or a "
            "step threw the soil aside; take contact.stiffness auto, and a time_step in which the pipe falls by less "
            "than its radius"
        )


class StageTally:
    """Statistics of one stage, energy, bodies and joints, and a tally of each line by its name, "" of the only one.

    time: s simulated in it (static: 0). settlings: how often clay that did not bear the riser let it settle.
    branch_switches: how often relaxation left an unstable equilibrium. bodies_and_joints: figures of bodies, joints and
    clearances. implausible: what is not plausible about them.
    """

    def __init__(
        self, facts: RunFacts, name: str, kind: str, lines: Sequence[str] = ("",), automatic: bool = False
    ) -> None:
        """kind: `static`, `quasi-static` or `dynamic`. automatic: whether its time steps are."""
        self.name, self.kind, self.automatic = name, kind, automatic
        self.time = 0.0
        self.steps = self.newton_iterations = self.most_newton_iterations = self.step_cuts = 0
        self.relaxations = self.settlings = self.branch_switches = 0
        self.energy, self._residual = Ledger(), Largest(beside=1, floor=0.0)
        self.indicators = StepIndicators(facts.diameter, facts.contact_period)
        self.lines = {line: LineTally(facts, line, kind, automatic) for line in lines}
        self.bodies_and_joints = BodiesAndJointsExtremes()
        self.implausible: tuple[str, ...] = ()

    def count(self, times: Sequence[float], steps: Sequence[StepRecord]) -> None:
        """Count accepted steps in turn. times: of the run at their ends [s]."""
        health = [step.health for step in steps]
        iterations = [each.newton_iterations for each in health]
        self.steps += len(steps)
        self.newton_iterations += sum(iterations)
        self.most_newton_iterations = max(self.most_newton_iterations, *iterations)
        self.step_cuts += sum(each.step_cuts for each in health)
        self.energy = steps[-1].ledger
        at, residual = np.array(times), np.array([[step.ledger.residual] for step in steps])
        self._residual.update(at, np.abs(residual), residual)
        if self.kind == "dynamic":
            self.indicators.follow(at, steps)

    @property
    def method(self) -> str | None:
        """Method by which the equilibria of a stage without inertia were computed; None with inertia."""
        if self.kind == "dynamic":
            return None
        if self.relaxations:
            return "relaxation"
        if self.settlings:
            return "settling"
        return "load steps" if self.step_cuts else "newton"

    def as_dict(self) -> dict[str, Any]:
        own = {name: tally.as_dict(self.steps > 0) for name, tally in self.lines.items()}
        whole = {"name": self.name, "kind": self.kind} | {count: getattr(self, count) for count in _COUNTS}
        whole |= {"final": None, "method": self.method, "extremes": None, "energy": self._energy}
        whole |= {"warnings": self.warnings, "indicators": self.indicators.as_dict() if self.kind == "dynamic" else {}}
        if "" not in own:
            return whole | {"lines": own} | self.bodies_and_joints.nested
        only = own[""] | {"warnings": self.warnings}
        return whole | only | {"indicators": merged(only["indicators"], whole["indicators"])}

    @property
    def _worst_residual(self) -> tuple[float, float]:
        """The residual of the energy balance [J] that was the largest by its size, and its time [s]."""
        size, time, residual = self._residual.of()
        return (residual if size else 0.0), time

    @property
    def _energy(self) -> dict[str, Any]:
        worst, t = self._worst_residual
        worst_residual = {"value": worst if self.kind == "dynamic" else math.nan, "time": t}
        sums = {"made": self.energy.made, "relative_residual": self.energy.relative_residual}
        return asdict(self.energy) | sums | {"worst_residual": worst_residual}

    @property
    def warnings(self) -> list[str]:
        """Warnings about the stage's results, with numbers and a remedy."""
        only = self.lines.get("")
        of_lines = [f"{name}: {warning}" for name, own in self.lines.items() if name for warning in own.warnings]
        warnings = [*of_lines, *(only.doubts() if only else ()), *self.implausible]
        if self.kind == "dynamic":
            warnings += energy_warnings(self.energy, *self._worst_residual)
            warnings += [*(only.warnings_of_steps() if only else ()), *self.indicators.warnings()]
        return warnings

    def state(self) -> Saved:
        counts = {name: getattr(self, name) for name in _COUNTS}
        values = {"counts": counts, "energy": asdict(self.energy), "implausible": self.implausible}
        return gathered(self._owners) | {"values": packed(values)}

    def restore(self, saved: Saved) -> None:
        restore_all(self._owners, saved)
        values = unpacked(saved["values"])
        vars(self).update(values["counts"])
        self.energy, self.implausible = Ledger(**values["energy"]), tuple(values["implausible"])

    @property
    def _owners(self) -> dict[str, Stateful]:
        owners: dict[str, Stateful] = {"residual": self._residual, "indicators": self.indicators}
        owners["hung"] = self.bodies_and_joints  # the name in checkpoints
        return owners | {f"line/{name}" if name else "line": tally for name, tally in self.lines.items()}
