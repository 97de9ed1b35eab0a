"""A heavy tensioned beam on springs, small slopes, against closed forms.

With the height y over the surface of the bed and the flexural length l = sqrt(EI/H),

    EI y'''' - H y'' + k y + w = 0  where it lies,    EI y'''' - H y'' + w = 0  where it hangs.

The layer at the touchdown point depends on K = k l⁴/EI alone (C. P. Pesce, J. A. P. Aranha, C. A. Martins: The soil
rigidity effect in the touchdown boundary-layer of a catenary riser: static problem, ISOPE 1998; S. Lenci, M. Callegari:
Simple analytical models for the J-lay problem, Acta Mechanica 178 (2005)). Derived here anew.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results.riser_record import riser_record
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.contact_along import touchdown_at
from tests.support.driven_stage import Watcher, built
from tests.support.scenes import prescribed, riser_scene, static

EI, H, WEIGHT = 1.0e3, 1.0e3, 0.1  # l = 1 m; slopes of some thousandths
PIPE = {"outer_diameter": 0.1, "mass": 1.0, "submerged_weight": WEIGHT, "EA": 1.0e9, "EI": EI}
DECADES = tuple(10.0**power for power in range(-2, 5))


@dataclass(frozen=True, eq=False)
class BedShape:
    """Nodes (nn,) of a beam on its bed: arc and height over the bed's surface [m], slope, moment [N.m]. touchdown: arc
    [m].
    """

    arc: Array
    height: Array
    slope: Array
    moment: Array
    touchdown: float


def lying(k: float, length: float, size: float, method: str, *loads: Any, tension: float = H) -> BedShape:
    """Pinned at the bed's surface, pulled at its free end."""
    depth = WEIGHT / k
    pull = {"at": "end", "force": [tension, 0.0, 0.0], "history": [[0.0, 1.0], [1.0, 1.0]]}
    scene = riser_scene(
        static(loads=[pull, *loads]),
        pipe=PIPE,
        length=length,
        elements=int(np.ceil(length / size)),
        start=prescribed(0.0, 0.0, 0.0),
        end="free",
        riser={"initial": {"points": [[0.0, 0.0, 0.0], [length, 0.0, 0.0]]}},
        seabed={"kind": "spring", "level": 0.0, "stiffness": k, "contact_at": "axis"},
        contact={"method": method, "smoothing": 1e-3 * depth},
        solver={"tolerance": 1e-10},
        gravity=9.81,
        water={"density": 1000.0},
    )
    assembly, results = built(scene), list[BedShape]()

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        riser, line = riser_record(assembly.riser, stepper), assembly.riser.line
        assert assembly.riser.seabed is not None
        tangent = line.trial(stepper.now).turn.tangent
        slope = np.append(tangent[:, 0, 1] / tangent[:, 0, 0], tangent[-1, 1, 1] / tangent[-1, 1, 0])
        touchdown = touchdown_at(assembly.riser.seabed, stepper.now)
        results.append(BedShape(line.arc, riser.position[:, 2], slope, riser.bending_moment, touchdown))

    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), Watcher(watch), Timer.new())
    return results[-1]


def roots(k: float, tension: float = H) -> Array:
    """Roots of EI r⁴ - H r² + k = 0 with positive real parts (2,)."""
    under = np.sqrt(complex(tension**2 - 4.0 * EI * k))
    return np.sqrt(np.array([tension + under, tension - under]) / (2.0 * EI))


@dataclass(frozen=True)
class Layer:
    """At the contact's end: moment over EI w/H, slope over w l/H, and how far it lies before the catenary's touchdown
    point [l]; how far before that the touchdown point lies that doesn't depend on how the force is spread [l].
    """

    moment: float
    slope: float
    end: float
    touchdown: float


def layer(K: float) -> Layer:
    """Closed form. On a bed softer than K = 1 no concentrated force has the moment of the forces found: the point is
    then where the catenary touches down, whose hanging part weighs as much as the riser's end bears.
    """
    root = np.sqrt(K)
    moment, slope = (np.sqrt(1.0 + 2.0 * root) - 1.0) / root, 1.0 / root
    return Layer(float(moment), float(slope), float(1.0 - moment - slope), float(np.sqrt(max(1.0 - 1.0 / K, 0.0))))


