"""Beam elements against their own energy, finite differences, rigid motions and each other."""

from collections.abc import Callable
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from riser_soil.core.arrays import Array
from riser_soil.riser import (
    beam2d,
    beam3d,
    corotation,
    rotations,
    strain3d,
)
from riser_soil.riser.stiffness import LineStiffness, Stiffness
from riser_soil.riser.tension_only import Linear, TensionOnly, pulled
from riser_soil.riser.vectors import isotropic, matrix, vector
from tests.support import planar_elements, spatial_elements

pytestmark = pytest.mark.usefixtures("uncompiled")

NE = 5
EA = 2.0e3
TOLERANCE = 1e-9  # of finite differences
UNHURRIED = settings(deadline=None)  # the first call compiles
STENCIL = {-3: -1 / 60, -2: 3 / 20, -1: -3 / 4, 1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
SHAPES = pytest.mark.parametrize("curved", [0.0, 0.3], ids=["straight", "curved"])
ROTATIONS = pytest.mark.parametrize("rotation", [1e-4, 0.3, 1.0])


def exp(rotation: Array) -> Array:
    return np.array(rotations.exp(vector(rotation)))


def turns(rng: np.random.Generator, angle: float, n: int) -> Array:
    """n rotations by `angle` about random axes."""
    axes = rng.normal(size=(n, 3))
    return np.array([exp(angle * a / np.linalg.norm(a)) for a in axes])


class Space(NamedTuple):
    """Elements in space: unstressed and current configuration."""

    chord0: Array
    frames0: Array  # (2, ne, 3, 3)
    ref: beam3d.SpatialReference
    section: LineStiffness
    chord: Array
    frames: Array
    load: Array  # (ne, 3)

    def at(self, moved: Array) -> tuple[Array, Array, Array]:
        """Chords and frames of the ends, moved by (ne, 12) displacements and spatial rotations."""
        first, second = (np.array([exp(w) for w in moved[:, at : at + 3]]) for at in (3, 9))
        return self.chord + moved[:, 6:9] - moved[:, :3], first @ self.frames[0], second @ self.frames[1]

    def call(self, function: Callable, moved: Array | None = None) -> Array:
        """Forces, or what else the function finds of them, at this configuration or where it has moved to."""
        return function(*self.at(np.zeros((NE, 12)) if moved is None else moved), self.ref, self.section, self.load)

    def energy(self, moved: Array) -> Array:
        """Strain energy and potential of the load."""
        at, middle = self.at(moved), 0.5 * (moved[:, :3] + moved[:, 6:9])
        return spatial_elements.strain_energy(*at, self.ref, self.section) + spatial_elements.load_potential(
            *at, middle, self.section, self.load
        )


def space(curved: float, rotation: float, seed: int = 7, load: float = 0.0) -> Space:
    rng = np.random.default_rng(seed)
    L, base = 1.0 + rng.random(NE), turns(rng, 1.0, NE)
    chord0 = (L * (1.0 - curved**2 / 8))[:, None] * base[:, :, 0]
    frames0 = np.array([turns(rng, curved, NE) @ base, turns(rng, curved, NE) @ base])
    bending = 1 + rng.random(NE), 2 + rng.random(NE), 1.5 + rng.random(NE)
    section = Stiffness(L, np.full(NE, EA), *bending, Linear())
    rigid = turns(rng, 2.0, NE)
    chord = np.einsum("eij,ej->ei", rigid, chord0) * 1.02
    frames = np.array([turns(rng, rotation, NE) @ rigid @ end for end in frames0])
    ref = beam3d.reference(chord0, frames0[0], frames0[1], L)
    return Space(chord0, frames0, ref, section, chord, frames, load * rng.normal(size=(NE, 3)))


def loaded_space(curved: float, rotation: float) -> Space:
    return space(curved, rotation, load=20.0)


class Plane(NamedTuple):
    """Elements in a plane: unstressed and current configuration."""

    chord0: Array
    directions0: Array  # (2, ne)
    ref: beam2d.LineReference
    section: LineStiffness
    chord: Array
    directions: Array

    def call(self, function: Callable, moved: Array | None = None) -> Array:
        """function at this configuration, moved by (ne, 6) displacements and angles."""
        s = np.zeros((NE, 6)) if moved is None else moved
        ends = self.directions[0] + s[:, 2], self.directions[1] + s[:, 5]
        return function(self.chord + s[:, 3:5] - s[:, :2], *ends, self.ref, self.section)

    def energy(self, moved: Array) -> Array:
        """Strain energy."""
        return self.call(planar_elements.strain_energy, moved)


def plane(curved: float, rotation: float, seed: int = 7) -> Plane:
    rng = np.random.default_rng(seed)
    L, base = 1.0 + rng.random(NE), 6.0 * rng.random(NE)
    chord0 = (L * (1.0 - curved**2 / 8)) * np.array([np.cos(base), np.sin(base)])
    directions0 = base + curved * rng.uniform(-1, 1, size=(2, NE))
    EI = 1 + rng.random(NE)
    section = Stiffness(L, np.full(NE, EA), EI, 3 * EI, EI, Linear())
    chord = 1.02 * np.array([[0.6, -0.8], [0.8, 0.6]]) @ chord0
    directions = directions0 + np.arctan2(0.8, 0.6) + rotation * rng.choice([-1.0, 1.0], size=(2, NE))
    ref = beam2d.reference(chord0.T, directions0[0], directions0[1])
    return Plane(chord0.T, directions0, ref, section, chord.T, directions)


def derivative(function: Callable[[Array], Array], n: int, step: float = 3e-3) -> Array:
    """Sixth-order finite differences by the n dofs of each element; the last index is the dof."""
    columns = []
    for unit in np.eye(n):
        moves = [c * function(np.tile(k * step * unit, (NE, 1))) for k, c in STENCIL.items()]
        columns.append(np.sum(moves, axis=0) / step)
    return np.stack(columns, axis=-1)


def difference(a: Array, b: Array) -> float:
    """Largest difference over the largest entry."""
    return float(np.abs(a - b).max() / np.abs(b).max())


CASES = pytest.mark.parametrize(
    ("build", "module", "n"),
    [(plane, planar_elements, 6), (space, spatial_elements, 12), (loaded_space, spatial_elements, 12)],
    ids=["2D", "3D", "3D under load"],
)


@CASES
@SHAPES
@ROTATIONS
def test_forces_are_the_gradient_of_the_energy(
    build: Callable[[float, float], Space | Plane], module: ModuleType, n: int, curved: float, rotation: float
) -> None:
    elements = build(curved, rotation)
    assert difference(elements.call(module.forces), derivative(elements.energy, n)) < TOLERANCE


@CASES
@SHAPES
@ROTATIONS
def test_tangent_is_the_derivative_of_the_forces(
    build: Callable[[float, float], Space | Plane], module: ModuleType, n: int, curved: float, rotation: float
) -> None:
    elements = build(curved, rotation)
    f, K = elements.call(module.forces_and_tangent)
    assert difference(K, derivative(lambda moved: elements.call(module.forces, moved), n)) < TOLERANCE
    assert difference(f, elements.call(module.forces)) < 2e-14  # round-off of a strain of 0.02 that is counted from 1


def going_slack(elements: Any, shorter: float, share: float, soft: float, fold: float) -> Any:
    """Elements in space or in a plane, their chords shortened, that bear no compression."""
    law = TensionOnly(*(np.full(NE, value) for value in (share, soft, fold)))
    return elements._replace(chord=shorter * elements.chord, section=elements.section._replace(law=law))


@pytest.mark.parametrize(("shorter", "soft"), [(0.96, 0.3), (0.6, 0.05)], ids=["in between", "slack"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_elements_that_go_slack_follow_from_their_energy(dimension: int, shorter: float, soft: float) -> None:
    """And would not without any of the three constants."""
    build, module, n = (plane, planar_elements, 6) if dimension == 2 else (loaded_space, spatial_elements, 12)
    given = {"share": 0.03, "soft": soft, "fold": 2e5}
    elements = going_slack(build(0.0, 0.4), shorter, **given)
    assert difference(elements.call(module.forces), derivative(elements.energy, n)) < TOLERANCE

    def forces(moved: Array) -> Array:
        return np.asarray(elements.call(module.forces, moved))

    f, K = elements.call(module.forces_and_tangent)
    assert difference(f, forces(np.zeros((NE, n)))) < 1e-14
    assert difference(K, derivative(forces, n)) < TOLERANCE
    for constant, value in (("share", 1.0), ("soft", 2.0 * soft + 0.5), ("fold", 0.0)):
        other = going_slack(build(0.0, 0.4), shorter, **(given | {constant: value}))
        assert difference(other.call(module.forces_and_tangent)[1], K) > 1e3 * TOLERANCE


@SHAPES
@given(seed=st.integers(0, 2**32 - 1), angle=st.floats(-25.0, 25.0))
@UNHURRIED
def test_rigid_motion_in_space_gives_no_force(curved: float, seed: int, angle: float) -> None:
    at_rest = space(curved, 0.0, seed)
    Q = turns(np.random.default_rng(seed), angle, 1)[0]
    moved = at_rest._replace(chord=at_rest.chord0 @ Q.T, frames=Q @ at_rest.frames0)
    assert np.abs(moved.call(spatial_elements.forces)).max() < 1e-12 * EA


@SHAPES
@given(seed=st.integers(0, 2**32 - 1), angle=st.floats(-25.0, 25.0))
@UNHURRIED
def test_rigid_motion_in_a_plane_gives_no_force(curved: float, seed: int, angle: float) -> None:
    at_rest = plane(curved, 0.0, seed)
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    moved = at_rest._replace(chord=at_rest.chord0 @ Q.T, directions=at_rest.directions0 + angle)
    assert np.abs(moved.call(planar_elements.forces)).max() < 1e-12 * EA


@SHAPES
def test_elements_in_space_are_in_equilibrium(curved: float) -> None:
    elements = space(curved, 0.8)
    force1, moment1, force2, moment2 = np.split(elements.call(spatial_elements.forces), 4, axis=1)
    assert np.abs(force1 + force2).max() < 1e-12 * EA
    assert np.abs(moment1 + moment2 + np.cross(elements.chord, force2)).max() < 1e-12 * EA


@given(seed=st.integers(0, 2**32 - 1), turn=st.floats(-1.0, 1.0))
@UNHURRIED
def test_strains_do_not_depend_on_the_frame_about_the_chord(seed: int, turn: float) -> None:
    rng = np.random.default_rng(seed)
    about_chord, ends = exp(np.array([turn, 0.0, 0.0])), turns(rng, 0.8, 2)
    strains = []
    for frames in (ends, about_chord @ ends):
        a, b = (corotation.split(matrix(A)).angles for A in frames)
        strain = strain3d.strain(1.0, 0.97, a, b, strain3d.stations(1.0, a, b))
        strains.append([strain.axial, strain.twist, *strain.first, *strain.second])
    assert np.abs(np.array(strains[0]) - strains[1]).max() < 1e-12


PLANAR = [0, 2, 4, 6, 8, 10]  # x, z and the moment about -y, that is from x to z, of both nodes
TO_PLANE = np.eye(12)[PLANAR] * np.array([1, 1, -1, 1, 1, -1])[:, None]


def upright(directions: Array) -> Array:
    """Section frames (..., 3, 3) of tangents in the x-z plane, second axis in the plane."""
    c, s, o = np.cos(directions), np.sin(directions), np.zeros_like(directions)
    columns = np.stack([c, o, s]), np.stack([-s, o, c]), np.stack([o, o - 1, o])
    return np.moveaxis(np.stack(columns, axis=1), (0, 1), (-2, -1))


@SHAPES
@ROTATIONS
@pytest.mark.parametrize("load", [0.0, 20.0], ids=["unloaded", "under load"])
def test_plane_is_space_restricted_to_a_plane(curved: float, rotation: float, load: float) -> None:
    flat = plane(curved, rotation)
    w = load * np.random.default_rng(2).normal(size=(NE, 2))
    in_space = flat.chord0 @ np.eye(3)[[0, 2]], flat.chord @ np.eye(3)[[0, 2]]
    frames0, frames = upright(flat.directions0), upright(flat.directions)
    EI, L = flat.section.EI_y, flat.section.L
    section = flat.section._replace(EI_y=3 * EI, EI_z=EI)
    ref = beam3d.reference(in_space[0], frames0[0], frames0[1], L)
    f3, K3 = spatial_elements.forces_and_tangent(in_space[1], frames[0], frames[1], ref, section, w @ np.eye(3)[[0, 2]])
    f2, K2 = flat.call(planar_elements.forces_and_tangent)
    f2 += planar_elements.load_forces(flat.chord, *flat.directions, L, w)
    planar_elements.add_load_tangent(K2, 1.0, flat.chord, *flat.directions, L, w)
    assert difference(f3 @ TO_PLANE.T, f2) < 1e-12
    assert difference(TO_PLANE @ K3 @ TO_PLANE.T, K2) < 1e-12
    assert np.abs(np.delete(f3, PLANAR, axis=1)).max() < 1e-12 * EA


class Nodes(NamedTuple):
    """Committed frames and rotation vectors of a chain's nodes, and end frames turned back by both."""

    Rn: Array
    Theta: Array
    H: Array
    ends: Array  # (2, ne, 3, 3)


def nodes_of(elements: Space, angle: float) -> Nodes:
    rng = np.random.default_rng(3)
    Rn, Theta = turns(rng, 2.0, NE + 1), angle * rng.normal(size=(NE + 1, 3))
    R = Rn @ np.array([exp(t) for t in Theta])
    H = Rn @ np.array([rotations.left_tangent(vector(t)) for t in Theta])
    back = np.swapaxes(R, -1, -2)
    return Nodes(Rn, Theta, H, np.array([back[:-1] @ elements.frames[0], back[1:] @ elements.frames[1]]))


def increments_forces(elements: Space, nodes: Nodes, moved: Array) -> Array:
    """Forces conjugate to displacements and rotation vectors after increments (12,) of every element."""
    Theta1, Theta2 = nodes.Theta[:-1] + moved[3:6], nodes.Theta[1:] + moved[9:]
    ends = []
    for Rn, Theta, end in ((nodes.Rn[:-1], Theta1, nodes.ends[0]), (nodes.Rn[1:], Theta2, nodes.ends[1])):
        ends.append(Rn @ np.array([exp(t) for t in Theta]) @ end)
    chord, given = elements.chord + moved[6:9] - moved[:3], (elements.ref, elements.section, elements.load)
    f = spatial_elements.forces(chord, *ends, *given)
    for n, Theta, at in ((0, Theta1, 3), (1, Theta2, 9)):
        H = nodes.Rn[n : n + NE] @ np.array([rotations.left_tangent(vector(t)) for t in Theta])
        f[:, at : at + 3] = np.einsum("eji,ej->ei", H, f[:, at : at + 3])
    return f


@SHAPES
@pytest.mark.parametrize("angle", [0.0, 1e-3, 0.7])
def test_tangent_by_rotation_vectors_is_the_symmetric_hessian(curved: float, angle: float) -> None:
    elements = loaded_space(curved, 0.8)
    nodes = nodes_of(elements, angle)
    f, K = elements.call(spatial_elements.forces_and_tangent)
    by_spins = K.copy()
    spatial_elements.to_increments(f, K, nodes.H, nodes.Rn, nodes.Theta)
    step, expected = 3e-3, np.zeros_like(K)
    for j, unit in enumerate(np.eye(12)):
        for k, c in STENCIL.items():
            expected[:, :, j] += c / step * increments_forces(elements, nodes, k * step * unit)
    assert difference(f, increments_forces(elements, nodes, np.zeros(12))) < 1e-13
    assert difference(K, expected) < TOLERANCE
    assert difference(K, np.swapaxes(K, 1, 2)) < 1e-12
    assert difference(by_spins, np.swapaxes(by_spins, 1, 2)) > 1e-3


def test_forces_alone_and_with_tangent_transform_alike() -> None:
    elements = loaded_space(0.3, 0.8)
    nodes = nodes_of(elements, 0.7)
    alone = elements.call(spatial_elements.forces)
    f, K = elements.call(spatial_elements.forces_and_tangent)
    spatial_elements.forces_to_increments(alone, nodes.H)
    spatial_elements.to_increments(f, K, nodes.H, nodes.Rn, nodes.Theta)
    assert difference(alone, f) < 1e-14


def nothing(*_: object) -> corotation.SpatialNodalForces:
    return corotation.SpatialNodalForces((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


# What a term of the tangent is replaced by to leave it out: module, function, substitute
LEFT_OUT = {
    "spin of the frame": (beam3d, "turn", nothing),
    "longer chord": (beam3d, "lengthen", lambda *_: beam3d.STILL),
    "swing and twist": (beam3d, "moment_variation", lambda *_: beam3d.STILL),
    "gradients of the strains": (beam3d, "conjugate_change", lambda *_: (beam3d.STILL, beam3d.STILL)),
    "torque rate": (beam3d, "stress_change", lambda D, _, __, change: strain3d.linear_stress(D, change)),
    "turn under the load": (beam3d, "turned", lambda *_: corotation.NO_LOAD),
    "load along the chord": (beam3d, "chord_force", lambda *_: beam3d.STILL),
}


def interpret(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs the tangent's own functions uncompiled, so that they see substitutes."""
    for name in ("move", "strain_of", "forces_change", "_vary", "_write_change", "_tangent", "write_element"):
        monkeypatch.setattr(beam3d, name, getattr(beam3d, name).py_func)


@pytest.mark.parametrize("term", LEFT_OUT)
def test_each_geometric_term_of_the_tangent_matters(term: str, monkeypatch: pytest.MonkeyPatch) -> None:
    elements = loaded_space(0.0, 0.6)
    _, compiled = elements.call(spatial_elements.forces_and_tangent)  # before its functions are replaced
    interpret(monkeypatch)
    _, K = elements.call(spatial_elements.forces_and_tangent.py_func)
    assert difference(K, compiled) < 1e-14
    monkeypatch.setattr(*LEFT_OUT[term])
    _, incomplete = elements.call(spatial_elements.forces_and_tangent.py_func)
    assert difference(incomplete, K) > 1e4 * TOLERANCE


def test_geometric_term_of_rotation_vectors_matters(monkeypatch: pytest.MonkeyPatch) -> None:
    elements = space(0.0, 0.6)
    nodes = nodes_of(elements, 0.7)
    f, K = elements.call(spatial_elements.forces_and_tangent)
    f_incomplete, incomplete = f.copy(), K.copy()
    spatial_elements.to_increments(f, K, nodes.H, nodes.Rn, nodes.Theta)
    for name in ("tangent_to_increments", "_end_to_increments", "rows_to_increments"):
        monkeypatch.setattr(rotations, name, getattr(rotations, name).py_func)
    monkeypatch.setattr(rotations, "_moment_tangent", lambda *_: isotropic(0.0))
    spatial_elements.to_increments.py_func(f_incomplete, incomplete, nodes.H, nodes.Rn, nodes.Theta)
    assert difference(incomplete, K) > 1e4 * TOLERANCE


def test_geometric_term_of_the_plane_matters(monkeypatch: pytest.MonkeyPatch) -> None:
    elements = plane(0.0, 0.6)
    _, K = elements.call(planar_elements.forces_and_tangent)
    for name in ("_vary", "_tangent", "write_element"):
        monkeypatch.setattr(beam2d, name, getattr(beam2d, name).py_func)
    monkeypatch.setattr(beam2d, "pulled", pulled.kernels[Linear])
    monkeypatch.setattr(beam2d, "configuration_variation", lambda *_: (0.0, 0.0))
    _, incomplete = elements.call(planar_elements.forces_and_tangent.py_func)
    assert difference(incomplete, K) > 1e4 * TOLERANCE


def test_torque_that_varies_along_an_element_twists_it_within() -> None:
    """A section that turns by phi turns its curvature k against its moment, at P phi per length with P the torque's
    rate, and bends by phi k'. The energy is that of the parabola phi, 0 at both ends, for which
    1/2 (GJ phi'^2 + k'.D k' phi^2) - P phi is least.
    """
    L, GJ, EI = 3.0, 4.0, np.array([2.0, 5.0])
    D = Stiffness(L, EA, 2.0, 5.0, GJ, Linear())
    k, k0 = np.array([0.11, -0.07]), np.array([0.03, 0.02])
    P = k[0] * EI[1] * (k - k0)[1] - k[1] * EI[0] * (k - k0)[0]
    s, weight = (0.5 * L * values for values in np.polynomial.legendre.leggauss(5))
    s += 0.5 * L
    phi, slope, turned = 4.0 * s * (L - s) / L**2, 4.0 * (L - 2.0 * s) / L**2, EI @ k[::-1] ** 2
    stiffness = weight @ (GJ * slope**2 + turned * phi**2)  # of the parabola's top
    least = -0.5 * (weight @ phi * P) ** 2 / stiffness
    bent = 0.5 * L * EI @ (k - k0) ** 2
    total, elastic = (strain3d.Strain(0.0, 0.0, tuple(each), tuple(each), 0.0) for each in (k, k - k0))
    assert strain3d.energy(D, total, elastic) == pytest.approx(bent + least, rel=1e-12)
    assert least < -1e-4 * bent
