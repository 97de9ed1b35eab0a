"""History of the stress along the pipe at points around its wall, from what a run has recorded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.assembly.riser import elements_along
from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.results import Run
from riser_soil.results.cycles import beginning, dynamic_stage
from riser_soil.riser.sections import Surroundings
from riser_soil.riser.wall_stress import Loads, Wall, WallSections, axial_stress_at, walls_of
from riser_soil.scene.line_types import LineType
from riser_soil.scene.riser import Riser

FEWEST = 4  # records: one in each of the quarters whose damage is compared
NEEDED = ("effective_tension", "bending_moment_y", "internal_pressure", "external_pressure")
IN_SPACE = "bending_moment_z"
SURFACES = {"outer": 0, "inner": 1}


@dataclass(frozen=True, eq=False)
class StressHistory:
    """Loads on the sections of a riser's wall at the records of a stage.

    time: (nt,) s of the run. arc: (ns,) m, of the sections. loads: each (nt, ns).
    """

    time: Array
    arc: Array
    sections: WallSections
    loads: Loads

    @property
    def duration(self) -> float:
        """s."""
        return float(self.time[-1] - self.time[0])

    def at(self, section: int, angles: Array, surface: str) -> Array:
        """Stress along the pipe (nt, np) [Pa] at angles (np,) [rad] of a section's outer or inner surface."""
        wall = Wall(*(d[section] for d in self.sections.wall))
        loads = Loads(*(values[:, section, None] for values in self.loads))
        return axial_stress_at(angles, loads, wall[SURFACES[surface]], wall)


def stress_history(run: Run, stage: str | None = None, skip: float = 0.0) -> StressHistory:
    """Stress history of a dynamic stage, by default the last, without its first `skip` [s]; ResultsError where records
    are missing.
    """
    run.require_one_line("stress")
    number = dynamic_stage(run, stage)
    since = beginning(run, number) + skip
    rows = np.flatnonzero((run["stage"] == number) & (run.time >= since * (1.0 - 1e-12)))
    if rows.size < FEWEST:
        source = f"{rows.size} record(s) of stage {run.stage_names[number]} from {since:g} s on"
        raise ResultsError(f"{run.folder}: {source}; record more (output.interval), or skip less")
    sections = sections_of(run)
    T, My, p_i, p_o = (_recorded(run, name)[rows] for name in NEEDED)
    Mz = _recorded(run, IN_SPACE)[rows] if in_space(run) else np.zeros_like(My)
    loads = sections.loads(T, My, Mz, np.zeros_like(My), p_i, p_o)
    return StressHistory(run.time[rows], run.arc[sections.node], sections, loads)


def _recorded(run: Run, name: str) -> Array:
    try:
        return run[name]
    except ResultsError as err:
        fields = ", ".join((*NEEDED, IN_SPACE))
        raise ResultsError(
            f"{run.folder}: results.nc has no {name}, which the stress follows from; give a line type its wall, and "
            f"let output.fields have {fields}"
        ) from err


def in_space(run: Run) -> bool:
    """Whether moments have two components: in a plane the second is not recorded, though asked for."""
    asked = IN_SPACE in (run.scene.get("output") or {}).get("fields", (IN_SPACE,))
    return not asked or run.has(IN_SPACE)


def sections_of(run: Run) -> WallSections:
    """Sections of the walls, by the line types and segments of the run's scene."""
    types = {name: LineType.model_validate(given) for name, given in run.scene["line_types"].items()}
    walls = walls_of(elements_along(Riser.model_validate(run.scene["riser"]), types, Surroundings()))
    if not walls.node.size:
        raise ResultsError(f"{run.folder}: no line type has a wall, from whose stress fatigue follows; add one")
    return walls


def same_sections(one: StressHistory, other: StressHistory) -> bool:
    """Whether two histories are of the same sections at the same places."""
    mine, its = (np.stack([each.arc, *each.sections.wall]) for each in (one, other))
    return mine.shape == its.shape and bool(np.allclose(mine, its, rtol=1e-9, atol=0.0))
