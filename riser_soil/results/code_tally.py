"""Largest utilisations of a stage by each code check of each line type, for the summary and its warnings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, packed, unpacked
from riser_soil.core.snapshot import CodeCheckFacts, CodeSnapshot


class CodeTally:
    """Largest utilisation so far of each check, with its arc length [m] and time [s], or load factor."""

    def __init__(self, facts: Sequence[CodeCheckFacts] = ()) -> None:
        self._facts = tuple(facts)
        self._used = np.full((3, len(self._facts)), np.nan)  # utilisation, arc, time

    def update(self, times: Array, found: CodeSnapshot | None) -> None:
        """times (nt,), of the instants found."""
        if found is None:
            return
        at = found.largest.argmax(axis=0)
        columns = np.arange(len(self._facts))
        rows = np.stack([found.largest[at, columns], found.place[at, columns], times[at]])
        more = ~(rows[0] <= self._used[0])
        self._used = np.where(more, rows, self._used)

    def as_list(self) -> list[dict[str, Any]]:
        """The summary's `code_check`; empty where nothing is checked, or before the first instant."""
        return [
            asdict(facts) | {"utilisation": used, "arc": arc, "time": t, "exceeded": used > 1.0}
            for facts, (used, arc, t) in zip(self._facts, self._used.T.tolist(), strict=True)
            if np.isfinite(used)
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
        return {"used": self._used.copy(), "facts": packed([asdict(facts) for facts in self._facts])}

    def restore(self, saved: Saved) -> None:
        self._facts = tuple(CodeCheckFacts(**facts) for facts in unpacked(saved["facts"]))
        self._used = saved["used"].copy()
