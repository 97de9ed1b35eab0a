"""Tables of a vessel's response amplitude operators (RAOs), and netCDF files as capytaine has them."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import NEAREST, Vector
from riser_soil.scene.columns import ANGLE, CsvColumns, Known, read_columns
from riser_soil.scene.files import wrong_file
from riser_soil.scene.netcdf_variables import NetcdfVariable, read_variables

if TYPE_CHECKING:
    import numpy as np
else:
    np = LazyModule("numpy")

TURN = 2.0 * math.pi
TRANSLATIONS, ROTATIONS = ("surge", "sway", "heave"), ("roll", "pitch", "yaw")
MODES = TRANSLATIONS + ROTATIONS

_KNOWN: Known = {
    "frequency": {"rad/s": 1.0, "Hz": TURN},
    "period": {"s": 1.0},
    "direction": ANGLE,
    **{name: {"m/m": 1.0} for name in TRANSLATIONS},
    **{name: {"deg/m": math.pi / 180.0, "rad/m": 1.0} for name in ROTATIONS},
    **{f"{name} phase": ANGLE for name in MODES},
}
# Difference of two rows for the same wave (directions of 0 and 360 deg) that is taken for round-off.
_SAME = 1e-6
# Responses [m/m] and [rad/m] that are none.
_NEGLIGIBLE = 1e-9
# Widest step of directions [rad] over which RAOs are interpolated, but for round-off.
_WIDEST = math.radians(45.0) + 1e-6
# Directions [rad] nearer than this are the same one.
_SAME_DIRECTION = 1e-9
_FREQUENCY: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "omega": lambda omega: omega, "freq": lambda freq: TURN * freq, "period": lambda period: TURN / period
}  # fmt: skip
_WAVES = (*_FREQUENCY, "wavenumber", "wavelength")  # dimensions that waves may be counted along
_DEGREES_OF_FREEDOM = ("radiating_dof", "influenced_dof")
_SAME_WAVES = 1e-9  # directions [rad] nearer than this are one


@dataclass(frozen=True)
class Rao:
    """Responses to a unit wave by mode, direction (rows) and frequency (columns): complex, amplitude times
    exp(-i lag), [m/m] and [rad/m].

    frequency: increasing [rad/s]. direction: increasing, from 0 to below 2 pi [rad].
    """

    frequency: tuple[float, ...]
    direction: tuple[float, ...]
    response: Mapping[str, tuple[tuple[complex, ...], ...]]

    def around(self, direction: float) -> list[int]:
        """Numbers of the directions between which a direction [rad] lies, periodically; one where it hits it."""
        hit = [n for n, known in enumerate(self.direction) if abs(_wrapped(direction - known)) < _SAME_DIRECTION]
        above = sum(known <= direction % TURN for known in self.direction)
        return hit or [(above - 1) % len(self.direction), above % len(self.direction)]

    def moving(self, direction: float) -> list[str]:
        """Modes that respond to waves of a direction [rad]."""
        rows = self.around(direction)
        return [
            mode
            for mode, table in self.response.items()
            if any(abs(value) > _NEGLIGIBLE for row in rows for value in table[row])
        ]

    def gap(self, direction: float) -> tuple[float, float] | None:
        """The known directions around a direction that lies too far between them [rad]; None when it doesn't."""
        first, last = (self.direction[n] for n in (self.around(direction) * 2)[:2])
        hit = abs(_wrapped(direction - first)) < _SAME_DIRECTION
        wide = (last - first) % TURN > _WIDEST or first == last
        return None if hit or not wide else (first, last)


def vessel_axis(mode: str, heading_deg: float) -> Vector:
    """Global direction of a mode's displacement, or axis of its rotation, of a vessel with this heading."""
    heading = math.radians(heading_deg)
    forward, across = math.cos(heading), math.sin(heading)
    return ((forward, across, 0.0), (-across, forward, 0.0), (0.0, 0.0, 1.0))[MODES.index(mode) % 3]


def read_rao(file: Path) -> Rao:
    """Read a table of RAOs; PydanticCustomError, with the file and its line, for what is wrong."""
    columns = read_columns(file, _KNOWN, required=("direction",))
    modes = _modes(columns)
    rows_by_key: dict[tuple[float, float], tuple[int, list[complex]]] = {}
    responses = [_responses(columns, mode) for mode in modes]
    for row, wave in enumerate(zip(_frequencies(columns), _directions(columns), strict=True)):
        line, values = columns.lines[row], [response[row] for response in responses]
        known = rows_by_key.setdefault(wave, (line, values))
        if any(abs(a - b) > _SAME for a, b in zip(values, known[1], strict=True)):
            text = f"{_named(wave)} was given differently in line {known[0]}; remove one of the two rows"
            raise wrong_file(f"{file}:{line}: {text}")
    return _on_a_grid(columns, modes, {wave: values for wave, (_, values) in rows_by_key.items()})


