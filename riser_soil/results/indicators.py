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
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.saved_state import Saved, Stateful, gathered, packed, restore_all, unpacked
from riser_soil.core.snapshot import Ledger, StepRecord
from riser_soil.results.doubtful_extremes import AT, JUDGED, JudgedExtremes
from riser_soil.results.largest import Largest
from riser_soil.results.time_resolution import TimeResolution

# Local error of a step, over the diameter, from which the motion is not followed; automatic steps keep to 0.02.
LARGE_LOCAL_ERROR = 2.0
# Share of the riser's kinetic energy that one impact may lose to the time step.
LARGE_LOSS = 0.1
STEPS_OF_IMPACT = 100.0  # in a period of the riser on its contact, which cost 2 to 3 % of the force of an impact
LOSSES = ("seabed_time_scheme", "contact_time_scheme")


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


class StepIndicators:
    """Indicators of a dynamic stage's steps, which all lines share: their largest local error, and losses by impact.

    diameter: of the riser [m]. contact_period: of the riser on its contact's stiffness [s], nan without.
    """

    def __init__(self, diameter: float = math.nan, contact_period: float = math.nan) -> None:
        self._diameter, self._contact_period = diameter, contact_period
        self._local_error, self._time_step = Largest(floor=0.0), Largest(floor=0.0)
        self._impact = ImpactLoss()

    def follow(self, times: Array, steps: Sequence[StepRecord]) -> None:
        """Follow local errors and energies of accepted steps. times (nt,): s of the run."""
        self._local_error.update(times, np.array([[step.health.local_error] for step in steps]))
        self._time_step.update(times, np.array([[step.health.time_step] for step in steps]))
        for t, step in zip(as_list(times), steps, strict=True):
            self._impact.follow(t, step.health.time_step, self._contact_period, step.ledger)

    def as_dict(self) -> dict[str, Any]:
        error, time = self._local_error.of()
        return {"time_step": {"local_error": {"value": error, "time": time}}, "impact": self._impact_as_dict()}

    def _impact_as_dict(self) -> dict[str, float]:
        (dt, _), impact = self._time_step.of(), self._impact
        return {
            "lost": impact.lost,
            "largest": impact.largest,
            "time": impact.time,
            "share_of_kinetic": impact.share,
            "force_error": impact.force_error,
            "steps_in_contact_period": self._contact_period / dt if dt else math.nan,
        }

    def warnings(self) -> Iterator[str]:
        """Warnings of a dynamic stage, with numbers and a remedy."""
        yield from self._misplaced()
        yield from self._lost_in_impact()

    def _misplaced(self) -> Iterator[str]:
        (error, time), (dt, _) = self._local_error.of(), self._time_step.of()
        allowed = LARGE_LOCAL_ERROR * self._diameter
        if error > allowed:
            fine = dt * (allowed / error) ** (1 / 3)
            yield (
                f"the step at {time:.5g} s misplaces the riser by some {error:.3g} m of its own, "
                f"{error / self._diameter:.2g} diameters (limit {LARGE_LOCAL_ERROR:g}), by the change "
                f"of its accelerations: take a time_step of {fine:.2g} s or less, or auto"
            )

    def _lost_in_impact(self) -> Iterator[str]:
        impact = self._impact
        if impact.share > LARGE_LOSS:
            yield (
                f"at {impact.time:.5g} s impact lost {impact.largest:.3g} J to the time step and not to the ground, "
                f"{impact.share:.0%} of the {impact.kinetic:.3g} J of the motion (limit {LARGE_LOSS:.0%}): forces "
                f"of impact may be {impact.force_error:.0%} too small, and rebounds too low; {self._shorter()}"
            )

    def _shorter(self) -> str:
        if math.isnan(self._contact_period):
            return "take a smaller time_step"
        steps, fine = self._contact_period / self._time_step.of()[0], self._contact_period / STEPS_OF_IMPACT
        return (
            f"the riser bounces on its contact with a period of {self._contact_period:.3g} s, {steps:.2g} steps; "
            f"take a time_step of {fine:.2g} s, or a softer contact"
        )

    def state(self) -> Saved:
        return gathered(self._largest) | {"impact": packed(asdict(self._impact))}

    def restore(self, saved: Saved) -> None:
        restore_all(self._largest, saved)
        self._impact = ImpactLoss(**unpacked(saved["impact"]))

    @property
    def _largest(self) -> dict[str, Stateful]:
        return {"local error": self._local_error, "time step": self._time_step}


class FigureIndicators:
    """Indicators of one line's figures in a stage: the time step's error in their extremes, the bending of elements.

    diameter, weight: of the riser [m], [N]. automatic: whether the time steps are. bending: the largest misfit of the
    elements, see `Plausibility`.
    """

    def __init__(self, diameter: float = math.nan, weight: float = math.nan, automatic: bool = False) -> None:
        self._diameter, self._weight, self._automatic = diameter, weight, automatic
        self._resolution, self._largest = TimeResolution(len(AT)), np.zeros(len(AT))
        self.bending: dict[str, float] = {}

    def begin(self, t: float, vector: Array) -> None:
        """The figures, from `figures.pack`, that a dynamic stage begins with."""
        self._resolution.update(t, vector[AT])

    def follow(self, times: Array, rows: Array) -> None:
        """Follow the figures of accepted steps: times (nt,) [s] of the run, rows (nt, figures)."""
        values = rows[:, AT]
        self._resolution.update(times, values)
        self._largest = np.fmax(self._largest, np.fmax.reduce(np.abs(values)))

    def as_dict(self, dynamic: bool) -> dict[str, Any]:
        indicators: dict[str, Any] = {"bending": self.bending} if self.bending else {}
        if dynamic:
            errors = zip(JUDGED, self._resolution.of_least, self._resolution.of_most, strict=True)
            indicators["time_step"] = {name: {"min": float(a), "max": float(b)} for name, a, b in errors}
        return indicators

    def warnings(self) -> Iterator[str]:
        """Warnings of a dynamic stage, with numbers and a remedy."""
        judged = JudgedExtremes(self._resolution, self._largest, self._diameter, self._weight)
        yield from judged.warnings(self._automatic)

    def state(self) -> Saved:
        values = {"bending": packed(self.bending), "largest": self._largest.copy()}
        return gathered({"resolution": self._resolution}) | values

    def restore(self, saved: Saved) -> None:
        restore_all({"resolution": self._resolution}, saved)
        self.bending, self._largest = unpacked(saved["bending"]), saved["largest"].copy()


def merged(of_figures: Mapping[str, Any], of_steps: Mapping[str, Any]) -> dict[str, Any]:
    """Indicators of a line's figures and those of the steps, of all lines, as summary.json has them."""
    merged = {**of_figures, **of_steps}
    if "time_step" in of_steps:
        merged["time_step"] = of_steps["time_step"] | of_figures["time_step"]
    return merged
