"""Table of outputs of every accepted step: Newton iterations, step size, energy balance."""

from __future__ import annotations

from typing import TYPE_CHECKING

from riser_soil.core.output import OutputQuantity

if TYPE_CHECKING:
    from riser_soil.core.snapshot import StepRecord

_FROM_NOWHERE = "positive when energy appears from nowhere"
REMOVED = "negative where it was removed"

OF_STEP: tuple[OutputQuantity[StepRecord], ...] = (
    OutputQuantity(
        "newton_iterations", "", "1", "Newton iterations", "step", get=lambda s: s.health.newton_iterations, dtype="i4"
    ),
    OutputQuantity(
        "time_step", "Δt", "s", "time step; in static stages the increment of the load factor", "step",
        get=lambda s: s.health.time_step,
    ),
    OutputQuantity(
        "energy_residual", "", "J", "residual of the step's energy balance; nan in static stages", "step",
        _FROM_NOWHERE, get=lambda s: s.health.energy_residual,
    ),
    OutputQuantity(
        "relative_energy_residual", "", "1",
        "residual of the energy balance since the stage began, over the energy exchanged; nan in static stages",
        "step", _FROM_NOWHERE, get=lambda s: s.ledger.relative_residual,
    ),
    OutputQuantity(
        "kinetic_energy", "", "J", "kinetic energy, added mass included", "step", get=lambda s: s.ledger.kinetic
    ),
    OutputQuantity("strain_energy", "", "J", "elastic energy", "step", get=lambda s: s.ledger.strain),
    OutputQuantity(
        "potential_energy", "", "J", "energy of weight, buoyancy and contact; its zero is anywhere", "step",
        get=lambda s: s.ledger.potential,
    ),
    OutputQuantity(
        "dissipated", "", "J", "energy dissipated since the stage began, but for the time scheme's", "step",
        get=lambda s: s.ledger.dissipated,
    ),
    OutputQuantity(
        "dissipated_time_scheme", "", "J", "energy removed by the time scheme since the stage began", "step",
        "negative where it added energy", get=lambda s: s.ledger.numerical,
    ),
    OutputQuantity("work", "", "J", "energy added since the stage began", "step", REMOVED, get=lambda s: s.ledger.work),
    OutputQuantity(
        "step_cuts", "", "1", "failed attempts before the step was accepted", "step", get=lambda s: s.health.step_cuts,
        dtype="i4",
    ),
)  # fmt: skip