def matched_layer(K: float) -> Layer:
    """The layer by matching, with w = H = EI = l = 1: y = -1/K + A1 exp(r1 x) + A2 exp(r2 x) for x < 0 and y'' = 1 + C
    exp(-x) beyond; y and its first three derivatives are continuous at x = 0, where y = 0. K > 1.
    """
    r = roots(K * EI)
    M = np.array([[1.0, 1.0, 0.0], [r[0] ** 2, r[1] ** 2, -1.0], [r[0] ** 3, r[1] ** 3, 1.0]])
    *A, C = np.linalg.solve(M, np.array([1.0 / K, 1.0, 0.0]))
    slope, C = complex(A @ r).real, complex(C).real
    F, G = (complex(-K * np.sum(A / r**power)).real for power in (1, 2))
    return Layer(1.0 + C, slope, -C - slope, -C - slope + float(np.sqrt(F**2 + 2.0 * G)) - F)


def computed_layer(K: float, method: str = "line") -> Layer:
    """The elements' answer: its end is pulled up by the weight of what hangs below it in a catenary."""
    decay = float(roots(K * EI).real.min())
    hanging = 14.0 + K**-0.5  # m; what the free end does has died out at the touchdown point
    length, size = 24.0 / decay + 3.0 + hanging, 0.1 * min(1.0, 2.0 * K**-0.25)
    lift = {"at": "end", "force": [0.0, 0.0, WEIGHT * hanging]}
    result = lying(K * EI, length, size, method, lift)
    height = CubicSpline(result.arc, result.height)
    last = int(np.flatnonzero(result.height < 0.0)[-1])
    end = float(brentq(height, result.arc[last], result.arc[last + 1]))
    moment, slope = CubicSpline(result.arc, result.moment)(end), CubicSpline(result.arc, result.slope)(end)
    catenary = length - hanging
    return Layer(float(moment) / WEIGHT, float(slope) * H / WEIGHT, catenary - end, catenary - result.touchdown)


@pytest.mark.parametrize("K", [1.5, 10.0, 1e4, 1e6])
def test_closed_form_of_the_layer(K: float) -> None:
    """On stiff beds the touchdown point is l before the catenary's up to 1/(2 K), the contact's end up to K^(-1/4)."""
    exact = layer(K)
    assert astuple(exact) == pytest.approx(astuple(matched_layer(K)), rel=1e-6)
    if K > 1e3:
        assert exact.touchdown == pytest.approx(1.0 - 0.5 / K, abs=K**-2.0)
        assert exact.end == pytest.approx(1.0 - np.sqrt(2.0) * K**-0.25, abs=0.1 * K**-0.25)


@pytest.mark.parametrize("K", DECADES)
def test_layer_over_six_decades(K: float) -> None:
    """At K = 1 the touchdown point goes as the root of 1 - 1/K, so it tells every small error there."""
    length, exact = computed_layer(K), layer(K)
    assert length.moment == pytest.approx(exact.moment, rel=1e-3)
    assert length.slope == pytest.approx(exact.slope, rel=1e-3)
    assert length.end == pytest.approx(exact.end, abs=1e-3)
    near = 0.1 if K == 1.0 else 1e-2 if K < 1.0 else 1e-3
    assert length.touchdown == pytest.approx(exact.touchdown, abs=near)


@pytest.mark.verify
@pytest.mark.parametrize("K", DECADES)
def test_node_contact_over_six_decades(K: float) -> None:
    """On the same elements; up to a thousand times less exact."""
    length, exact = computed_layer(K, "node"), layer(K)
    assert length.moment == pytest.approx(exact.moment, rel=4e-3)
    assert length.slope == pytest.approx(exact.slope, rel=4e-3)
    assert length.end == pytest.approx(exact.end, abs=2e-3)


@pytest.mark.parametrize("tension", [0.3 * H, H])
@pytest.mark.parametrize(("method", "near"), [("line", 1e-4), ("node", 5e-3)])
def test_point_load_on_a_long_beam(tension: float, method: str, near: float) -> None:
    """Deflection P/(2 EI r1 r2 (r1 + r2)) and moment P/(2 (r1 + r2)) under the load, r1 r2 = sqrt(k/EI) and
    (r1 + r2)² = H/EI + 2 sqrt(k/EI). Forces of the bed at nodes alone leave f h²/12 of the moment, h an element's size.
    """
    k, P, length = EI, WEIGHT, 40.0
    load = {"at": 0.5 * length, "force": [0.0, 0.0, -P]}
    result = lying(k, length, 0.1, method, load, tension=tension)
    middle = result.arc.size // 2
    total = float(np.sqrt(tension / EI + 2.0 * np.sqrt(k / EI)))
    assert total == pytest.approx(float(roots(k, tension).sum().real))
    assert -result.height[middle] - WEIGHT / k == pytest.approx(P / (2.0 * np.sqrt(EI * k) * total), rel=near)
    assert result.moment[middle] == pytest.approx(P / (2.0 * total), rel=near)
