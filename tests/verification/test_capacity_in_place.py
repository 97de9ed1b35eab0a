"""Capacity of a pipe wished in place, smooth and rough, from two meshes, against slip lines, a published fit and
published bounds.
"""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.assembly.contact_laws import contact_width
from riser_soil.assembly.scales import LEAST_WEIGHT, Scales
from riser_soil.core.arrays import Array
from riser_soil.core.system import System
from riser_soil.soil.seabed_feature import GrooveSpec
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built, soil_under, take
from tests.support.pages import Tell
from tests.support.scenes import Mapping, block, cells, level_pipe, pushed_to

D, SU, STEPS = 0.3, 5.0e3, 9
TYPICAL = 5.0e11  # EA over length [N/m]: contact goes by a millionth of it where there is no weight
LEAST = 2.57 * SU  # least pressure under a smooth or a rough pipe, where it is half buried
# In gaps between the groove's strips and the pipe that touches their edges: how far contact gives under that pressure,
# the slide that mobilises adhesion, how far the pipe is pushed. E/su times that gap over D.
GIVES, SLIDES, PUSHED, ELASTIC = 1.0, 0.1, 3.0, 50.0


def half_angle(w: float) -> float:
    """Angle from the bottom of a pipe embedded by w (over D) to where it leaves the clay [rad]."""
    return float(np.arccos(1.0 - 2.0 * w))


def chord(w: float) -> float:
    """Width at the seabed, over D."""
    return float(np.sin(half_angle(w)))


def smooth_by_slip_lines(w: float) -> float:
    """V/(D su) of a smooth pipe embedded by w (over D)."""
    end = half_angle(w)
    return float((2.0 + np.pi) * np.sin(end) - 2.0 * (end * np.sin(end) + np.cos(end) - 1.0))


def rough_by_slip_lines(w: float) -> float:
    """V/(D su) of a rough pipe embedded by w (over D)."""
    end = half_angle(w)
    wedge = min(end, np.pi / 4.0)

    def sliding(angle: float) -> float:
        return float((1.0 + 1.5 * np.pi) * np.sin(angle) - 2.0 * angle * np.sin(angle) - 3.0 * np.cos(angle))

    return float((2.0 + np.pi) * np.sin(wedge) + sliding(end) - sliding(wedge))


def pipe_in_place(w: float, strips: int, rough: bool, *, E_over_su: float = 0.0, down: float = 0.0) -> Mapping:
    """A slice one cell thick, a groove of so many strips; cells as wide as these, and four times as wide far off.

    The strips touch a pipe of the diameter D in their middles; this one is larger, and touches their edges, so that all
    of it touches from the first. It is pushed `down` (over D), by default a few times as far as it overlaps the strips
    at most, into clay so stiff that it yields all around by then. rough: adhesion of 1.
    """
    gap = 0.5 * (1.0 / np.cos(half_angle(w) / strips) - 1.0)
    down, E_over_su = down or PUSHED * gap, E_over_su or ELASTIC / gap
    contact = {"method": "surface", "stiffness": LEAST / (GIVES * gap * D) * touching(E_over_su * SU)}
    roughness = {"friction": {"adhesion": 1.0, "mobilisation": SLIDES * gap * D}} if rough else {}
    size = 1.0001 * half_angle(w) * D / strips
    assert GrooveSpec(w * D, 0.5 * D).strips(size) == strips
    z, across = (0.5 - w) * D, 2.5 * chord(w) * D
    law = {"kind": "von-mises", "su": SU, "E_over_su": E_over_su, "nu": 0.49}
    mesh = cells(size, 4.0 * size, "tet")
    soil = block(law, (0.0, size), across, (w + 1.7 * chord(w)) * D, mesh, strain="small")
    soil["block"]["groove"] = {"embedment": w, "diameter": D}
    return level_pipe(
        pushed_to(size, z - down * D),
        pipe={"outer_diameter": (1.0 + 2.0 * gap) * D, "EA": TYPICAL * size, "EI": 1e8, "submerged_weight": 0.0},
        length=size,
        elements=1,
        height=z,
        initial="unstressed",
        gravity=0.0,
        soil=soil,
        contact=contact | roughness,
        solver={"load_steps": STEPS, "max_iterations": 60},
    )


def touching(E: float) -> float:
    """Width by which the pipe touches elastic soil under its weight [m], over which its contact stiffness is spread."""
    return contact_width(Scales(LEAST_WEIGHT * TYPICAL, D, 0.0), E)


