"""Reader of a run's results, finished or not, from its files alone."""

from __future__ import annotations

import fcntl
import json
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError
from riser_soil.results import folder as run_folder
from riser_soil.results import vtkhdf
from riser_soil.results.growing_file import reading

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False)
class SoilFrame:
    """The soil at one instant; what was left out of the output is missing from the fields."""

    time: float  # s
    points: Array  # (nv, 3) m, undeformed
    cells: IntArray  # (nc, 4, 8 or 10), VTK's node order
    fields: dict[str, Array]  # displacement (nv, 3) m; von_mises_stress Pa, equivalent_plastic_strain (nc,)


class Run:
    """One run's results, finished or not, in SI units.

    `run.dataset` is results.nc with names and units, `run["effective_tension"]` one of its variables as numpy array,
    first axis time (nt); `run.arc` (nn,) m; `run.summary` is summary.json. Raises ResultsError when the folder holds no
    run, or a name is not in it.
    """

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        if not (self.folder / run_folder.SERIES).is_file():
            raise ResultsError(f"{self.folder}: is not the folder of a run: no {run_folder.SERIES}")

    def __getitem__(self, name: str) -> Array:
        with self._open(run_folder.SERIES) as file:
            if name not in file:
                known = ", ".join(sorted(file))
                raise ResultsError(f"{self.folder}: results.nc has no {name}; it has {known}")
            stored = file[name]
            values: Array = (stored.asstr() if h5py.check_string_dtype(stored.dtype) else stored)[...]
        return values

    @property
    def dataset(self) -> xr.Dataset:
        """results.nc as it is now, in memory: axes `time` [s], `arc` [m], `component` (x, y, z), `step`, of which each
        variable has some; `stage_name` tells the stages, blanks as underscores; `attrs` have units and signs.
        """

        path = self.folder / run_folder.SERIES
        try:
            return load(path)
        except (OSError, ValueError) as err:
            raise ResultsError(f"{path}: cannot be read: {err}") from err

    def has(self, name: str) -> bool:
        """Whether results.nc has a variable."""
        with self._open(run_folder.SERIES) as file:
            return name in file

    @cached_property
    def variables(self) -> frozenset[str]:
        """Names of what results.nc has."""
        with self._open(run_folder.SERIES) as file:
            return frozenset(file)

    @cached_property
    def summary(self) -> dict[str, Any]:
        path = self.folder / run_folder.SUMMARY
        try:
            summary: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as err:
            raise ResultsError(f"{path}: cannot be read: {err}") from err
        return summary

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The resolved scene, scene.yaml, as plain data."""
        path = self.folder / run_folder.SCENE
        try:
            scene: dict[str, Any] = YAML(typ="safe").load(path.read_text(encoding="utf-8"))
        except (OSError, YAMLError) as err:
            raise ResultsError(f"{path}: cannot be read: {err}") from err
        return scene

    @property
    def finished(self) -> bool:
        return self.summary["finished"] is True

    @cached_property
    def arc(self) -> Array:
        return self["arc"]

    @cached_property
    def time(self) -> Array:
        """(nt,) s, total simulated time."""
        return self["time"]

    @cached_property
    def stage_names(self) -> list[str]:
        return [stage["name"] for stage in self.summary["stages"]]

    @property
    def has_soil(self) -> bool:
        return (self.folder / run_folder.SOIL_NUMBERS).is_file()

    @cached_property
    def soil_times(self) -> Array:
        """(nf,) s, times of the soil's frames."""
        if not self.has_soil:
            raise ResultsError(f"{self.folder}: has no soil: no {run_folder.SOIL_NUMBERS}")
        with self._open(run_folder.SOIL_NUMBERS) as store:
            return vtkhdf.times(store)

    def soil_frame(self, index: int = -1) -> SoilFrame:
        """One frame of the soil, by default the last."""
        if not self.soil_times.size:
            raise ResultsError(f"{self.folder}: {run_folder.SOIL_NUMBERS} holds no frame yet")
        number = range(self.soil_times.size)[index]
        with self._open(run_folder.SOIL_NUMBERS) as store:
            return SoilFrame(float(self.soil_times[number]), *vtkhdf.mesh(store), vtkhdf.values_at(store, number))

    def _open(self, name: str) -> h5py.File:
        path = self.folder / name
        try:
            return reading(path)
        except OSError as err:
            raise ResultsError(f"{path}: cannot be read: {err}") from err


def load(path: Path) -> xr.Dataset:
    """All that is in the file, which is free again then. Raises OSError or ValueError where it can't be read.

    HDF5 does not open the file itself: whoever else has it open, with locks or without, is no hindrance. A run that
    writes it sees the lock that is put on it meanwhile, and leaves this copy of the file as it is.
    """
    import xarray as xr

    with path.open("rb") as file:
        with suppress(OSError):  # a file system without locks
            fcntl.flock(file, fcntl.LOCK_SH)
        found = xr.load_dataset(file, engine="h5netcdf", decode_timedelta=False)
    for coordinate, of in {"stage_name": "stage", "step_stage_name": "step_stage"}.items():
        found = found.assign_coords({coordinate: (found[of].dims, _names(found[of]))})
    return found.set_coords(["stage", "step_stage", "step_time"])


def _names(stage: xr.DataArray) -> np.ndarray:
    """Of the stages by their numbers, blanks as underscores."""
    known = np.array(str(stage.attrs.get("flag_meanings", "")).split(), dtype=str)
    return known[stage.values] if stage.size else np.empty(0, dtype=str)
