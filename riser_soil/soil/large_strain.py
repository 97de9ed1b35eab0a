"""Large strain: stress and history of cells whose nodes a step has moved, and their transfer to a new mesh.

Within a step strain is linear about a geometry, see `Soil.place`. Once it is accepted the law is asked again, with
its history turned along by the step's spin, for strain by gradients of the geometry half way: these vanish where cells
move as rigid bodies, by angles of any size, and follow volumes to third order. T. J. R. Hughes & J. Winget, Finite
rotation effects in numerical integration of rate constitutive equations arising in large-deformation analysis,
Int. J. Numer. Methods Eng. 15 (1980). What this stress lacks of balance, of second order in the step, the next step
takes up.

Stress, history and depth of points are transferred to those of a new mesh. `carried_rows` is for histories, see
`core.carried`; the law brings the states back to what it admits. Strength depends on the
depth at which the material lay at first: each new node gets it from the nearest old one, by the gradient there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.spatial import cKDTree

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.carried import carried
from riser_soil.core.compiled import njit
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.law import STRESS, Formula, StressUpdate
from riser_soil.soil.soil_cells import SoilCells

SHEAR = 1.0 / np.sqrt(2.0)  # of a component in Mandel's notation
SLOPE = ("slope_x", "slope_y", "slope_z")
FIRST, LAST = STRESS[0][-3:], STRESS[-1][-3:]  # "_xx", "_yz"
APART = 10.0  # largest extent of the soil, by which sections are moved apart
Sample = Callable[[Array, Array, Array], tuple[Array, ...]]  # of places, rows there, and targets


def moved_on(cells: SoilCells, points: Array, u: Array, law: Formula, history: Array, dt: float) -> StressUpdate:
    """The law's answer (n points) to the displacements u (3n,) of nodes at points (n, 3), within dt [s]."""
    strain, spin = cells.motion(points + 0.5 * u.reshape(-1, 3), u)
    return law.update(strain, turned(history, law.columns, spin), dt)


def turned(history: Array, columns: Sequence[str], spin: Array) -> Array:
    """History (n, nh) whose tensors have turned by spins (n, 3): those of six columns, named from …_xx to …_yz."""
    out = history.copy()
    for k, name in enumerate(columns):
        if name.endswith(FIRST) and columns[k + 5].endswith(LAST):
            turn(out[:, k : k + 6], spin)
    return out


@njit
def turn(tensors: Array, spin: Array) -> None:
    """Turn tensors (n, 6) by Q = I + (W + W²/2)/(1 + |w|²/4), W the skew matrix of a spin w (n, 3) over the step."""
    Q, S, QS = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for n in range(len(tensors)):
        x, y, z = spin[n]
        if x == 0.0 and y == 0.0 and z == 0.0:
            continue
        _write_turn(x, y, z, Q)
        t = tensors[n]
        S[0, 0], S[1, 1], S[2, 2] = t[0], t[1], t[2]
        S[0, 1] = S[1, 0] = SHEAR * t[3]
        S[0, 2] = S[2, 0] = SHEAR * t[4]
        S[1, 2] = S[2, 1] = SHEAR * t[5]
        _write_product(Q, S, QS)
        _write_product(QS, Q.T, S)
        t[0], t[1], t[2] = S[0, 0], S[1, 1], S[2, 2]
        t[3], t[4], t[5] = S[0, 1] / SHEAR, S[0, 2] / SHEAR, S[1, 2] / SHEAR


@njit
def _write_turn(x: float, y: float, z: float, Q: Array) -> None:
    share = 1.0 / (1.0 + 0.25 * (x * x + y * y + z * z))
    Q[0, 0] = 1.0 - 0.5 * share * (y * y + z * z)
    Q[1, 1] = 1.0 - 0.5 * share * (x * x + z * z)
    Q[2, 2] = 1.0 - 0.5 * share * (x * x + y * y)
    Q[0, 1], Q[1, 0] = share * (0.5 * x * y - z), share * (0.5 * x * y + z)
    Q[0, 2], Q[2, 0] = share * (0.5 * x * z + y), share * (0.5 * x * z - y)
    Q[1, 2], Q[2, 1] = share * (0.5 * y * z - x), share * (0.5 * y * z + x)