def _modes(columns: CsvColumns) -> list[str]:
    """The modes that have columns, each with its phase."""
    place = f"{columns.file}:{columns.header}"
    modes = [mode for mode in MODES if mode in columns.values or f"{mode} phase" in columns.values]
    if not modes:
        raise wrong_file(f"{place}: no column is a response; give surge [m/m], surge phase [deg] and so on")
    for mode in modes:
        for name in (mode, f"{mode} phase"):
            if name not in columns.values:
                raise wrong_file(f"{place}: there is no column {name} [{next(iter(_KNOWN[name]))}]; add it")
    if ("frequency" in columns.values) == ("period" in columns.values):
        raise wrong_file(f"{place}: waves have a frequency or a period; give one of these columns")
    if not columns.rows:
        raise wrong_file(f"{place}: the table has no rows; give one for each wave")
    return modes


def _frequencies(columns: CsvColumns) -> list[float]:
    """Frequency of each row [rad/s]."""
    name = "frequency" if "frequency" in columns.values else "period"
    for line, value in zip(columns.lines, columns.values[name], strict=True):
        if value < NEAREST:
            raise wrong_file(f"{columns.file}:{line}: {name} must be greater than 0, {NEAREST:g} at least; correct it")
    given = columns.values[name]
    return list(given) if name == "frequency" else [TURN / period for period in given]


def _directions(columns: CsvColumns) -> list[float]:
    """Wave direction of each row, from 0 to below 2 pi [rad]; to 12 digits, so that 360 deg are 0."""
    return [round(value % TURN, 12) % round(TURN, 12) for value in columns.values["direction"]]


def _responses(columns: CsvColumns, mode: str) -> list[complex]:
    for line, amplitude in zip(columns.lines, columns.values[mode], strict=True):
        if amplitude < 0.0:
            text = f"{mode} must not be negative; write its size and add 180 deg to {mode} phase"
            raise wrong_file(f"{columns.file}:{line}: {text}")
    pairs = zip(columns.values[mode], columns.values[f"{mode} phase"], strict=True)
    return [amplitude * cmath.exp(-1j * lag) for amplitude, lag in pairs]


def _on_a_grid(columns: CsvColumns, modes: list[str], responses: dict[tuple[float, float], list[complex]]) -> Rao:
    frequency = tuple(sorted({w for w, _ in responses}))
    direction = tuple(sorted({angle for _, angle in responses}))
    missing = [(w, angle) for angle in direction for w in frequency if (w, angle) not in responses]
    if missing:
        text = f"there is no row for {_named(missing[0])}; give each frequency for each direction"
        raise wrong_file(f"{columns.file}: {text}")
    tables = {
        mode: tuple(tuple(responses[w, angle][n] for w in frequency) for angle in direction)
        for n, mode in enumerate(modes)
    }
    return Rao(frequency, direction, tables)


def _named(wave: tuple[float, float]) -> str:
    return f"the wave of {wave[0]:.6g} rad/s ({TURN / wave[0]:.6g} s) and {math.degrees(wave[1]):.6g} deg"


def _wrapped(angle: float) -> float:
    """An angle from -pi to pi [rad]."""
    return math.remainder(angle, TURN)


