"""A stiff pipe wished in place in a slice of weightless clay, pushed down; what slip lines say of its capacity.

Slip lines: where the clay at the pipe's surface yields, Hencky's relation along the slip lines from the level seabed
beside the pipe gives the pressure on it, su times

    smooth: 2 + π - 2 θ,       rough: 1 + 3/2 π - 2 θ, beside the shear stress su,

θ being the angle from the pipe's bottom; under a rough pipe, up to θ = π/4, a wedge sticks to it, on whose level top
Prandtl's (2 + π) su stands. Its sum over the surface in contact, θ up to arccos(1 - 2 w/D), is a load. For a rough pipe
with w/D <= (1 - 1/√2)/2 it is the exact capacity: Prandtl's stress field on the chord, less what the pipe takes out of
it, is a lower bound; Prandtl's wedge under the chord, which holds all of the pipe, moves with it: an upper one. The
chord's (2 + π) su is a lower bound for any rough pipe. Else neither the stress beyond the slip lines nor velocities
along them have been worked out, and the load may be less than the capacity.
"""

from __future__ import annotations

import numpy as np

from riser_soil.assembly.contact_laws import contact_width
from riser_soil.assembly.scales import LEAST_WEIGHT, Scales
from riser_soil.core.arrays import Array
from riser_soil.core.system import System
from riser_soil.soil.seabed_feature import GrooveSpec
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built, soil_under, take
from tests.support.scenes import Mapping, block, cells, level_pipe, pushed_to

D, SU, STEPS = 0.3, 5.0e3, 9
TYPICAL = 5.0e11  # EA over length [N/m]: contact goes by a millionth of it where there is no weight
LEAST = 2.57 * SU  # least pressure under a smooth or a rough pipe, where it is half buried
# In gaps between the groove's strips and the pipe that touches their edges: how far contact gives under that pressure,
# the slide that mobilises adhesion, how far the pipe is pushed. E/su times that gap over D.
GIVES, SLIDES, PUSHED, ELASTIC = 1.0, 0.1, 3.0, 50.0


def half_angle(w: float) -> float:
    """From the bottom of a pipe embedded by w (over D) to where it leaves the clay [rad]."""
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
