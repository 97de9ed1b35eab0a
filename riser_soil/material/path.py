"""Paths of a material point: strains, or changes of stress, row by row; from a CSV file or automatic cycles of shear.

Columns eps_xx, eps_yy, eps_zz (extension positive), gamma_xy, gamma_xz, gamma_yz (engineering shear strain); or in the
place of any of these sigma_xx, … or tau_xy, … (tension positive). All count from the geostatic start. A component that
has no column keeps its strain.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from pydantic_core import PydanticCustomError

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.errors import SceneError
from riser_soil.scene.columns import TIME, CsvColumns, Known, Units, read_columns

STRAINS = ("eps_xx", "eps_yy", "eps_zz", "gamma_xy", "gamma_xz", "gamma_yz")
STRESSES = ("sigma_xx", "sigma_yy", "sigma_zz", "tau_xy", "tau_xz", "tau_yz")
# Of a strain or stress as an engineer gives it, in the components of mandel.py.
STRAIN_FACTOR: Array = np.array([1.0, 1.0, 1.0, *[math.sqrt(0.5)] * 3])
STRESS_FACTOR: Array = 1.0 / STRAIN_FACTOR

_STRAIN: Units = {"-": 1.0, "%": 0.01}
_STRESS: Units = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6}
_TIME: Units = {**TIME, "h": 3600.0, "d": 86400.0}
_KNOWN: Known = {**dict.fromkeys(STRAINS, _STRAIN), **dict.fromkeys(STRESSES, _STRESS), "time": _TIME}
AMPLITUDES: tuple[float, ...] = tuple(10.0 ** (0.5 * k) for k in range(-10, -2))
ROWS, TURNS = 40, 4  # of the automatic cycles: rows from turn to turn, turns at each amplitude


@dataclass(frozen=True, eq=False)
class MaterialPath:
    """values (nr, 6): strain, or change of stress [Pa] where `stress` (6,) says so, since the start, in the engineer's
    components. names: of the components that are given. source: the file, or what else it comes from. seconds (nr,):
    that each row takes; inf where all is slow.
    """

    values: Array
    stress: BoolArray
    names: tuple[str, ...]
    source: str
    seconds: Array

    @property
    def driven(self) -> int:
        """The component whose given values vary, by strain rather than by stress, and most."""
        span = np.ptp(self.values, axis=0)
        return int(np.argmax(np.where(self.stress, 0.0, span) if (span * ~self.stress).any() else span))


def read_path(file: Path) -> MaterialPath:
    """Raises SceneError, with file and line, for what is wrong."""
    try:
        columns = read_columns(file, _KNOWN, ())
    except PydanticCustomError as err:
        raise SceneError(err.message()) from err
    for strain, stress in zip(STRAINS, STRESSES, strict=True):
        if strain in columns.values and stress in columns.values:
            raise SceneError(f"{file}:{columns.header}: {strain} and {stress} exclude each other; remove one of them")
    if columns.rows == 0:
        raise SceneError(f"{file}:{columns.header}: there are no rows below the header; add the path, row by row")
    if columns.values.keys() <= {"time"}:
        raise SceneError(f"{file}:{columns.header}: there is no strain and no stress beside time; add gamma_xz [-]")
    path = _path_of(columns, str(file))
    late = np.flatnonzero(~(path.seconds > 0.0))
    if late.size:
        raise SceneError(f"{file}:{columns.lines[late[0]]}: time must grow from row to row, from 0 before the first")
    return path


def _path_of(columns: CsvColumns, source: str) -> MaterialPath:
    stress = np.array([name in columns.values for name in STRESSES])
    names = np.where(stress, STRESSES, STRAINS)
    values = np.column_stack([columns.get(str(name)) for name in names])
    names_in_file = tuple(str(n) for n in names if n in columns.values)
    times = columns.values.get("time")
    seconds = np.full(len(values), np.inf) if times is None else np.diff(times, prepend=0.0)
    return MaterialPath(values, stress, names_in_file, source, seconds)


def shear_cycles(amplitudes: Sequence[float] = AMPLITUDES, rows: int = ROWS) -> MaterialPath:
    """Symmetric cycles of gamma_xz that grow, two at each amplitude, under a vertical stress that stays as it is."""
    return shear_path((0.0, *(sign * a for a in amplitudes for sign in (1.0, -1.0) * (TURNS // 2))), rows)


def shear_path(turns: Iterable[float], rows: int, by_stress: bool = False) -> MaterialPath:
    """Simple shear from turn to turn of gamma_xz, or of tau_xz [Pa], under a vertical stress that stays as it is, slow
    all the way.
    """
    driven = np.concatenate([np.linspace(a, b, rows + 1)[1:] for a, b in pairwise(turns)])
    values = np.zeros((driven.size, 6))
    values[:, 4] = driven
    name = STRESSES[4] if by_stress else STRAINS[4]
    stress = np.array([each in ("sigma_zz", name) for each in STRESSES])
    seconds = np.full(driven.size, np.inf)
    return MaterialPath(values, stress, (name, "sigma_zz"), "cycles of simple shear", seconds)
