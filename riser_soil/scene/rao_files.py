"""RAOs in netCDF files as capytaine has them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import NEAREST
from riser_soil.scene.files import wrong_file
from riser_soil.scene.netcdf_variables import NetcdfVariable, read_variables
from riser_soil.scene.rao import MODES, TURN, Rao

if TYPE_CHECKING:
    import numpy as np
else:
    np = LazyModule("numpy")

_FREQUENCY: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "omega": lambda omega: omega, "freq": lambda freq: TURN * freq, "period": lambda period: TURN / period
}  # fmt: skip
_DEGREES_OF_FREEDOM = ("radiating_dof", "influenced_dof")
_SAME = 1e-9  # directions [rad] nearer than this are one


def read_capytaine(file: Path) -> Rao:
    """The variable RAO, by omega (or freq, period), wave_direction [rad] and a dof: Surge, ... Yaw [m/m, rad/m].

    Complex numbers stand in a dimension `complex` of re and im, or are the file's own. Capytaine's motions are
    Re(X exp(-i w t)) where the crest of a wave passes the origin at t = 0, so that the argument of X is the lag behind
    it: the responses here are conj(X). PydanticCustomError for what is wrong.
    """
    variables = read_variables(file)
    if "RAO" not in variables:
        raise wrong_file(f"{file}: has no variable RAO; write capytaine's RAO by separate_complex_values, to this name")
    rao = _as_complex(file, variables["RAO"], variables)
    by = _dim(file, rao, tuple(_FREQUENCY)), _dim(file, rao, ("wave_direction",)), _dim(file, rao, _DEGREES_OF_FREEDOM)
    if missing := [dim for dim in (*by, *rao.dims) if dim not in variables or dim not in by]:
        raise wrong_file(f"{file}: RAO has a dimension {missing[0]} without values, or of another kind; leave it out")
    modes = [_mode(file, name) for name in variables[by[2]].values]
    if len(set(modes)) < len(modes):
        raise wrong_file(f"{file}: has several bodies; keep the degrees of freedom of one")
    w, columns = _sorted(file, "frequency", _FREQUENCY[by[0]](variables[by[0]].values), NEAREST)
    angle = np.round(variables[by[1]].values % TURN, 12) % round(TURN, 12)
    direction, rows = _sorted(file, "wave_direction", angle, _SAME)
    values = np.conj(rao.along(by[1], by[0], by[2]))[rows][:, columns]
    if not np.isfinite(values).all() or not w[0] >= NEAREST:
        raise wrong_file(f"{file}: RAO has values that are not finite, or a frequency of 0; leave such waves out")
    table = {mode: tuple(tuple(map(complex, row)) for row in values[:, :, n]) for n, mode in enumerate(modes)}
    return Rao(w, direction, table)


def _sorted(file: Path, what: str, values: np.ndarray, apart: float) -> tuple[tuple[float, ...], np.ndarray]:
    """Values in order, and the order."""
    order = np.argsort(values)
    if not np.isfinite(values).all() or (np.diff(values[order]) < apart).any():
        raise wrong_file(f"{file}: a {what} is given twice, or not finite; leave it out")
    return tuple(map(float, values[order])), order


def _as_complex(file: Path, rao: NetcdfVariable, variables: dict[str, NetcdfVariable]) -> NetcdfVariable:
    if "complex" not in rao.dims:
        if rao.values.dtype.kind != "c":
            raise wrong_file(f"{file}: RAO is real; keep its phases, by separate_complex_values")
        return rao
    names = [_word(name) for name in variables["complex"].values] if "complex" in variables else ["re", "im"]
    re, im = (rao.at({"complex": names.index(name)}) for name in ("re", "im"))
    return NetcdfVariable(re.dims, re.values + 1j * im.values, rao.attributes)


def _dim(file: Path, rao: NetcdfVariable, known: tuple[str, ...]) -> str:
    found = [dim for dim in rao.dims if dim in known]
    if len(found) != 1:
        raise wrong_file(f"{file}: RAO has the dimensions {', '.join(rao.dims)}, of which none or two are {known[0]}")
    return found[0]


def _mode(file: Path, name: str | bytes) -> str:
    """Of a degree of freedom, `Heave` or `hull__Heave`."""
    mode = _word(name).rpartition("__")[2].lower()
    if mode not in MODES:
        raise wrong_file(f"{file}: {_word(name)} is no motion of a rigid vessel ({', '.join(MODES)}); leave it out")
    return mode


def _word(name: str | bytes) -> str:
    return name.decode() if isinstance(name, bytes) else str(name)

