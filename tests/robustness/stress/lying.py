"""Stress cases of lines at rest on the ground: penalties, slopes, friction, sizes from millimetres to thousands of
km.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer, between, near
from tests.robustness.stress.case import Trial, one, stress_case
from tests.robustness.stress.closed_forms import landed
from tests.support.scenes import Mapping, prescribed, riser_scene, static

W, EA, SPAN, HEIGHT, LENGTH = 500.0, 1e8, 110.0, 50.0, 130.0


def on_floor(k: float | str, s: float = 1.0, **more: object) -> Mapping:
    """130 m of cable, 50 m of water: its start lies on a rigid floor of stiffness k at z = 0, its end hangs 110 m away.

    All lengths times s, forces with s^3, forces per length with s^2, k with s, EI with s^5.
    """
    options: Mapping = {"gravity": 9.81, "elements": 260, "seabed": {"kind": "rigid", "contact_at": "axis"}} | more
    stiffness = {"smoothing": 0.0, "stiffness": k * s} if isinstance(k, float) else {}
    return riser_scene(
        static(),
        pipe={"EA": EA * s**3, "EI": 10.0 * s**5, "submerged_weight": W * s**2, "outer_diameter": 0.2 * s},
        length=LENGTH * s,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(SPAN * s, 0.0, HEIGHT * s),
        contact=stiffness,
        **options,
    )


def catenary(s: float = 1.0, rel: float = 2e-3, sinks: float = 0.0) -> Callable[[Run], Iterator[Answer]]:
    """Answers of `on_floor`; the touchdown point to EI's layer, (EI/H)^0.5 = 0.02 m, and an element.

    sinks: w/k, how deep the line rests [m]. On springs a cable leaves the ground with the slope sinks/l, l =
    (H/k)^0.5, as z = sinks (exp(x/l) - 1); a catenary of a = H/w has fallen by the height a slope^2/2 = sinks/2 where
    it is level: so H is that over a rigid floor which lies so much lower. The length changes by sinks^2/l, 3e-5 of it
    at most.
    """

    def answers(run: Run) -> Iterator[Answer]:
        exact = landed(SPAN, HEIGHT + 0.5 * sinks, LENGTH, W, EA)
        final = run.summary["stages"][-1]["final"]
        yield near("H over s^3 [N]", final["end"]["force"][0] / s**3, exact.H, rel=rel)
        yield near("top tension over s^3 [N]", final["end"]["effective_tension"] / s**3, exact.T_end, rel=rel)
        yield near("touchdown arc over s [m]", final["touchdown_arc"] / s, exact.touchdown, within=0.5)

    return answers


def penalty(power: int) -> Callable[[], Trial]:
    def make() -> Trial:
        return one(on_floor(10.0**power), catenary(sinks=W / 10.0**power))

    make.__doc__ = (
        f"Contact stiffness 1e{power} N/m2: the line rests {W / 10.0**power:.2g} m deep: the elastic catenary that "
        "comes down on a floor half as deep."
    )
    return make


for power in (4, 6, 8, 10, 12):
    stress_case(name=f"penalty_of_1e{power}", quick=power == 10)(penalty(power))


def sized(s: float) -> Callable[[], Trial]:
    def make() -> Trial:
        return one(on_floor("auto", s), catenary(s, rel=5e-3))

    make.__doc__ = f"A line on a rigid floor times {s:g} in length, automatic contact: the same catenary."
    return make


for s in (1e-6, 1e-3, 1.0, 1e3, 1e6):
    stress_case(name=f"line_on_a_floor_times_{s:g}", quick=s == 1e-3)(sized(s))


def on_slope(mu: float | None) -> Mapping:
    """100 m of pipe lie down a rigid slope of 45 degrees, held at the upper end."""
    down = np.sqrt(0.5) * 100.0
    friction = {} if mu is None else {"friction": {"axial": mu}}
    return riser_scene(
        static(),
        pipe={"EA": EA, "EI": 1e4, "submerged_weight": W, "outer_diameter": 0.2},
        length=100.0,
        elements=50,
        start=prescribed(0.0, 0.0, 0.0),
        end="free",
        gravity=9.81,
        seabed={"kind": "rigid", "slope_deg": -45.0, "contact_at": "axis"},
        contact={"stiffness": 1e6} | friction,
        riser={"initial": {"points": [[0.0, 0.0, 0.0], [down, 0.0, -down]]}},
    )


@stress_case()
def slope_of_45_degrees() -> Trial:
    """Without friction the upper end bears w L sin 45 = 35.36 kN along the slope, the ground w L cos 45 across it."""

    def answers(run: Run) -> Iterator[Answer]:
        share = 100.0 * W * np.sqrt(0.5)
        yield near("tension at the upper end [N]", run["effective_tension"][-1, 0], share, rel=2e-3)
        ground = np.linalg.norm(run["contact_force_sum"][-1])
        yield near("contact force [N]", float(ground), share, rel=5e-3)  # the support bears w cos 45 times 0.23 m

    return one(on_slope(None), answers)


@stress_case()
def slope_of_45_degrees_with_friction() -> Trial:
    """With mu = 0.5 the upper end bears between (sin 45 - mu cos 45) w L = 17.7 kN, all friction being mobilised, and
    all of w L sin 45.
    """

    def answers(run: Run) -> Iterator[Answer]:
        share = 100.0 * W * np.sqrt(0.5)
        tension = run["effective_tension"][-1, 0]
        yield between("tension at the upper end [N]", tension, 0.5 * share * (1.0 - 1e-3), share)

    return one(on_slope(0.5), answers)
