"""Large strain: stress and history of cells whose nodes a step has moved, and the geometry from there on.

Within a step strain is linear about the geometry at its start. Once the step is accepted the law is asked again, with
its history turned along by the step's spin, for strain by gradients of the geometry half way: these vanish where cells
move as rigid bodies, by angles of any size, and follow volumes to third order. T. J. R. Hughes & J. Winget, Finite
rotation effects in numerical integration of rate constitutive equations arising in large-deformation analysis,
Int. J. Numer. Methods Eng. 15 (1980). What this stress lacks of balance, of second order in the step, the next step
takes up.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.soil import kernels
from riser_soil.soil.element import cell_gradients
from riser_soil.soil.families import Family
from riser_soil.soil.law import STRESS, Formula, StressUpdate

SHEAR = 1.0 / np.sqrt(2.0)  # of a component in Mandel's notation
FIRST, LAST = STRESS[0][-3:], STRESS[-1][-3:]  # "_xx", "_yz"


def moved_on(
    family: Family, points: Array, cells: IntArray, u: Array, law: Formula, history: Array, dt: float
) -> StressUpdate:
    """The law's answer (n points) to the displacements u (3n,) of nodes at points (n, 3), in cells (nc, nn), within
    dt [s].
    """
    half = cell_gradients(family, points + 0.5 * u.reshape(-1, 3), cells)
    nc, nq = half.weights.shape
    strain, spin = np.empty((nc, nq, 6)), np.empty((nc, nq, 3))
    kernels.strain(half.full, half.volume, cells, u, strain)
    kernels.spin(half.full, cells, u, spin)
    return law.update(strain.reshape(-1, 6), turned(history, law.columns, spin.reshape(-1, 3)), dt)


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
        _put_turn(x, y, z, Q)
        t = tensors[n]
        S[0, 0], S[1, 1], S[2, 2] = t[0], t[1], t[2]
        S[0, 1] = S[1, 0] = SHEAR * t[3]
        S[0, 2] = S[2, 0] = SHEAR * t[4]
        S[1, 2] = S[2, 1] = SHEAR * t[5]
        _put_product(Q, S, QS)
        _put_product(QS, Q.T, S)
        t[0], t[1], t[2] = S[0, 0], S[1, 1], S[2, 2]
        t[3], t[4], t[5] = S[0, 1] / SHEAR, S[0, 2] / SHEAR, S[1, 2] / SHEAR


@njit
def _put_turn(x: float, y: float, z: float, Q: Array) -> None:
    share = 1.0 / (1.0 + 0.25 * (x * x + y * y + z * z))
    Q[0, 0] = 1.0 - 0.5 * share * (y * y + z * z)
    Q[1, 1] = 1.0 - 0.5 * share * (x * x + z * z)
    Q[2, 2] = 1.0 - 0.5 * share * (x * x + y * y)
    Q[0, 1], Q[1, 0] = share * (0.5 * x * y - z), share * (0.5 * x * y + z)
    Q[0, 2], Q[2, 0] = share * (0.5 * x * z + y), share * (0.5 * x * z - y)
    Q[1, 2], Q[2, 1] = share * (0.5 * y * z - x), share * (0.5 * y * z + x)


@njit
def _put_product(A: Array, B: Array, out: Array) -> None:
    for i in range(3):
        for j in range(3):
            out[i, j] = A[i, 0] * B[0, j] + A[i, 1] * B[1, j] + A[i, 2] * B[2, j]
