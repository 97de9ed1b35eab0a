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
from riser_soil.errors import ResultsError, RiserSoilError
from riser_soil.results import folder as run_folder
from riser_soil.results import vtkhdf
from riser_soil.results.growing_file import reading
from riser_soil.results.indicators import merged

if TYPE_CHECKING:
    import xarray as xr

    from riser_soil.scene.scene import Scene


@dataclass(frozen=True, eq=False)
class SoilFrame:
    """The soil at one instant; what was left out of the output is missing from the fields."""

    time: float  # s
    points: Array  # (nv, 3) m, undeformed
    cells: IntArray  # (nc, 4, 8 or 10), VTK's node order
    fields: dict[str, Array]  # displacement (nv, 3) m; von_mises_stress Pa, equivalent_plastic_strain (nc,)

BODIES_AND_JOINTS = ("bodies", "joints", "clearance")  # groups beside those of several lines
OF_ALL = ("lines", *BODIES_AND_JOINTS)  # keys of a stage of several lines


class Run:
    """One run's results, finished or not, in SI units.

    `run.dataset` is results.nc with names and units, `run["effective_tension"]` one of its variables as numpy array,
    first axis time (nt); `run.arc` (nn,) m; `run.summary` is summary.json. Raises ResultsError when the folder holds no
    run, or a name is not in it.
    """

    def __init__(self, folder: Path | str, line: str | None = None) -> None:
        """line: of a run of several lines, the one whose results these are, by its name. RUN/LINE in the place of a
        folder is that line's, too.
        """
        self.folder = Path(folder)
        if self.folder.is_file():
            kind = "an input file" if self.folder.suffix in (".yaml", ".yml") else "a file"
            wanted = "and the folder of a run is wanted here; riser-soil run makes it from a scene"
            raise ResultsError(f"{self.folder}: is {kind}, {wanted}")
        if line is None and not self._is_run(self.folder) and self._is_run(self.folder.parent):
            self.folder, line = self.folder.parent, self.folder.name
        if not self._is_run(self.folder):
            raise ResultsError(f"{self.folder}: is not the folder of a run: no {run_folder.SERIES}")
        self._group = f"{line}/" if line else ""
        if line and line not in self.lines:
            names = ", ".join(self.lines) or "none by name: it is a run of one riser"
            raise ResultsError(f"{self.folder}: has no line {line}; it has {names}")

    @classmethod
    def is_there(cls, place: Path) -> bool:
        """Whether a place is a run's folder, or RUN/LINE."""
        return cls._is_run(place) or (cls._is_run(place.parent) and place.name in cls(place.parent).lines)

    @staticmethod
    def _is_run(folder: Path) -> bool:
        return (folder / run_folder.SERIES).is_file()

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """Names of the lines of a run of several, sorted; none of a run of one riser."""
        with self._open(run_folder.SERIES) as file:
            return tuple(name for name in sorted(file) if isinstance(file[name], h5py.Group) and "arc" in file[name])

    @property
    def place(self) -> Path:
        """Place of these results: the folder, or RUN/LINE."""
        return self.folder / self._group

    def of_line(self, name: str) -> Run:
        """The results of one of several lines: with its variables, its figures in the summary and its scene."""
        return Run(self.folder, name)

    @property
    def of_lines(self) -> dict[str, Run]:
        """Results of each line, by name; a run of one riser itself, by ""."""
        return {"": self} if self._group or not self.lines else {name: self.of_line(name) for name in self.lines}

    def require_one_line(self, wanted: str) -> None:
        """ResultsError where this is the whole run of several lines, which has not what is wanted: its lines have."""
        if self.lines and not self._group:
            each = ", ".join(str(self.folder / line) for line in self.lines)
            raise ResultsError(f"{self.folder}: {wanted} is not of the run but of its lines: take one of {each}")

    def __getitem__(self, name: str) -> Array:
        with self._open(run_folder.SERIES) as file:
            path = self._path_of(file, name)
            if path is None:
                self.require_one_line(name)
                names = ", ".join(sorted(file[self._group or "/"]))
                raise ResultsError(f"{self.place}: results.nc has no {name}; it has {names}")
            stored = file[path]
            values: Array = (stored.asstr() if h5py.check_string_dtype(stored.dtype) else stored)[...]
        return values

    @property
    def dataset(self) -> xr.Dataset:
        """results.nc as it is now, in memory: axes `time` [s], `arc` [m], `component` (x, y, z), `step`, of which each
        variable has some; `stage_name` tells the stages, blanks as underscores; `attrs` have units and signs.
        """

        path = self.folder / run_folder.SERIES
        try:
            return load(path, self._group)
        except (OSError, ValueError) as err:
            raise ResultsError(f"{path}: cannot be read: {err}") from err

    def has(self, name: str) -> bool:
        """Whether results.nc has a variable."""
        return name in self.variables

    @cached_property
    def variables(self) -> frozenset[str]:
        """Names of what results.nc has, of one line's those of the whole run as well."""
        with self._open(run_folder.SERIES) as file:
            own = [*file[self._group]] if self._group else []
            return frozenset([*own, *(name for name in file if isinstance(file[name], h5py.Dataset))])

    @cached_property
    def bodies_and_joints(self) -> dict[str, tuple[str, bool]]:
        """Units of what is known of bodies, joints and clearances, and whether it is a vector, by its path."""
        units = dict[str, tuple[str, bool]]()
        with self._open(run_folder.SERIES) as file:
            for path in (f"{kind}/{name}" for kind in BODIES_AND_JOINTS for name in file.get(kind, ())):
                of_one = ((key, each) for key, each in file[path].items() if isinstance(each, h5py.Dataset))
                units |= {f"{path}/{key}": (str(each.attrs["units"]), each.ndim > 1) for key, each in of_one}
        return units

    def _path_of(self, file: h5py.File, name: str) -> str | None:
        """Path of a variable: the line's own, else the run's; None where there is none."""
        paths = dict.fromkeys((f"{self._group}{name}", name))
        return next((path for path in paths if isinstance(file.get(path), h5py.Dataset)), None)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The run's summary; of one of several lines, its own figures stand in the places of a single riser's."""
        whole, line = self._whole_summary, self._group[:-1]
        if not line:
            return whole
        own: dict[str, Any] = {"stages": [_stage_of_line(stage, line) for stage in whole["stages"]]}
        if bars := whole.get("error_bars"):
            own["error_bars"] = bars | {"quantities": [each for each in bars["quantities"] if each["of"] == line]}
        if hang_offs := whole.get("hang_off"):
            own["hang_off"] = hang_offs.get(line)
        return whole | own

    @cached_property
    def _whole_summary(self) -> dict[str, Any]:
        path = self.folder / run_folder.SUMMARY
        try:
            summary: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as err:
            raise ResultsError(f"{path}: cannot be read: {err}") from err
        return summary

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The resolved scene, scene.yaml, as plain data; of one of several lines with this line as its riser."""
        whole, line = self._whole_scene, self._group[:-1]
        if not line:
            return whole
        stages = [stage | (stage.get("lines") or {}).get(line, {}) | {"lines": {}} for stage in whole["stages"]]
        soil = whole["soil"] if (whole["soil"] or {}).get("line") == line else None
        alone = {"riser": whole["lines"][line], "lines": {}, "bodies": {}, "joints": {}, "dimension": 3, "soil": soil}
        return whole | alone | {"stages": stages}

    @cached_property
    def _whole_scene(self) -> dict[str, Any]:
        path = self.folder / run_folder.SCENE
        try:
            scene: dict[str, Any] = YAML(typ="safe").load(path.read_text(encoding="utf-8"))
        except (OSError, YAMLError) as err:
            raise ResultsError(f"{path}: cannot be read: {err}") from err
        return scene

    def read_scene(self) -> Scene:
        """The checked scene, of one of several lines its own; SceneError or OSError where it can't be read."""
        from riser_soil.scene.lines import by_line
        from riser_soil.scene.reader import read_scene

        scene = read_scene(str(self.folder / run_folder.SCENE))
        return by_line(scene)[self._group[:-1]] if self._group else scene

    @cached_property
    def checked_scene(self) -> Scene | None:
        """The checked scene; None where it can't be read, as when one of its files is gone."""
        try:
            return self.read_scene()
        except (RiserSoilError, OSError):
            return None

    @property
    def finished(self) -> bool:
        return self.summary["finished"] is True

    @cached_property
    def arc(self) -> Array:
        return self["arc"]

    @cached_property
    def time(self) -> Array:
        """Total simulated time (nt,) [s] of the records."""
        return self["time"]

    @cached_property
    def stage_names(self) -> list[str]:
        return [stage["name"] for stage in self.summary["stages"]]

    @property
    def has_soil(self) -> bool:
        """Whether there are frames of soil, and of several lines this one lies on it."""
        there = (self.folder / run_folder.SOIL_NUMBERS).is_file()
        return there and (not self._group or self.scene["soil"] is not None)

    @cached_property
    def soil_times(self) -> Array:
        """Times (nf,) [s] of the soil's frames."""
        if not self.has_soil:
            raise ResultsError(f"{self.place}: has no soil: no {run_folder.SOIL_NUMBERS}")
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


