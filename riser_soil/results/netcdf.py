"""results.nc: time series of one run (netCDF-4), readable at any moment, also after a kill.

The file is laid out once by h5netcdf. Rows are gathered in memory; `flush` appends them in one update, so that the
file on disk is whole at every moment.
"""

from __future__ import annotations

import io
from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

import h5netcdf
import h5py
import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved, packed, unpacked
from riser_soil.results.growing_file import GrowingFile, appending

_ON_RISER = "exerted by the support on the riser; global axes, z up"
_FROM_NOWHERE = "positive when energy appears from nowhere"
_TAKEN_OUT = "negative where it was taken out"
_SPOKEN = {  # parts whose names don't tell what dissipates or works
    "morison": "drag and other forces of the water's motion",
    "buoyancy": "buoyancy in waves",
    "contact": "contact of the riser with the soil",
    "supports": "moving ends",
}
_RIGHT_HAND = "right-hand rule; " + _ON_RISER


@dataclass(frozen=True)
class Variable:
    """One variable of results.nc; `sign` says what its sign means, where it has one."""

    dims: tuple[str, ...]
    units: str
    long_name: str
    sign: str = ""
    dtype: str = "f8"


_ARC = Variable(("arc",), "m", "unstressed arc length from the start")
SERIES: dict[str, Variable] = {
    "time": Variable(("time",), "s", "total simulated time; static stages take none"),
    "stage": Variable(("time",), "1", "index of the stage", dtype="i4"),
    "position": Variable(
        ("time", "arc", "component"), "m", "position of the riser's axis", "global axes, z up"
    ),
    "effective_tension": Variable(("time", "arc"), "N", "effective tension", "positive in tension"),
    "wall_tension": Variable(
        ("time", "arc"), "N", "tension in the pipe's wall, T + p_i A_i - p_o A_o", "positive in tension"
    ),
    "bending_moment": Variable(("time", "arc"), "N m", "magnitude of the bending moment"),
    "curvature": Variable(("time", "arc"), "m-1", "magnitude of the curvature"),
    "bend_utilisation": Variable(
        ("time", "arc"), "1", "curvature times the smallest bend radius allowed", "above 1 the pipe is bent too much"
    ),
    "contact_force": Variable(
        ("time", "arc"), "N m-1", "contact force per length of riser", "positive where the ground pushes"
    ),
    "penetration": Variable(
        ("time", "arc"), "m", "penetration of the riser's underside into the ground as it is at the time", ">= 0"
    ),
    "embedment": Variable(
        ("time", "arc"),
        "m",
        "greatest depth yet of the riser's underside below the ground as it lay before the riser came",
        ">= 0",
    ),
    "slip": Variable(("time", "arc"), "m", "length of the way that the riser has slid over the seabed so far", ">= 0"),
    "moment_vector": Variable(
        ("time", "arc", "component"),
        "N m",
        "section moment",
        "right-hand rule, global axes; exerted by the part towards the end on the part towards the start",
    ),
    "start_force": Variable(("time", "component"), "N", "force at the start", _ON_RISER),
    "end_force": Variable(("time", "component"), "N", "force at the end", _ON_RISER),
    "start_moment": Variable(("time", "component"), "N m", "moment at the start", _RIGHT_HAND),
    "end_moment": Variable(("time", "component"), "N m", "moment at the end", _RIGHT_HAND),
    "touchdown_arc": Variable(
        ("time",),
        "m",
        "arc length of the touchdown point towards the end: where a rigid contact with the resultant and moment of the "
        "contact forces would end; nan when nothing touches",
    ),
    "touchdown_position": Variable(
        ("time", "component"), "m", "position of the riser's axis at the touchdown point", "global axes, z up"
    ),
    "touchdown_points": Variable(
        ("time",), "1", "places where the riser comes down or leaves the seabed, without its ends", dtype="i4"
    ),
    "min_effective_tension": Variable(
        ("time",), "N", "least effective tension along the riser", "negative in compression"
    ),
    "min_effective_tension_arc": Variable(("time",), "m", "arc length of the least effective tension"),
    "min_bend_radius": Variable(("time",), "m", "smallest bend radius, one over the largest curvature of the nodes"),
    "min_bend_radius_arc": Variable(("time",), "m", "arc length of the smallest bend radius"),
    "max_penetration": Variable(("time",), "m", "deepest penetration of the riser into the seabed", ">= 0"),
    "contact_force_sum": Variable(
        ("time", "component"),
        "N",
        "sum of the contact forces",
        "exerted by the seabed on the riser; global axes, z up",
    ),
}
HEALTH: dict[str, Variable] = {
    "step": Variable(("step",), "1", "index of the accepted step", dtype="i8"),
    "step_time": Variable(("step",), "s", "total simulated time at the end of the step"),
    "step_stage": Variable(("step",), "1", "index of the stage", dtype="i4"),
    "newton_iterations": Variable(("step",), "1", "Newton iterations", dtype="i4"),
    "time_step": Variable(("step",), "s", "time step; in static stages the increment of the load factor"),
    "energy_residual": Variable(
        ("step",), "J", "residual of the step's energy balance; nan in static stages", _FROM_NOWHERE
    ),
    "relative_energy_residual": Variable(
        ("step",),
        "1",
        "residual of the energy balance since the stage began, over the energy turned over; nan in static stages",
        _FROM_NOWHERE,
    ),
    "kinetic_energy": Variable(("step",), "J", "kinetic energy, added mass included"),
    "strain_energy": Variable(("step",), "J", "elastic energy"),
    "potential_energy": Variable(("step",), "J", "energy of weight, buoyancy and contact; its zero is anywhere"),
    "dissipated": Variable(("step",), "J", "energy dissipated since the stage began, but for the time scheme's"),
    "dissipated_time_scheme": Variable(
        ("step",), "J", "energy taken out by the time scheme since the stage began", "negative where it put energy in"
    ),
    "work": Variable(("step",), "J", "energy put in since the stage began", _TAKEN_OUT),
    "step_cuts": Variable(("step",), "1", "failed attempts before the step was accepted", dtype="i4"),
}