@njit
def _write_product(A: Array, B: Array, out: Array) -> None:
    for i in range(3):
        for j in range(3):
            out[i, j] = A[i, 0] * B[0, j] + A[i, 1] * B[1, j] + A[i, 2] * B[2, j]


def nearest_rows(
    grid: DistributedMesh, before: Array, after: Array, rows: Array, columns: Sequence[str]
) -> tuple[Array, Array]:
    """Rows (n, k) of those points of all ranks, at places (m, 3) before, that are nearest to this rank's places (n, 3)
    after; and the ways (n, 3) from there. A place behind a mirror takes the image of what its own image does;
    columns: names of a row's numbers, see `Mirror.turned`. Collective.
    """
    mirror = grid.mirror
    if mirror is None:
        values, way = _sampled(grid, _nearest, before, after, rows)
        return values, way
    behind = mirror.behind(after)
    targets = np.where(behind[:, None], mirror.images(after), after)
    values, way = _sampled(grid, _nearest, before, targets, rows)
    values[behind] *= mirror.turned(columns)
    way[behind] *= mirror.signs
    return values, way


def carried_rows(grid: DistributedMesh, before: Array, after: Array, rows: Array, columns: Sequence[str]) -> Array:
    """Rows (n, k) at this rank's places (n, 3) after, of the field that has rows at places (m, 3) before, on all ranks
    and behind a mirror; columns: see `nearest_rows`. Collective.
    """
    mirror = grid.mirror
    if mirror is not None:
        beyond = ~mirror.behind(before)
        before, rows = before[beyond], rows[beyond]
        before = np.concatenate([before, mirror.images(before)])
        rows = np.concatenate([rows, rows * mirror.turned(columns)])
    return _sampled(grid, _carried, before, after, rows)[0]


def _carried(places: Array, values: Array, targets: Array) -> tuple[Array]:
    return (carried(places, values, targets),)


def _nearest(places: Array, values: Array, targets: Array) -> tuple[Array, Array]:
    """Rows of the points nearest to places (n, 3), and the ways from there."""
    number: IntArray = cKDTree(places).query(targets)[1]
    return values[number], targets - places[number]


def _sampled(grid: DistributedMesh, sample: Sample, before: Array, after: Array, rows: Array) -> tuple[Array, ...]:
    """This rank's share of the samples of all ranks' rows at all ranks' places after; collective. Sections don't sample
    each other, and each is one rank's.
    """
    if grid.family.plane:
        return sample(_apart(grid, before), rows, _apart(grid, after))
    comm = grid.nodes.comm
    gathered = comm.gather((before, rows, after))
    mine: tuple[Array, ...] = comm.scatter([] if gathered is None else _split(gathered, sample))
    return mine


def _apart(grid: DistributedMesh, points: Array) -> Array:
    """Points (n, 3) of sections, these so far from each other that no point is near one of another section."""
    out = points.copy()
    out[:, grid.family.normal] *= APART * float((grid.high - grid.low).max()) / grid.family.thickness
    return out


def _split(gathered: list[tuple[Array, Array, Array]], sample: Sample) -> list[tuple[Array, ...]]:
    """The samples of each rank, from the places, rows and targets of all."""
    places, values, targets = (np.concatenate(each) for each in zip(*gathered, strict=True))
    ends = np.cumsum([len(after) for _, _, after in gathered])[:-1]
    return list(zip(*(np.split(column, ends) for column in sample(places, values, targets)), strict=True))


def carried_depths(
    grid: DistributedMesh, cells: SoilCells, depth: Array, before: Array, after: Array, none: float
) -> Array:
    """Depths (n,) that the nodes' material had at first, once they lie at points (n, 3) after; none: a way that is none
    [m]. Collective.
    """
    moved = (np.abs(after - before).max(axis=1) > none) & (depth > 0.0)
    targets, own = after[moved], slice(grid.nodes.owned)
    slope, _ = nearest_rows(grid, cells.at_points(before), targets, cells.slopes(depth), SLOPE)
    there, way = nearest_rows(grid, before[own], targets, depth[own, None], ("depth",))
    out = depth.copy()
    out[moved] = np.maximum(there[:, 0] + np.einsum("ni,ni->n", slope, way), 0.0)
    return out