def _stage_of_line(stage: dict[str, Any], line: str) -> dict[str, Any]:
    """A stage of the summary with a line's figures in it; indicators of the steps are those of all lines."""
    own, shared = stage["lines"][line], stage.get("indicators", {})
    figures = {key: value for key, value in (stage | own).items() if key not in OF_ALL}
    return figures | {"indicators": merged(own.get("indicators", {}), shared)}


def load(path: Path, group: str = "") -> xr.Dataset:
    """The dataset of a file, which is free again then, and of the group of a line in it.

    Raises OSError or ValueError where it can't be read.

    HDF5 does not open the file itself: whoever else has it open, with locks or without, is no hindrance. A run that
    writes it sees the lock that is put on it meanwhile, and leaves this copy of the file as it is.
    """
    import xarray as xr

    with path.open("rb") as file:
        with suppress(OSError):  # a file system without locks
            fcntl.flock(file, fcntl.LOCK_SH)
        dataset = xr.load_dataset(file, engine="h5netcdf", decode_timedelta=False)
        if group:
            file.seek(0)
            dataset = dataset.merge(xr.load_dataset(file, group=group, engine="h5netcdf", decode_timedelta=False))
    for coordinate, of in {"stage_name": "stage", "step_stage_name": "step_stage"}.items():
        dataset = dataset.assign_coords({coordinate: (dataset[of].dims, _names(dataset[of]))})
    return dataset.set_coords(["stage", "step_stage", "step_time"])


def _names(stage: xr.DataArray) -> np.ndarray:
    """Names of the stages by their numbers, blanks as underscores."""
    meanings = np.array(str(stage.attrs.get("flag_meanings", "")).split(), dtype=str)
    return meanings[stage.values] if stage.size else np.empty(0, dtype=str)
