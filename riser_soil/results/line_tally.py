"""Tally of one line in a stage: all that the summary has of it alone, gathered while the stage runs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, Stateful, gathered, packed, restore_all, unpacked
from riser_soil.core.snapshot import Record, RunFacts
from riser_soil.results.code_tally import CodeTally
from riser_soil.results.figures import Extremes, final_state, pack
from riser_soil.results.indicators import FigureIndicators
from riser_soil.results.limit_tally import LimitTally
from riser_soil.results.soil_extremes import SoilExtremes


class LineTally:
    """Extremes of a line's figures, of its utilisations and of the soil under it; indicators; doubts about them.

    kind: of the stage. automatic: whether its time steps are. implausible: what is not plausible about the line's
    shape, forces and surroundings.
    """

    def __init__(self, facts: RunFacts, line: str, kind: str, automatic: bool) -> None:
        self._kind = kind
        self.extremes, self.limits, self.soil = Extremes(), LimitTally(), SoilExtremes()
        self.code = CodeTally(facts.code_checks.get(line, ()))
        self.indicators = FigureIndicators(facts.diameter, facts.weight, automatic)
        self.implausible: tuple[str, ...] = ()

    def begin(self, t: float, vector: Array) -> None:
        """Count the figures, from `pack`, that a stage along t begins with."""
        self.extremes.update(t, vector)
        self.indicators.begin(t, vector)

    def update(self, times: Array, record: Record) -> None:
        """times (nt,): s (static stages: load factor), of the record's instants."""
        rows = pack(record)
        self.extremes.update(times, rows)
        if self._kind == "dynamic":
            self.indicators.follow(times, rows)
        self.limits.update(times, record)
        self.code.update(times, record)

    def as_dict(self, stepped: bool) -> dict[str, Any]:
        """The line's share of the summary. stepped: whether the stage has had a step."""
        figures: dict[str, Any] = {
            "final": final_state(self.extremes.latest) if stepped else None,
            "extremes": self.extremes.nested() if stepped else None,
            "warnings": self.warnings,
            "indicators": self.indicators.as_dict(self._kind == "dynamic"),
        }
        parts = {"soil": self.soil.nested(), "code_check": self.code.as_list()}
        return figures | {name: part for name, part in parts.items() if part}

    @property
    def warnings(self) -> list[str]:
        """Warnings about the line's results, with numbers and a remedy."""
        return [*self.doubts(), *self.warnings_of_steps()]

    def doubts(self) -> Iterator[str]:
        """Warnings of limits and codes that are exceeded, and of what is not plausible."""
        unit = "of the load" if self._kind == "static" else "s"
        yield from self.limits.warnings(unit)
        yield from self.code.warnings(unit)
        yield from self.implausible

    def warnings_of_steps(self) -> Iterator[str]:
        """Warnings of extremes that a dynamic stage's time step leaves in doubt."""
        if self._kind == "dynamic":
            yield from self.indicators.warnings()

    def state(self) -> Saved:
        return gathered(self._owners) | {"implausible": packed(self.implausible)}

    def restore(self, saved: Saved) -> None:
        restore_all(self._owners, saved)
        self.implausible = tuple(unpacked(saved["implausible"]))

    @property
    def _owners(self) -> dict[str, Stateful]:
        followed: dict[str, Stateful] = {"extremes": self.extremes, "limits": self.limits, "code": self.code}
        return followed | {"soil": self.soil, "indicators": self.indicators}
