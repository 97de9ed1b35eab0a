"""netCDF-4 time series of a run, results.nc; readable at any moment, also after a kill.

The file is laid out once. Rows are gathered in memory; `flush` appends them in one update, so that the file on disk is
whole at every moment.
"""

from __future__ import annotations

import io
from collections import defaultdict
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.core.output import OutputQuantity
from riser_soil.core.saved_state import Saved, packed, unpacked
from riser_soil.core.snapshot import Ledger, Record, Records, StepRecord
from riser_soil.core.step_outputs import OF_STEP, REMOVED
from riser_soil.results.growing_file import GrowingFile, append_rows, appending, behind, cutting_back
from riser_soil.results.netcdf_layout import Variable, lay_out, values_in

_SPOKEN = {  # parts whose names don't say what dissipates or works
    "contents": "contents that flow or are uneven",
    "morison": "drag and other forces of the water's motion",
    "vortices": "force of shed vortices across the flow",
    "vortices_in_line": "force of shed vortices in line with the flow",
    "buoyancy": "buoyancy in waves",
    "contact": "contact of the riser with the soil",
    "soil_plasticity": "plastic flow of the soil",
    "soil_time_scheme": "the time scheme, which takes the soil's stress at the end of a step for all of it",
    "new_mesh": "transfer of stress to new meshes of the soil",
    "supports": "moving ends",
}
_DIMS = {
    "nodes": ("time", "arc"),
    "sections": ("time", "section"),
    "across": ("time", "section", "offset"),
    "model": ("time",),
    "step": ("step",),
}
_OFFSET = Variable(("offset",), "m", "horizontal distance from the riser's axis", "positive along section_direction")
_ARC = Variable(("arc",), "m", "unstressed arc length from the start")
_COMPONENT = Variable(("component",), "", "global axis", dtype=h5py.string_dtype())


def variable(output: OutputQuantity[Any]) -> Variable:
    """The variable of results.nc for an output, along the riser, by instants or by steps."""
    along = _DIMS[output.where]
    dims = (*along, "component") if output.vector else along
    return Variable(dims, output.units, output.text, output.sign, output.dtype)


SERIES: dict[str, Variable] = {
    "time": Variable(("time",), "s", "total simulated time; static stages take none, quasi-static ones their t"),
    "stage": Variable(("time",), "1", "index of the stage", dtype="i4"),
    **{output.name: variable(output) for output in outputs.of_instant() if output.where != "summary"},
}
HEALTH: dict[str, Variable] = {
    "step": Variable(("step",), "1", "index of the accepted step", dtype="i8"),
    "step_time": Variable(("step",), "s", "total simulated time at the end of the step"),
    "step_stage": Variable(("step",), "1", "index of the stage", dtype="i4"),
    **{output.name: variable(output) for output in OF_STEP},
}


def ledger_variables(dissipating: Collection[str], working: Collection[str]) -> dict[str, Variable]:
    """Variables of each step by part, beside HEALTH: the terms of `dissipated` and of `work`."""
    lost = "energy dissipated since the stage began by: "
    added = "energy added since the stage began by: "
    return {
        **{f"dissipated_{name}": Variable(("step",), "J", lost + _spoken(name)) for name in dissipating},
        **{f"work_{name}": Variable(("step",), "J", added + _spoken(name), REMOVED) for name in working},
    }


def _spoken(name: str) -> str:
    return _SPOKEN.get(name, name.replace("_", " "))


def group(line: str) -> str:
    """Path of a line's group, "" of the only line's, which has none."""
    return f"{line}/" if line else ""


def _in_group(variable: Variable, path: str) -> Variable:
    """The variable along a line, with that line's own arc lengths."""
    return replace(variable, dims=tuple(f"{path}arc" if dim == "arc" else dim for dim in variable.dims))