def ledger_variables(dissipating: Collection[str], working: Collection[str]) -> dict[str, Variable]:
    """Of each step, beside HEALTH: what adds up to `dissipated` and to `work`, by part."""
    lost = "energy dissipated since the stage began by: "
    put_in = "energy put in since the stage began by: "
    return {
        **{f"dissipated_{name}": Variable(("step",), "J", lost + _spoken(name)) for name in dissipating},
        **{f"work_{name}": Variable(("step",), "J", put_in + _spoken(name), _TAKEN_OUT) for name in working},
    }


def _spoken(name: str) -> str:
    return _SPOKEN.get(name, name.replace("_", " "))


_CHUNK_BYTES = 65536


class SeriesFile:
    """Writer of results.nc.

    arc: (nn,) m, arc lengths of the nodes. left_out: names of SERIES that are not wanted. ledger: of
    `ledger_variables`.
    Rows given to `record` and `step` live in memory until `flush`.
    """

    def __init__(
        self,
        path: Path,
        arc: Array,
        title: str,
        version: str,
        left_out: Collection[str] = (),
        ledger: Mapping[str, Variable] | None = None,
    ) -> None:
        self._of_step = HEALTH | dict(ledger or {})
        self._variables = {name: v for name, v in SERIES.items() if name not in left_out} | self._of_step
        self._rows: defaultdict[str, list[object]] = defaultdict(list)
        self._steps = 0
        self._stages: list[str] = []
        self._file = GrowingFile(path, self._layout(arc, title, version))

    def begin_stage(self, name: str) -> None:
        self._stages.append(name)

    def record(self, values: Mapping[str, object]) -> None:
        """Adds one output time. values: by the names of SERIES except `stage`; those left out are ignored."""
        row = dict(values, stage=len(self._stages) - 1)
        for name in self._variables.keys() & SERIES.keys():
            self._rows[name].append(_kept(row[name]))

    def step(self, values: Mapping[str, object]) -> None:
        """Adds one accepted step. values: by the names of HEALTH and the ledger, without `step` and `step_stage`."""
        row = dict(values, step=self._steps, step_stage=len(self._stages) - 1)
        self._steps += 1
        for name in self._of_step:
            self._rows[name].append(row[name])

    def flush(self, finished: bool = False) -> None:
        """Appends the gathered rows to the file."""
        with appending(self._file) as file:
            for name, rows in self._rows.items():
                _append(file[name], rows)
            file.attrs["finished"] = np.int8(finished)
            _name_stages(file, self._stages)
        self._rows.clear()

    def close(self) -> None:
        self._file.close()

    def _layout(self, arc: Array, title: str, version: str) -> bytes:
        content = io.BytesIO()
        with h5netcdf.File(content, "w") as file:
            file.dimensions = {"time": None, "step": None, "arc": arc.size, "component": 3}
            file.attrs["title"] = title
            file.attrs["version"] = version
            file.attrs["source"] = f"riser_soil {version}"
            file.attrs["Conventions"] = "CF-1.11"
            file.attrs["finished"] = np.int8(0)
            _describe(file, "arc", _ARC)[...] = arc
            component = file.create_variable("component", ("component",), h5py.string_dtype())
            component[...] = np.array(["x", "y", "z"], dtype=object)
            component.attrs["long_name"] = "global axis"
            for name, variable in self._variables.items():
                _describe(file, name, variable, arc.size)
        return content.getvalue()

    def state(self) -> Saved:
        """What tells the rows to come apart; rows themselves are the file's."""
        return {"steps": np.array(self._steps), "stages": packed(self._stages)}

    def restore(self, saved: Saved) -> None:
        self._steps, self._stages = int(saved["steps"]), unpacked(saved["stages"])


def _kept(value: object) -> object:
    """A copy of what the solver goes on with; numbers stay as they are."""
    return value.copy() if isinstance(value, np.ndarray) else value


def _describe(file: h5netcdf.File, name: str, variable: Variable, nodes: int = 0) -> h5netcdf.Variable:
    made = file.create_variable(name, variable.dims, variable.dtype, chunks=_chunks(variable, nodes))
    made.attrs["units"] = variable.units
    made.attrs["long_name"] = variable.long_name
    if variable.sign:
        made.attrs["sign_convention"] = variable.sign
    return made


def _chunks(variable: Variable, nodes: int) -> tuple[int, ...] | None:
    if variable.dims[0] not in ("time", "step"):
        return None
    row = tuple({"arc": nodes, "component": 3}[d] for d in variable.dims[1:])
    rows = _CHUNK_BYTES // (8 * max(1, int(np.prod(row))))
    return (min(1024, max(1, rows)), *row)


def _append(dataset: h5py.Dataset, rows: list[object]) -> None:
    known = dataset.shape[0]
    dataset.resize(known + len(rows), axis=0)
    dataset[known:] = np.asarray(rows)


def _name_stages(file: h5py.File, names: list[str]) -> None:
    """CF's flags: the meaning of each stage index, blanks in names written as underscores."""
    for variable in ("stage", "step_stage"):
        file[variable].attrs["flag_values"] = np.arange(len(names), dtype="i4")
        file[variable].attrs["flag_meanings"] = " ".join(name.replace(" ", "_") for name in names)
