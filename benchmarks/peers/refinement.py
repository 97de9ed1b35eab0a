"""Which programs compute which runs: every number of elements with every time step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

ELEMENTS = {
    "catenary": (20, 30, 40, 60, 80, 120, 160),
    "tank": (20, 30, 40, 60, 80, 120, 160, 240, 320),  # a floor that acts at nodes wants many
}
STEPS = (0.2, 0.125, 0.08, 0.05)  # s, of implicit schemes; both cases last a multiple of each
FINEST = {"catenary": (320, 0.0125), "tank": (640, 0.0125)}
# Explicit: half of what an axial wave needs for an element [s]; half of that changes nothing in five digits.
WAVE_STEPS = {
    "catenary": {20: 0.002, 40: 0.001, 80: 0.0005, 160: 0.00025},
    "tank": {20: 0.004, 40: 0.002, 80: 0.001, 160: 0.0005},
}


@dataclass(frozen=True)
class Program:
    """module: of this package, whose `run` takes the options. own: whether it runs in riser_soil's environment. again:
    whether it is the program before it with other settings, and so has no voice of its own.
    """

    name: str
    module: str
    options: Mapping[str, str] = field(default_factory=dict, hash=False)
    own: bool = False
    explicit: bool = False
    again: bool = False

    @property
    def stem(self) -> str:
        """Beginning of its files' names."""
        return "_".join([self.module, *self.options.values()]).replace(" ", "_")

    def runs(self, case: str) -> Iterator[tuple[int, float]]:
        """Numbers of elements and time steps [s]; the finest run last."""
        if self.explicit:
            yield from WAVE_STEPS[case].items()
            return
        yield from ((elements, step) for elements in ELEMENTS[case] for step in STEPS)
        yield FINEST[case]


PROGRAMS = (
    Program("riser_soil, compiled", "riser", {"newton": "compiled"}, own=True),
    Program("riser_soil, SNES", "riser", {"newton": "snes"}, own=True, again=True),
    Program("riser_soil, compiled, graded", "riser", {"newton": "compiled", "mesh": "graded"}, own=True, again=True),
    Program("CableDyn", "cabledyn"),
    Program("CableDyn, tolerance 1e-4", "cabledyn", {"tolerances": "1e-4 1e-14 100 12"}, again=True),
    Program("Exudyn", "exudyn"),
    Program("MoorDyn", "moordyn", explicit=True),
)