class SeriesFile:
    """Writer of results.nc.

    arcs: (nn,) m, arc lengths of the nodes of each line, by its name; "" of the only one. Several lines have a group
    each, and `more` are variables of other groups, by their paths. unrecorded: names of SERIES that are not wanted, by
    line. ledger: of `ledger_variables`. sections: number of those across the riser, offsets (m,) [m] in them. goes_on:
    with the file of an earlier run, up to what is restored.
    Rows given to `record` and `step` live in memory until `flush`.
    """

    def __init__(
        self,
        path: Path,
        arcs: Mapping[str, Array],
        title: str,
        version: str,
        unrecorded: Mapping[str, Collection[str]] | None = None,
        ledger: Mapping[str, Variable] | None = None,
        sections: int = 0,
        offsets: Sequence[float] = (),
        goes_on: bool = False,
        more: Mapping[str, Variable] | None = None,
    ) -> None:
        self._of_step = HEALTH | dict(ledger or {})
        variables = {name: v for name, v in SERIES.items() if sections or "section" not in v.dims}
        shared = {name: variables[name] for name in ("time", "stage")}
        along = {
            f"{group(line)}{name}": _in_group(v, group(line))
            for line in arcs
            for name, v in variables.items()
            if name not in shared and name not in (unrecorded or {}).get(line, ())
        }
        of_instant = shared | along | dict(more or {})
        self._variables = of_instant | self._of_step
        self._of_instant = [name for name in of_instant if name != "stage"]
        sizes = {f"{group(name)}arc": arc.size for name, arc in arcs.items()}
        sizes |= {"component": 3, "section": sections, "offset": len(offsets)}
        self._sizes = {"time": None, "step": None} | {name: size for name, size in sizes.items() if size}
        self._offsets = np.array(offsets)
        self.row_size = sum(8 * values_in(self._variables[name], self._sizes) for name in self._of_instant)  # bytes
        self._rows: defaultdict[str, list[Any]] = defaultdict(list)  # arrays of rows, to be joined
        self._records = self._steps = 0
        self._stages: list[str] = []
        self._goes_on = goes_on
        self._file = GrowingFile(path, None if goes_on else self._layout(arcs, title, version))

    def begin_stage(self, name: str) -> None:
        self._stages.append(name)

    def record(self, rows: Mapping[str, Array]) -> None:
        """Adds output times, in the first axis of all rows, which nobody changes any more.

        rows: by the names of SERIES except `stage`; those left out are ignored.
        """
        count = len(rows["time"])
        self._records += count
        for name in self._of_instant:
            self._rows[name].append(rows[name])
        self._rows["stage"].append([len(self._stages) - 1] * count)

    def steps(self, rows: Mapping[str, Sequence[float]]) -> None:
        """Adds accepted steps. rows: by the names of HEALTH and the ledger, without `step` and `step_stage`."""
        count = len(rows["step_time"])
        own = {"step": range(self._steps, self._steps + count), "step_stage": [len(self._stages) - 1] * count}
        self._steps += count
        for name in self._of_step:
            self._rows[name].append(own[name] if name in own else rows[name])

    def flush(self, finished: bool = False) -> None:
        """Appends the gathered rows to the file."""
        with appending(self._file) as file:
            for name, rows in self._rows.items():
                append_rows(file[name], np.concatenate(rows))
            file.attrs["finished"] = np.int8(finished)
            _name_stages(file, self._stages)
        self._rows.clear()

    def close(self) -> None:
        self._file.close()

    def outlast_power(self) -> None:
        """Write through to the disk from now on, so that the file outlasts a power cut."""
        self._file.outlast_power()

    def _layout(self, arcs: Mapping[str, Array], title: str, version: str) -> bytes:
        content = io.BytesIO()
        along = {f"{group(name)}arc": _in_group(_ARC, group(name)) for name in arcs}
        fixed = along | {"component": _COMPONENT} | ({"offset": _OFFSET} if self._offsets.size else {})
        with h5py.File(content, "w", track_order=True) as file:
            file.attrs["title"] = title
            file.attrs["version"] = version
            file.attrs["source"] = f"riser_soil {version}"
            file.attrs["Conventions"] = "CF-1.11"
            file.attrs["finished"] = np.int8(0)
            lay_out(file, self._sizes, fixed | self._variables)
            for name, arc in arcs.items():
                file[f"{group(name)}arc"][...] = arc
            file["component"][...] = ["x", "y", "z"]
            if self._offsets.size:
                file["offset"][...] = self._offsets
        return content.getvalue()

    def state(self) -> Saved:
        """Numbers of rows and names of stages so far; rows themselves are the file's."""
        counts = {"records": np.array(self._records), "steps": np.array(self._steps)}
        return counts | {"stages": packed(self._stages)}

    def restore(self, saved: Saved) -> None:
        """A file that goes on loses the rows that were written after those saved; ResultsError where it has fewer."""
        self._records, self._steps = int(saved["records"]), int(saved["steps"])
        self._stages = unpacked(saved["stages"])
        if self._goes_on:
            with cutting_back(self._file) as file:
                for name, variable in self._variables.items():
                    _cut_back(file[name], self._steps if variable.dims[0] == "step" else self._records, self._file.path)
                file.attrs["finished"] = np.int8(False)
                _name_stages(file, self._stages)


def _cut_back(dataset: h5py.Dataset, rows: int, path: Path) -> None:
    if len(dataset) < rows:
        raise behind(path)
    dataset.resize(rows, axis=0)


def _name_stages(file: h5py.File, names: list[str]) -> None:
    """CF's flags: the meaning of each stage index, blanks in names written as underscores."""
    for variable in ("stage", "step_stage"):
        file[variable].attrs["flag_values"] = np.arange(len(names), dtype="i4")
        file[variable].attrs["flag_meanings"] = " ".join(name.replace(" ", "_") for name in names)


def series_rows(stamps: Sequence[float], records: Records, fields: Mapping[str, tuple[str, ...]]) -> dict[str, Any]:
    """Rows of many instants by the names of SERIES behind those of the lines' groups, without outputs that are
    not among a line's fields.
    """
    along = {
        f"{group(line)}{name}": get(record)
        for line, record in records.items()
        for name, get in _wanted(fields[line])
    }
    return {"time": np.array(stamps)} | along


@cache
def _wanted(fields: tuple[str, ...]) -> list[tuple[str, Callable[[Record], Any]]]:
    """Names of what is recorded, and how each follows from a record."""
    recorded = (output for output in outputs.of_instant() if output.where != "summary")
    return [(output.name, output.value) for output in recorded if output.name in fields or not output.chosen]


def step_rows(steps: Sequence[StepRecord], accounts: Collection[str]) -> dict[str, list[float]]:
    """Rows of steps by the names of HEALTH and the ledger's accounts; an account that a step has not booked on is 0."""
    booked = [_booked(step.ledger) for step in steps]
    return {
        **{output.name: [output.value(step) for step in steps] for output in OF_STEP},
        **{name: [each.get(name, 0.0) for each in booked] for name in accounts},
    }


def _booked(ledger: Ledger) -> dict[str, float]:
    lost = {f"dissipated_{name}": value for name, value in ledger.dissipated_by.items()}
    return lost | {f"work_{name}": value for name, value in ledger.work_by.items()}