def read_capytaine(file: Path) -> Rao:
    """The variable RAO, by omega (or freq, period), wave_direction [rad] and a dof: Surge, ... Yaw [m/m, rad/m]; in the
    files of capytaine 2 and 3 (its export_dataset), where waves may be counted by their number or length, too.

    Complex numbers stand in a dimension `complex` of re and im, or are the file's own. Capytaine's motions are
    Re(X exp(-i w t)) where the crest of a wave passes the origin at t = 0, so that the argument of X is the lag behind
    it: the responses here are conj(X). PydanticCustomError for what is wrong.
    """
    variables = read_variables(file)
    if "RAO" not in variables:
        remedy = 'give the dataset capytaine.post_pro.rao(dataset) by this name before capytaine.export_dataset'
        raise wrong_file(f"{file}: has no variable RAO; {remedy}")
    _refuse_another_centre(file, variables)
    rao = _as_complex(file, variables["RAO"], variables)
    by = _dim(file, rao, _WAVES), _dim(file, rao, ("wave_direction",)), _dim(file, rao, _DEGREES_OF_FREEDOM)
    if missing := [dim for dim in (*by, *rao.dims) if dim not in variables or dim not in by]:
        raise wrong_file(f"{file}: RAO has a dimension {missing[0]} without values, or of another kind; leave it out")
    modes = [_mode(file, name) for name in variables[by[2]].values]
    if len(set(modes)) < len(modes):
        raise wrong_file(f"{file}: has several bodies; keep the degrees of freedom of one")
    w, columns = _sorted(file, "frequency", _frequency_along(file, by[0], variables), NEAREST)
    angle = np.round(variables[by[1]].values % TURN, 12) % round(TURN, 12)
    direction, rows = _sorted(file, "wave_direction", angle, _SAME_WAVES)
    values = np.conj(rao.along(by[1], by[0], by[2]))[rows][:, columns]
    if not np.isfinite(values).all() or not w[0] >= NEAREST:
        raise wrong_file(f"{file}: RAO has values that are not finite, or a frequency of 0; leave such waves out")
    table = {mode: tuple(tuple(map(complex, row)) for row in values[:, :, n]) for n, mode in enumerate(modes)}
    return Rao(w, direction, table)


def _refuse_another_centre(file: Path, variables: dict[str, NetcdfVariable]) -> None:
    """Phases count from the crest at the mesh's origin, displacements are those of the rotation centre; a scene has one
    reference for both. Capytaine 3 writes the centre, 2 doesn't.
    """
    centre = variables.get("rotation_center")
    if centre is not None and centre.values.shape == (3,) and (np.abs(centre.values[:2]) > NEAREST).any():
        place = ", ".join(f"{x:.6g}" for x in centre.values[:2])
        remedy = "compute with rigid_body_dofs(rotation_center=(0, 0, z)), the mesh moved so that this is the reference"
        raise wrong_file(f"{file}: its body turns about x, y = {place} m, and phases count from 0, 0; {remedy}")


def _frequency_along(file: Path, dim: str, variables: dict[str, NetcdfVariable]) -> np.ndarray:
    """Frequencies [rad/s] of waves that are counted along a dimension."""
    for name in (dim, *_FREQUENCY):
        if name in _FREQUENCY and name in variables and variables[name].dims == (dim,):
            return _FREQUENCY[name](variables[name].values)
    raise wrong_file(f"{file}: has no omega, freq or period of each {dim}; write them, too")


def _sorted(file: Path, what: str, values: np.ndarray, apart: float) -> tuple[tuple[float, ...], np.ndarray]:
    """Values in order, and the order."""
    order = np.argsort(values)
    if not np.isfinite(values).all() or (np.diff(values[order]) < apart).any():
        raise wrong_file(f"{file}: a {what} is given twice, or not finite; leave it out")
    return tuple(map(float, values[order])), order


def _as_complex(file: Path, rao: NetcdfVariable, variables: dict[str, NetcdfVariable]) -> NetcdfVariable:
    if "complex" not in rao.dims:
        if rao.values.dtype.kind != "c":
            raise wrong_file(f"{file}: RAO is real; keep its phases, as capytaine.export_dataset does")
        return rao
    names = [_word(name) for name in variables["complex"].values] if "complex" in variables else ["re", "im"]
    re, im = (rao.at({"complex": names.index(name)}) for name in ("re", "im"))
    return NetcdfVariable(re.dims, re.values + 1j * im.values, rao.attributes)


def _dim(file: Path, rao: NetcdfVariable, known: tuple[str, ...]) -> str:
    dims = [dim for dim in rao.dims if dim in known]
    if len(dims) != 1:
        raise wrong_file(f"{file}: RAO has the dimensions {', '.join(rao.dims)}, of which none or two are {known[0]}")
    return dims[0]


def _mode(file: Path, name: str | bytes) -> str:
    """Name of a motion in lower case, from that of a degree of freedom such as `Heave` or `hull__Heave`."""
    mode = _word(name).rpartition("__")[2].lower()
    if mode not in MODES:
        raise wrong_file(f"{file}: {_word(name)} is no motion of a rigid vessel ({', '.join(MODES)}); leave it out")
    return mode


def _word(name: str | bytes) -> str:
    return name.decode() if isinstance(name, bytes) else str(name)
