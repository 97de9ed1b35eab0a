"""Three-vectors and 3x3 matrices as tuples, for compiled kernels.

A `Vec` is a tuple of three floats, a `Mat` a tuple of three rows. Tuples live in registers, so a kernel
allocates nothing per element. `vector` and `matrix` read them from arrays, `store` writes a matrix to one;
`np.array(A)` works too, also in compiled code. In the plane the third component is 0: `padded`, `put` and
`write_matrix` take arrays of two components or three.
"""

import math

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

Vec = tuple[float, float, float]
Mat = tuple[Vec, Vec, Vec]


@njit
def vector(a: Array) -> Vec:
    """The vector stored in an array of shape (3,)."""
    return (a[0], a[1], a[2])


@njit
def matrix(a: Array) -> Mat:
    """The matrix stored in an array of shape (3, 3)."""
    return ((a[0, 0], a[0, 1], a[0, 2]), (a[1, 0], a[1, 1], a[1, 2]), (a[2, 0], a[2, 1], a[2, 2]))


@njit
def store(A: Mat, out: Array) -> None:
    """Write the matrix A to `out`, shape (3, 3)."""
    out[0, 0], out[0, 1], out[0, 2] = A[0]
    out[1, 0], out[1, 1], out[1, 2] = A[1]
    out[2, 0], out[2, 1], out[2, 2] = A[2]


@njit
def padded(a: Array) -> Vec:
    """The vector stored in an array of shape (2,) or (3,)."""
    return (a[0], a[1], a[2] if a.size > 2 else 0.0)


@njit
def write(v: Vec, out: Array) -> None:
    """Write the vector v to `out`, shape (2,) or (3,)."""
    out[0], out[1] = v[0], v[1]
    if out.size > 2:
        out[2] = v[2]


@njit
def write_matrix(A: Mat, out: Array) -> None:
    """Write the matrix A to `out`, shape (2, 2) or (3, 3)."""
    write(A[0], out[0])
    write(A[1], out[1])
    if len(out) > 2:
        write(A[2], out[2])


@njit
def add(a: Vec, b: Vec) -> Vec:
    """a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@njit
def sub(a: Vec, b: Vec) -> Vec:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@njit
def scale(s: float, a: Vec) -> Vec:
    """s a."""
    return (s * a[0], s * a[1], s * a[2])


@njit
def dot(a: Vec, b: Vec) -> float:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit
def cross(a: Vec, b: Vec) -> Vec:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@njit
def norm(a: Vec) -> float:
    """Length of a."""
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@njit
def transpose(A: Mat) -> Mat:
    """The transpose of A; also the matrix whose columns are the three given vectors."""
    return ((A[0][0], A[1][0], A[2][0]), (A[0][1], A[1][1], A[2][1]), (A[0][2], A[1][2], A[2][2]))


@njit
def matvec(A: Mat, v: Vec) -> Vec:
    """A v."""
    return (dot(A[0], v), dot(A[1], v), dot(A[2], v))


@njit
def vecmat(v: Vec, A: Mat) -> Vec:
    """v A, that is the transpose of A times v."""
    return (
        v[0] * A[0][0] + v[1] * A[1][0] + v[2] * A[2][0],
        v[0] * A[0][1] + v[1] * A[1][1] + v[2] * A[2][1],
        v[0] * A[0][2] + v[1] * A[1][2] + v[2] * A[2][2],
    )


@njit
def matmul(A: Mat, B: Mat) -> Mat:
    """A B."""
    return (vecmat(A[0], B), vecmat(A[1], B), vecmat(A[2], B))


@njit
def matadd(A: Mat, B: Mat) -> Mat:
    """A + B."""
    return (add(A[0], B[0]), add(A[1], B[1]), add(A[2], B[2]))


@njit
def matscale(s: float, A: Mat) -> Mat:
    """s A."""
    return (scale(s, A[0]), scale(s, A[1]), scale(s, A[2]))


@njit
def outer(a: Vec, b: Vec) -> Mat:
    """The dyad of a and b."""
    return (scale(a[0], b), scale(a[1], b), scale(a[2], b))


@njit
def isotropic(s: float) -> Mat:
    """s times the identity."""
    return ((s, 0.0, 0.0), (0.0, s, 0.0), (0.0, 0.0, s))


@njit
def skew(v: Vec) -> Mat:
    """[v], the matrix with [v] a = v x a."""
    return ((0.0, -v[2], v[1]), (v[2], 0.0, -v[0]), (-v[1], v[0], 0.0))
