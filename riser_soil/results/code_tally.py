"""Largest utilisations of a stage by each code check of each line type, for the summary and its warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved
from riser_soil.core.snapshot import CodeCheckFacts, Record
from riser_soil.results.largest import Largest


class CodeTally:
    """Largest utilisation so far of each check, with its arc length [m] and time [s], or load factor."""

    def __init__(self, facts: Sequence[CodeCheckFacts] = ()) -> None:
        self._facts = tuple(facts)
        self._largest = Largest(len(self._facts), beside=1)

    def update(self, times: Array, record: Record) -> None:
        """times (nt,), of the record's instants."""
        if "code_largest" in record:
            self._largest.update(times, record.code_largest, record.code_place)

    def as_list(self) -> list[dict[str, Any]]:
        """The summary's `code_check`; empty where nothing is checked, or before the first instant."""
        largest = [self._largest.of(n) for n in range(len(self._facts))]
        return [
            asdict(facts) | {"utilisation": used, "arc": arc, "time": t, "exceeded": used > 1.0}
            for facts, (used, t, arc) in zip(self._facts, largest, strict=True)
            if math.isfinite(used)
        ]

    def warnings(self, unit: str) -> Iterator[str]:
        """unit: of the time."""
        for each in self.as_list():
            if each["exceeded"]:
                yield (
                    f"{each['code']} is not met: {each['check']} of {each['line_type']} reaches "
                    f"{each['utilisation']:.4g} times the limit at arc {each['arc']:.5g} m and "
                    f"{each['time']:.5g} {unit}"
                )

    def state(self) -> Saved:
        return self._largest.state()

    def restore(self, saved: Saved) -> None:
        self._largest.restore(saved)
