"""Beam elements against closed forms and published results, with declared rates of convergence."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from riser_soil.core.arrays import Array
from riser_soil.riser import beam2d
from riser_soil.riser.stiffness import LineStiffness
from tests.support import planar_elements
from tests.support.beam_chain import Element2d, arc_space, load, straight_plane, straight_space
from tests.support.rod_reference import Rod, tip

STIFF = 1e9  # EA L^2 / EI of a cantilever that hardly stretches


def orders(errors: Array) -> Array:
    """Observed orders between successive halvings of the element length."""
    return np.log2(errors[:-1] / errors[1:])


def elastica(load_factor: float) -> Array:
    """Tip (x/L, y/L, slope) of an inextensible cantilever under a dead tip load load_factor EI/L^2.

    Bisshopp & Drucker, Large deflection of cantilever beams, Q. Appl. Math. 3 (1945).
    """
    alpha = np.sqrt(load_factor)

    def modulus_and_amplitude(slope: float) -> tuple[float, float]:
        m = 0.5 * (1.0 + np.sin(slope))
        return m, np.arcsin(1.0 / np.sqrt(2.0 * m))

    def length_error(slope: float) -> float:
        m, phi = modulus_and_amplitude(slope)
        return float(ellipk(m) - ellipkinc(phi, m) - alpha)

    slope = brentq(length_error, 1e-6, 0.5 * np.pi - 1e-12, xtol=1e-15)
    m, phi = modulus_and_amplitude(slope)
    y = 1.0 - 2.0 / alpha * (ellipe(m) - ellipeinc(phi, m))
    return np.array([np.sqrt(2.0 * np.sin(slope)) / alpha, y, slope])


def second_order_element(
    chord: Array, direction1: Array, direction2: Array, ref: beam2d.LineReference, section: LineStiffness
) -> tuple[Array, Array]:
    """The textbook corotational element, that is `beam2d` without the shallow-arch term of its strain."""
    length = np.hypot(*chord.T)
    c, s = chord.T / length
    o, k = np.zeros_like(c), section.EI_y / section.L
    phi1, phi2 = (
        np.arctan2(
            c * np.sin(direction) - s * np.cos(direction), c * np.cos(direction) + s * np.sin(direction)
        )
        - theta0
        for direction, theta0 in ((direction1, ref.theta1), (direction2, ref.theta2))
    )
    N = section.EA * (length - ref.l0) / section.L
    M1, M2 = k * (4 * phi1 + 2 * phi2), k * (2 * phi1 + 4 * phi2)
    along, across = np.stack([-c, -s, o, c, s, o], axis=1), np.stack([s, -c, o, -s, c, o], axis=1)
    spin = across / length[:, None]
    strains = np.stack([along, np.eye(6)[2] - spin, np.eye(6)[5] - spin], axis=1)
    stiffness = np.array(
        [
            [[a, 0, 0], [0, 4 * b, 2 * b], [0, 2 * b, 4 * b]]
            for a, b in zip(section.EA / section.L, k, strict=True)
        ]
    )
    turning = across[:, :, None] * spin[:, None]
    coupling = along[:, :, None] * spin[:, None] + spin[:, :, None] * along[:, None]
    geometric = N[:, None, None] * turning + ((M1 + M2) / length)[:, None, None] * coupling
    f = np.einsum("eki,ek->ei", strains, np.stack([N, M1, M2], axis=1))
    return f, np.swapaxes(strains, 1, 2) @ stiffness @ strains + geometric


def cantilever_errors(load_factor: float, sizes: list[int], element: Element2d) -> Array:
    """Errors of the tip (x, y, slope) of a cantilever of unit length and stiffness."""
    exact, errors = elastica(load_factor), []
    for n in sizes:
        chain = straight_plane(n, 1.0, STIFF, 1.0, element)
        load(chain, np.array([0.0, load_factor, 0.0]), steps=10)
        errors.append(np.abs([*chain.x[-1], chain.theta[-1]] - exact))
    return np.array(errors)


@pytest.mark.parametrize(("load_factor", "largest"), [(1.0, 6e-6), (5.0, 2e-4), (10.0, 5e-4)])
def test_cantilever_is_the_elastica_at_fourth_order(load_factor: float, largest: float) -> None:
    errors = cantilever_errors(load_factor, [4, 8, 16], planar_elements.forces_and_tangent)
    assert errors[0].max() < largest
    assert orders(errors).min() > 3.7


@pytest.mark.parametrize("load_factor", [1.0, 5.0, 10.0])
def test_without_the_shallow_arch_term_the_element_is_of_second_order(load_factor: float) -> None:
    errors = cantilever_errors(load_factor, [16, 32, 64], second_order_element)
    with_term = cantilever_errors(load_factor, [16], planar_elements.forces_and_tangent)
    assert orders(np.linalg.norm(errors, axis=1)) == pytest.approx(2.0, abs=0.1)
    assert errors[0].max() > 100 * with_term.max()


@pytest.mark.parametrize("circles", [1, 2])
def test_end_moment_rolls_a_cantilever_up_in_a_plane(circles: int) -> None:
    errors = []
    for n in (16, 32, 64):
        chain = straight_plane(n, 1.0, 1e6, 1.0, planar_elements.forces_and_tangent)
        load(chain, np.array([0.0, 0.0, 2 * np.pi * circles]), steps=10 * circles)
        assert np.abs(chain.x[-1]).max() < 1e-12
        assert chain.theta[-1] == pytest.approx(2 * np.pi * circles, abs=1e-12)
        errors.append(np.abs(chain.x[n // 2 // circles] - [0.0, 1 / (np.pi * circles)]))
    assert errors[0][1] < 4e-5 * circles**3
    assert orders(np.array(errors)[:, 1]) == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize("circles", [1, 2])
@pytest.mark.parametrize("tilt", [0.0, 0.9])
def test_end_moment_rolls_a_cantilever_up_in_space(circles: int, tilt: float) -> None:
    axis, errors = np.array([0.0, -np.cos(tilt), -np.sin(tilt)]), []
    across = np.cross(axis, [1.0, 0.0, 0.0])
    for n in (16, 32):
        chain = straight_space(n, 1.0, 1e6, (1.0, 1.0), 0.7)
        load(chain, np.concatenate([np.zeros(3), 2 * np.pi * circles * axis]), steps=10 * circles)
        assert np.abs(chain.x[-1]).max() < 1e-10
        assert np.abs(chain.R[-1] - np.eye(3)).max() < 1e-10
        errors.append(np.linalg.norm(chain.x[n // 2 // circles] - across / (np.pi * circles)))
    assert orders(np.array(errors)) == pytest.approx(4.0, abs=0.1)


CANTILEVERS = {  # GJ, EIy, EIz, tip force, tip moment
    "round": ([0.7, 1.0, 1.0], [0.0, 2.0, 1.0], [0.0, 1.5, 0.0]),
    "round with torque": ([0.7, 1.0, 1.0], [0.0, 2.0, 1.0], [1.5, 0.5, 0.0]),
    "unequal stiffnesses": ([0.7, 1.0, 2.0], [0.0, 2.0, 1.0], [0.5, 1.0, 0.0]),
}


@pytest.mark.parametrize("case", CANTILEVERS)
def test_straight_cantilever_in_space_is_of_fourth_order(case: str) -> None:
    stiffness, force, moment = (np.array(values) for values in CANTILEVERS[case])
    exact = tip(Rod(1.0, 1e4, stiffness, np.zeros(3), np.eye(3)), force, moment)
    errors = []
    for n in (4, 8, 16):
        chain = straight_space(n, 1.0, 1e4, (stiffness[1], stiffness[2]), stiffness[0])
        load(chain, np.concatenate([force, moment]), steps=16)
        errors.append(np.linalg.norm(chain.x[-1] - exact))
    assert errors[0] < 1e-4
    assert orders(np.array(errors)).min() > 3.6


BEND = {"radius": 100.0, "angle": np.pi / 4, "EA": 1e7, "EI": 1e7 / 12, "GJ": 1e7 / 12}
BEND_FRAME = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])


def bend_tips(force: float, sizes: list[int]) -> Array:
    """Tip positions of a cantilever bent to 45 degrees under a force out of its plane."""
    tips = []
    for n in sizes:
        chain = arc_space(n, **BEND)
        load(chain, np.array([0.0, 0.0, force, 0.0, 0.0, 0.0]), steps=6)
        tips.append(chain.x[-1])
    return np.array(tips)


@pytest.mark.parametrize("force", [*(pytest.param(x, marks=pytest.mark.verify) for x in (300.0, 450.0)), 600.0])
def test_45_degree_bend_is_of_fourth_order(force: float) -> None:
    scaled = Rod(
        BEND["radius"] * BEND["angle"], BEND["EA"], np.full(3, BEND["EI"]), np.array([0, 0, 0.01]), BEND_FRAME
    )
    exact = tip(scaled, np.array([0.0, 0.0, force]), np.zeros(3))
    errors = np.linalg.norm(bend_tips(force, [4, 8, 16]) - exact, axis=1)
    assert errors[1] < 1.5e-5 * BEND["radius"] * BEND["angle"]
    assert orders(errors).min() > 3.7


@pytest.mark.parametrize(
    ("force", "published"), [(300.0, [22.33, 58.84, 40.08]), (600.0, [15.79, 47.23, 53.37])]
)
def test_45_degree_bend_agrees_with_published_results(force: float, published: list[float]) -> None:
    """Bathe & Bolourchi, Int. J. Numer. Meth. Engng 14 (1979); values of Simo & Vu-Quoc, Comput. Methods
    Appl. Mech. Engng 58 (1986), whose elements bend linearly and shear: hence the tolerance.
    """
    assert bend_tips(force, [8])[0] == pytest.approx(np.array(published), abs=0.12)
