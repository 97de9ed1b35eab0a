"""Largest utilisations of the limits that line types give, in a stage: bend radius, tension, stress of the wall."""

from __future__ import annotations

from collections.abc import Iterator

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, gathered, restore_all
from riser_soil.core.snapshot import Record
from riser_soil.results.largest import Largest, largest_along

_EXCEEDED = {  # each limit's warning: what exceeds it, and what it was there
    "bend radius": ("the pipe is bent beyond its min_bend_radius", "the bend radius is {:.4g} m"),
    "tension": ("the riser is pulled beyond its max_tension", "the effective tension is {:.4g} N"),
    "stress": (
        "the wall is stressed beyond design_factor times yield_stress",
        "von Mises' stress is {:.4g} Pa",
    ),
}


class LimitTally:
    """Largest utilisation so far of each limit, with the time [s], or load factor, the bend radius [m], tension [N] or
    stress [Pa] there, and the arc length [m].
    """

    def __init__(self) -> None:
        self._largest = {limit: Largest(beside=2, floor=0.0) for limit in _EXCEEDED}

    def update(self, times: Array, record: Record) -> None:
        """times (nt,), of the record's instants."""
        if "largest_bend_utilisation" in record:
            names = "largest_bend_utilisation", "tightest_radius", "largest_bend_utilisation_arc"
            self._largest["bend radius"].update(times, *(record[name][:, None] for name in names))
        for limit, used, actual in (
            ("tension", "tension_utilisation", "effective_tension"),
            ("stress", "stress_utilisation", "most_used_stress"),
        ):
            if used in record:
                self._largest[limit].update(times, *largest_along(record[used], record[actual], record.arc))

    def warnings(self, unit: str) -> Iterator[str]:
        """unit: of the time."""
        for limit, (what, meaning) in _EXCEEDED.items():
            used, t, actual, arc = self._largest[limit].of()
            if used > 1.0:
                yield (
                    f"{what}: {used:.4g} times the limit at arc {arc:.5g} m and {t:.5g} {unit}, where "
                    f"{meaning.format(actual)}"
                )

    def state(self) -> Saved:
        return gathered(self._largest)

    def restore(self, saved: Saved) -> None:
        restore_all(self._largest, saved)