def resistance(scene: Mapping) -> Array:
    """V/(D su) at the end of each step."""
    assembly = built(scene)
    pressing = [part for part in (soil_under(assembly).contact, soil_under(assembly).friction) if part is not None]
    forces: list[float] = []

    def watch(system: System, step: AcceptedStep) -> None:
        forces.append(-sum(float(part.force_on_soil(step.solution.state)[2]) for part in pressing))

    take(assembly, assembly.scene.stages[0], watch=watch)
    return np.array(forces) / (float(scene["soil"]["block"]["x"][1]) * D * SU)


PRANDTL = 2.0 + np.pi
FEW, MORE = (9, 19), (13, 27)  # strips of the groove
WITHIN, COARSE, FALLS = 0.04, 0.03, 3e-3  # shares of the capacity
#: By w/D and roughness, V/(D su) from limit analyses, below and above; as they have been told, the source not at hand.
BOUNDS = {
    (0.1, False): (2.67, 2.80),
    (0.3, False): (3.77, 3.96),
    (0.1, True): (3.00, 3.09),
    (0.5, True): (5.51, np.inf),
}


def fitted(w: float, rough: bool) -> float:
    """V/(D su) = a (w/D)^b, w <= D/2, fitted by Aubeny, Shi & Murff (2005) to finite elements; a, b from memory."""
    return 6.73 * w**0.29 if rough else 4.97 * w**0.23


def fallen(load: Array) -> float:
    """Amount by which the load ever falls below what it has been, over its peak."""
    return float(np.max(np.maximum.accumulate(load) - load) / load.max())


@pytest.mark.parametrize("w", [0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5])
def test_slip_lines_lie_between_what_is_known(w: float) -> None:
    """Prandtl's strip on the chord is the most that a smooth and the least that a rough pipe bears by them."""
    strip = PRANDTL * chord(w)
    assert smooth_by_slip_lines(w) < strip
    assert rough_by_slip_lines(w) >= strip
    assert (rough_by_slip_lines(w) == pytest.approx(strip, rel=1e-12)) == (w < 0.1465)
    assert smooth_by_slip_lines(w) == pytest.approx(_summed(w), rel=1e-6)


def test_a_half_buried_pipe_by_hand() -> None:
    assert smooth_by_slip_lines(0.5) == pytest.approx(4.0)
    assert rough_by_slip_lines(0.5) == pytest.approx(1.0 + 0.5 * np.pi + 2.0 * np.sqrt(2.0))


def test_extrapolation_of_both_orders() -> None:
    for order in (1, 2):
        coarse, fine = (4.0 + 3.0 * float(n) ** -order for n in FEW)
        assert extrapolated(coarse, fine, FEW)[order - 1] == pytest.approx(4.0, rel=1e-12)


def _summed(w: float) -> float:
    """The pressure on a smooth pipe, summed over the surface in contact by the midpoint rule."""
    end, n = float(np.arccos(1.0 - 2.0 * w)), 4000
    angle = (np.arange(n) + 0.5) * end / n
    return float(np.sum((PRANDTL - 2.0 * angle) * np.cos(angle)) * end / n)


@pytest.mark.verify
@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
@pytest.mark.parametrize("w", [0.1, 0.2, 0.3, 0.4, 0.5])
def test_capacity_from_two_meshes(tell: Tell, w: float, rough: bool) -> None:
    """Midway between what first and second order make of them, rough by adhesion. A smooth pipe's load falls a little
    behind its peak.
    """
    strips = FEW if w < 0.35 else MORE
    loads = [resistance(pipe_in_place(w, n, rough)) for n in strips]
    coarse, fine = (float(load.max()) for load in loads)
    first, second = extrapolated(coarse, fine, strips)
    capacity = 0.5 * (first + second)
    between = dict.fromkeys(f"{each:.2f}" for each in sorted((first, second)))
    row = f"{coarse:.2f}, {fine:.2f} | {' to '.join(between)}"
    tell({f"in place {w:g} {'rough' if rough else 'smooth'}": row})
    known = rough_by_slip_lines(w) if rough else smooth_by_slip_lines(w), fitted(w, rough)
    assert (1.0 - WITHIN) * min(known) < capacity < (1.0 + WITHIN) * max(known)
    low, high = BOUNDS.get((w, rough), (0.0, np.inf))
    assert low < capacity < high
    assert abs(coarse / capacity - 1.0) < COARSE
    assert fallen(loads[-1]) < FALLS


def extrapolated(coarse: float, fine: float, strips: tuple[int, int]) -> tuple[float, float]:
    """Load extrapolated to cells without size, by the first and by the second order."""
    ratio = strips[1] / strips[0]
    first, second = (fine + (fine - coarse) / (ratio**order - 1.0) for order in (1, 2))
    return first, second
