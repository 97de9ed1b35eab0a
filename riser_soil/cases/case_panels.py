"""What the plot of cases shows: the headline quantities of the last stage, case by case."""

from __future__ import annotations

from riser_soil.cases.case_tables import CaseTable
from riser_soil.plots.load_cases import Panel


def panels(table: CaseTable) -> list[Panel]:
    """One for each headline quantity of the stage that the last one told of belongs to."""
    names = [case.name for case in table.cases]
    stage = next((value.stage for value in reversed(table.quantities.values())), "")
    shown = {key: v for key, v in table.quantities.items() if v.stage == stage and not v.name.endswith(("mean", "deviation"))}
    return [Panel(names, key, value.unit, table.column(key)) for key, value in shown.items()]
