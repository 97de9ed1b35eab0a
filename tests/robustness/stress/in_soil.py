"""Stress cases of soil: nearly incompressible, of hardly any strength, yielding all over, under penalties of any
size.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy

import numpy as np
from scipy.optimize import brentq

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer, between, near
from tests.robustness.stress.case import Runs, Trial, one, stress_case
from tests.support.pushed_pipe import INDENTATION, D, E, slice_of_soil
from tests.support.scenes import Mapping, lying_pipe

CELLS = 16  # across the diameter


def pushed(nu: float = 0.49, stiffness: float | str = "auto") -> Mapping:
    """A stiff pipe pushed 0.02 D into a slice of elastic soil, 4 m deep."""
    scene = slice_of_soil(CELLS)
    scene["soil"]["law"]["nu"] = nu
    scene["contact"]["stiffness"] = stiffness
    return scene


def resistance(run: Run) -> float:
    """Per length of the slice [N/m]."""
    low, high = run.scene["soil"]["block"]["x"]
    return float(run["contact_force_sum"][-1, 2]) / (high - low)


def hertz(nu: float) -> float:
    """Force per length q at which a cylinder comes nearer to a point 4 m deep by the indentation (Johnson 1985, section
    5.6): d = q/(pi E*) [2 ln(2 depth/b) - nu/(1 - nu)], b = (2 q D/(pi E*))^0.5, E* = E/(1 - nu^2).
    """
    modulus = E / (1.0 - nu**2)

    def misses(q: float) -> float:
        b = np.sqrt(2.0 * q * D / (np.pi * modulus))
        return float(q / (np.pi * modulus) * (2.0 * np.log(8.0 / b) - nu / (1.0 - nu)) - INDENTATION)

    return float(brentq(misses, 1.0, 1e6))


@stress_case()
def poissons_ratio_of_0_4999() -> Trial:
    """A pipe pressed into elastic soil of nu = 0.4999 meets Hertz's resistance to 15 % (a slice 4 m deep is no half
    space), and changes from that of nu = 0.49 as Hertz's does: elements that lock would be half as stiff again.
    """

    def answers(runs: Runs) -> Iterator[Answer]:
        usual, extreme = resistance(runs["usual"]), resistance(runs["extreme"])
        yield near("resistance [N/m]", extreme, hertz(0.4999), rel=0.15)
        yield near("over that of nu = 0.49 [-]", extreme / usual, hertz(0.4999) / hertz(0.49), rel=0.03)

    return Trial({"usual": pushed(0.49), "extreme": pushed(0.4999)}, answers)


@stress_case(cpu=120)
def penalty_on_soil_over_six_decades() -> Trial:
    """Contact stiffness of 1e5, 1e7, 1e9 and 1e11 N/m2 on elastic soil: the resistance grows with it, below that of a
    pipe which can't sink into the soil's surface; the last two differ by a hundredth at most.
    """
    refinement = {f"k{n}": pushed(stiffness=10.0**n) for n in (5, 7, 9, 11)}

    def answers(runs: Runs) -> Iterator[Answer]:
        forces = [resistance(runs[name]) for name in refinement]
        yield between("least growth along the ladder [N/m]", float(np.diff(forces).min()), 0.0)
        yield between("the softest over Hertz's [-]", forces[0] / hertz(0.49), 0.0, 1.0)
        yield near("resistance at 1e11 N/m2 [N/m]", forces[-1], hertz(0.49), rel=0.15)
        yield near("that at 1e9 over 1e11 N/m2 [-]", forces[-2] / forces[-1], 1.0, rel=0.01)

    return Trial(refinement, answers)


def resting(su: float) -> Mapping:
    """Load steps down to a hundredth alone."""
    scene = lying_pipe(su)
    scene["solver"]["min_load_step"] = 0.01
    return scene


@stress_case(cpu=120)
def clay_of_hardly_any_strength() -> Trial:
    """A pipe of 717 N/m on clay of su = 0.1 Pa, which bears (2 + pi) su D = 0.15 N/m: there is no equilibrium, and the
    bearing capacity is told.
    """

    def answers(run: Run) -> Iterator[Answer]:
        yield between("what must not end well", 1.0, 0.0, 0.0)

    return one(resting(0.1), answers, r"bearing capacity is exceeded")


@stress_case(cpu=120)
def all_soil_yielding() -> Trial:
    """A pipe pressed 0.25 D into clay between walls a diameter away: all of it flows. No stress beyond the strength; at
    least (2 + pi) su on the chord, less a fifth for cells of D/8 that leave the pipe; what the supports push is what
    the clay bears.
    """
    scene = deepcopy(slice_of_soil(8))
    scene["soil"]["block"] |= {"y": [-1.0, 1.0], "depth": 0.5}
    scene["soil"]["mesh"]["size_far"] = 0.125
    scene["soil"]["law"] = {"kind": "von-mises", "su": 5e3, "E_over_su": 300.0, "nu": 0.49}
    scene["stages"] = [{"name": "push", "kind": "static", "move": _down(0.25 * D)}]
    scene["solver"] = {"load_steps": 30}

    def answers(run: Run) -> Iterator[Answer]:
        chord = 2.0 * np.sqrt(0.25 * 0.75) * D
        yield between("resistance over su D [-]", resistance(run) / (5e3 * D), 0.8 * (2.0 + np.pi) * chord / D, 9.14)
        used = run.summary["stages"][0]["soil"]["max_strength_used"]["value"]
        yield between("most of the strength used [-]", used, 0.99, 1.001)

    return one(scene, answers)


def _down(depth: float) -> Mapping:
    return {end: [x, 0.0, 0.5 * D - depth] for end, x in (("start", 0.0), ("end", 1.0))}
