"""Indicators of a stage's numerical error that cost no other run: time step, impact, bending of the elements.

Each is an estimate of size, calibrated in `tests/verification/test_indicators.py`; none is a bound.

- time step: `doubtful_extremes`, in the extremes of some figures, and the largest local error of a step;
- impact: what contact's force at the end of the step takes beyond what the ground does, as far as the motion loses it:
  nothing where supports or weight press slowly into the ground (`energy_ledger`). A share s of the energy of an
  impact, lost while the riser is brought to rest and thrown back, lowers the force of it by some 1 - (1 - s)^(1/4), as
  half of the loss comes before the peak and the force goes with the root of the energy;
- bending: the largest misfit of the elements, `results.bending_misfit`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.saved_state import Saved, gathered, packed, restore_all, unpacked
from riser_soil.core.snapshot import Ledger, StepRecord, StepStatistics
from riser_soil.results.doubtful_extremes import AT, JUDGED, JudgedExtremes, TimeResolution

# Local error of a step, over the diameter, from which the motion is not followed; automatic steps keep to 0.02.
LARGE_LOCAL_ERROR = 2.0
# Share of the riser's kinetic energy that one impact may lose to the time step.
LARGE_LOSS = 0.1
STEPS_OF_IMPACT = 100.0  # in a period of the riser on its contact, which cost 2 to 3 % of the force of an impact
LOSSES = ("seabed_time_scheme", "contact_time_scheme")


@dataclass
class WorstStep:
    """The largest local error [m] of a step, and its time [s]; the longest step [s]."""

    local_error: float = 0.0
    time: float = math.nan
    dt: float = 0.0

    def follow(self, t: float, health: StepStatistics) -> None:
        self.dt = max(self.dt, health.time_step)
        if health.local_error > self.local_error:
            self.local_error, self.time = health.local_error, t


@dataclass
class ImpactLoss:
    """Energy [J] that contact has lost to the time step, and its part in one impact.

    lost: of the stage. recent: of late, fading within two of a contact's periods. largest: of it, with its time [s].
    kinetic: the largest of the riser yet. before (3,): of the ledger, what contact's accounts, forces ahead of their
    mean and the scheme itself took by the last step.
    """

    lost: float = 0.0
    recent: float = 0.0
    largest: float = 0.0
    time: float = math.nan
    kinetic: float = 0.0
    before: Sequence[float] = (0.0, 0.0, 0.0)

    def follow(self, t: float, dt: float, period: float, ledger: Ledger) -> None:
        lost = self._lost_by_motion(ledger)
        fading = max(4.0 * dt, 2.0 * period if math.isfinite(period) else 0.0)
        self.recent = self.recent * math.exp(-dt / fading) + lost
        self.lost, self.kinetic = self.lost + lost, max(self.kinetic, ledger.kinetic)
        if self.recent > self.largest:
            self.largest, self.time = self.recent, t

    def _lost_by_motion(self, ledger: Ledger) -> float:
        """Energy that contacts lost in the last step [J], less the share that the time scheme put in itself by forces
        ahead of their mean.
        """
        booked = sum(ledger.dissipated_by.get(name, 0.0) for name in LOSSES)
        now = booked, ledger.ahead, ledger.numerical
        loss, ahead, numerical = (a - b for a, b in zip(now, self.before, strict=True))
        self.before = now
        put_in = min(1.0, max(0.0, -numerical / ahead)) if ahead else 0.0
        return loss * (1.0 - put_in)

    @property
    def share(self) -> float:
        """Energy that one impact lost over the largest kinetic energy, 0 to 1."""
        return min(1.0, self.largest / self.kinetic) if self.kinetic > 0.0 else 0.0

    @property
    def force_error(self) -> float:
        """Share by which the force of such an impact is too small."""
        return 1.0 - float((1.0 - self.share) ** 0.25)


@dataclass
class StageIndicators:
    """Indicators of one stage, gathered while it runs.

    diameter, weight: of the riser [m], [N]. contact_period: of the riser on its contact's stiffness [s], nan without.
    automatic: whether the time steps are. bending: the largest misfit of the elements, see `Plausibility`.
    """

    diameter: float = math.nan
    weight: float = math.nan
    contact_period: float = math.nan
    automatic: bool = False
    step: WorstStep = field(default_factory=WorstStep)
    impact: ImpactLoss = field(default_factory=ImpactLoss)
    bending: dict[str, float] = field(default_factory=dict)
    resolution: TimeResolution = field(default_factory=lambda: TimeResolution(len(AT)))
    largest: Array = field(default_factory=lambda: np.zeros(len(AT)))

    def begin(self, t: float, vector: Array) -> None:
        """The figures, from `figures.pack`, that a dynamic stage begins with."""
        self.resolution.update(t, vector[AT])

    def follow(self, times: Array, rows: Array) -> None:
        """Follow the figures of accepted steps: times (nt,) [s] of the run, rows (nt, figures)."""
        values = rows[:, AT]
        self.resolution.update(times, values)
        self.largest = np.fmax(self.largest, np.fmax.reduce(np.abs(values)))

    def follow_steps(self, times: Array, steps: Sequence[StepRecord]) -> None:
        """Follow local errors and energies of accepted steps. times (nt,): s of the run."""
        for t, step in zip(as_list(times), steps, strict=True):
            self.step.follow(t, step.health)
            self.impact.follow(t, step.health.time_step, self.contact_period, step.ledger)

    def as_dict(self, dynamic: bool) -> dict[str, Any]:
        own, shared = self.of_figures(dynamic), self.of_steps(dynamic)
        return own | shared | ({"time_step": shared["time_step"] | own["time_step"]} if dynamic else {})

    def of_figures(self, dynamic: bool) -> dict[str, Any]:
        """Those that one of several lines has of its own."""
        indicators: dict[str, Any] = {"bending": self.bending} if self.bending else {}
        if dynamic:
            errors = zip(JUDGED, self.resolution.of_least, self.resolution.of_most, strict=True)
            indicators["time_step"] = {name: {"min": float(a), "max": float(b)} for name, a, b in errors}
        return indicators

    def of_steps(self, dynamic: bool) -> dict[str, Any]:
        """Those of the whole step, which all lines share."""
        local = {"value": self.step.local_error, "time": self.step.time}
        return {"time_step": {"local_error": local}, "impact": self._impact()} if dynamic else {}

    def _impact(self) -> dict[str, float]:
        steps = self.contact_period / self.step.dt if self.step.dt else math.nan
        found = {"lost": self.impact.lost, "largest": self.impact.largest, "time": self.impact.time}
        return found | {
            "share_of_kinetic": self.impact.share,
            "force_error": self.impact.force_error,
            "steps_in_contact_period": steps,
        }

    def warnings(self) -> Iterator[str]:
        """Warnings of a dynamic stage, with numbers and a remedy."""
        yield from self.warnings_of_extremes()
        yield from self._jumps()
        yield from self._lost_impact()

    def warnings_of_extremes(self) -> Iterator[str]:
        """Those of the figures alone."""
        judged = JudgedExtremes(self.resolution, self.largest, self.diameter, self.weight)
        yield from judged.warnings(self.automatic)

    def _jumps(self) -> Iterator[str]:
        step, allowed = self.step, LARGE_LOCAL_ERROR * self.diameter
        if step.local_error > allowed:
            fine = step.dt * (allowed / step.local_error) ** (1 / 3)
            yield (
                f"the step at {step.time:.5g} s misplaces the riser by some {step.local_error:.3g} m of its own, "
                f"{step.local_error / self.diameter:.2g} diameters (limit {LARGE_LOCAL_ERROR:g}), by the change "
                f"of its accelerations: take a time_step of {fine:.2g} s or less, or auto"
            )

    def _lost_impact(self) -> Iterator[str]:
        impact = self.impact
        if impact.share > LARGE_LOSS:
            yield (
                f"at {impact.time:.5g} s impact lost {impact.largest:.3g} J to the time step and not to the ground, "
                f"{impact.share:.0%} of the {impact.kinetic:.3g} J of the motion (limit {LARGE_LOSS:.0%}): forces "
                f"of impact may be {impact.force_error:.0%} too small, and rebounds too low; {self._shorter()}"
            )

    def _shorter(self) -> str:
        if math.isnan(self.contact_period):
            return "take a smaller time_step"
        steps, fine = self.contact_period / self.step.dt, self.contact_period / STEPS_OF_IMPACT
        return (
            f"the riser bounces on its contact with a period of {self.contact_period:.3g} s, {steps:.2g} steps; "
            f"take a time_step of {fine:.2g} s, or a softer contact"
        )

    def state(self) -> Saved:
        records = {"step": asdict(self.step), "impact": asdict(self.impact), "bending": self.bending}
        plain = {name: getattr(self, name) for name in ("diameter", "weight", "contact_period", "automatic")}
        return gathered({"resolution": self.resolution}) | {"told": packed(records | plain), "largest": self.largest}

    def restore(self, saved: Saved) -> None:
        values: Mapping[str, Any] = unpacked(saved["told"])
        vars(self).update(values)
        self.largest = saved["largest"].copy()
        self.step, self.impact = WorstStep(**values["step"]), ImpactLoss(**values["impact"])
        restore_all({"resolution": self.resolution}, saved)
