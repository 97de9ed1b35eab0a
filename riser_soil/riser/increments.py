"""Change of variables from spatial spins to rotation vectors, for element forces and tangents.

A node's frame is R = Rn exp[Theta]; its spin is w = H dTheta with H = Rn T_L(Theta). Element e joins
nodes e and e + 1, its dofs are ordered displacement1, rotation1, displacement2, rotation2. Arrays are
changed in place.
"""


from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.rotations import right_tangent_derivative
from riser_soil.riser.vectors import Mat, Vec, matrix, vecmat, vector


@njit
def _moment_to_increments(moment: Array, H: Mat) -> None:
    m = vecmat(vector(moment), H)
    moment[0], moment[1], moment[2] = m


@njit
def element_to_increments(e: int, f: Array, H: Array) -> None:
    """Turn the moments in f (12,) of element e, conjugate to spins, into those of rotation vectors; H: (nn, 3, 3)."""
    _moment_to_increments(f[3:6], matrix(H[e]))
    _moment_to_increments(f[9:12], matrix(H[e + 1]))


@njit
def _rotate_columns(K: Array, H: Mat) -> None:
    """K (12, 3) becomes K H."""
    for i in range(12):
        row = vecmat(vector(K[i]), H)
        K[i, 0], K[i, 1], K[i, 2] = row


@njit
def _moment_tangent(Rn: Mat, Theta: Vec, moment: Vec) -> Mat:
    """d(H' m)/dTheta of a spatially fixed moment."""
    return right_tangent_derivative(Theta, vecmat(moment, Rn))


@njit
def _end_to_increments(K: Array, at: int, moment: Vec, H: Mat, Rn: Mat, Theta: Vec) -> None:
    """Transform the rows and columns at..at+2 of K (12, 12), and add the change of H at fixed moment."""
    _rotate_columns(K[:, at : at + 3], H)
    rows_to_increments(K, at, moment, H, Rn, Theta)


@njit
def rows_to_increments(K: Array, at: int, moment: Vec, H: Mat, Rn: Mat, Theta: Vec) -> None:
    """Turn the rows at..at+2 of K (12, 12), those of a spatial moment, into those conjugate to the rotation vector."""
    _rotate_columns(K[at : at + 3].T, H)
    geometric = _moment_tangent(Rn, Theta, moment)
    for i in range(3):
        for j in range(3):
            K[at + i, at + j] += geometric[i][j]


@njit
def tangent_to_increments(e: int, f: Array, K: Array, H: Array, Rn: Array, Theta: Array) -> None:
    """Turn the tangent K (12, 12) of element e by spins, where its forces are f (12,), into that by rotation vectors.

    H, Rn (nn, 3, 3) and Theta (nn, 3) belong to the nodes. K becomes the Hessian of the strain energy.
    """
    for end in range(2):
        n, at = e + end, 3 + 6 * end
        moment = vector(f[at : at + 3])
        _end_to_increments(K, at, moment, matrix(H[n]), matrix(Rn[n]), vector(Theta[n]))
