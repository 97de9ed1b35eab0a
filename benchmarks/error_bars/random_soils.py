"""Random scenes on soil: pipes, shapes, clays, cells and motions are drawn from a seed.

Steel and flexible pipes come down on soil in sections, or in a block, and lie there; some are heaved then. Short pipes
are pressed into a slice, of which some are lifted again. Soil is elastic, plastic or cyclic, and as strong as the
pipe's weight asks for: from hardly any yield to an embedment of a third of the diameter. Cells are automatic, or as an
engineer might take them: a third to a sixteenth of the diameter. The same seed, kind and number give the same scene
everywhere.
"""

from __future__ import annotations

import math
from typing import Any

from benchmarks.error_bars.random_risers import SEA, Draw, figures, some_pipe, spread, submerged_weight
from benchmarks.error_bars.scenes import HANG, SURFACE, Mapping, even, line

LAWS = ("linear-elastic", "von-mises", "von-mises", "kinematic-hardening", "iwan")
#: Scenes of each kind, as far as they have references; even and odd numbers are judged apart.
KINDS = {"laid on sections": 16, "heaved on sections": 8, "laid on a block": 3, "pressed into a slice": 8}
#: Numbers of those of another seed, which have chosen nothing: such whose references cost minutes at most.
UNSEEN = {"laid on sections": (1, 2, 4, 5, 8, 9), "heaved on sections": (5, 7), "laid on a block": (3,)}
UNSEEN |= {"pressed into a slice": (3, 7)}


def random_soil(seed: int, kind: str, number: int) -> Mapping:
    """A scene of one of `KINDS`."""
    draw = Draw(f"{seed} {kind} {number}")
    pipe = some_pipe(draw)
    law = _law(draw, LAWS[number // 2 % len(LAWS)], pipe)
    if kind == "pressed into a slice":
        return _pressed(draw, pipe, law)
    model = "block" if kind == "laid on a block" else "sections"
    return _laid(draw, pipe, law, model, heaved=kind == "heaved on sections")


def _law(draw: Draw, kind: str, pipe: Mapping) -> Mapping:
    """Clay in which the weight is 0.3 to 2.5 times su D, or soil as stiff as such clay."""
    D = pipe["outer_diameter"]
    su = figures(min(max(submerged_weight(pipe) / (spread(draw, 0.3, 2.5) * D), 500.0), 2.0e4))
    stiff = spread(draw, 100.0, 500.0)
    if kind == "linear-elastic":
        return {"kind": kind, "E": figures(stiff * su), "nu": 0.45}
    gradient = figures(draw.choice([0.0, spread(draw, 0.1, 2.0)]) * su)
    law: Mapping = {"kind": kind, "su": su, "su_gradient": gradient, "E_over_su": stiff}
    return law | ({"elastic_share": 0.1} if kind == "kinematic-hardening" else {})


def _laid(draw: Draw, pipe: Mapping, law: Mapping, model: str, heaved: bool) -> Mapping:
    """The catenary of a slope at its upper end, its lower end on springs, soil where it touches down."""
    D, w, EI = pipe["outer_diameter"], submerged_weight(pipe), pipe["EI"]
    slope = math.radians(draw.uniform(50.0, 80.0))
    depth = (EI / w) ** (1.0 / 3.0) * spread(draw, 6.0, 20.0)
    a, bears = depth / (1.0 / math.cos(slope) - 1.0), bending_on(law, EI)
    bends = math.sqrt(EI / (w * a))  # with the tension w a
    lying = 3.0 * bends + 12.0 * bears + 10.0 * D
    along = [figures(lying - bends - 3.0 * bears - 2.0 * D), figures(lying + bears)]
    half = figures(spread(draw, 4.0, 8.0) * D)
    soil = {"model": model, "block": {"x": along, "y": [-half, half], "depth": half}, "law": law}
    soil["mesh"] = _cells(draw, D, bears, half, heaved or model == "block")
    hangs = a * math.tan(slope)
    segments = _graded(draw, along[1], figures(hangs - bears), bears, hangs)
    ends = [0.0, 0.0, 0.5 * D], [figures(lying + a * math.asinh(math.tan(slope))), 0.0, figures(depth)]
    more: Mapping = {"seabed": {"kind": "spring", "stiffness": figures(w / (0.03 * D))}, "contact": SURFACE}
    more |= {"water": {"density": SEA}, "dimension": 2}
    return line(pipe, *ends, segments, [HANG, *([_heave(draw)] if heaved else [])], soil=soil, **more)


def _graded(draw: Draw, lower: float, upper: float, bears: float, hangs: float) -> list[Mapping]:
    """Elements that resolve how soil bends the pipe, and grow to a twentieth of the length that hangs."""
    size = figures(spread(draw, 0.4, 0.8) * bears)
    longest = figures(max(0.05 * hangs, 2.0 * size))
    return [{"length": lower, "element_length": size}, {"length": upper, "element_length": [size, longest]}]


def bending_on(law: Mapping, EI: float) -> float:
    """Length over which soil bends a pipe [m]: of a beam on springs as stiff as E at the surface."""
    E = law["E"] if "E" in law else law["E_over_su"] * law["su"]
    return float((4.0 * EI / E) ** 0.25)


def _cells(draw: Draw, D: float, bears: float, depth: float, dear: bool) -> Any:
    """Automatic, or a third to a twelfth of the diameter. dear: of a block or a motion, where fine ones cost too
    much.
    """
    if not dear and draw.random() < 0.4:
        return "auto"
    across = figures(D / spread(draw, 3.0, 7.0 if dear else 12.0))
    along = figures(spread(draw, 0.6, 1.1) * bears)
    sizes = {"along": along, "across": across, "strip": figures(spread(draw, 1.0, 2.0) * D)}
    return {"kind": "hex", "size_at_riser": sizes, "size_far": figures(max(0.5 * depth, across))}


def _heave(draw: Draw) -> Mapping:
    """A period of the upper end."""
    period, steps = spread(draw, 6.0, 14.0), round(spread(draw, 30.0, 50.0))
    size = figures(spread(draw, 0.05, 0.5) * period / (2.0 * math.pi))  # by its largest velocity [m/s]
    heave = {"amplitude": [0.0, 0.0, size], "period": period, "ramp": 0.5 * period}
    motion: Mapping = {"name": "heave", "kind": "dynamic", "duration": period, "time_step": period / steps}
    return motion | {"motion": {"end": {"harmonic": heave}}}


def _pressed(draw: Draw, pipe: Mapping, law: Mapping) -> Mapping:
    """A short stiff length, pressed by its ends into a slice, and in half of all scenes lifted a little."""
    D = pipe["outer_diameter"]
    depth, size = figures(spread(draw, 0.02, 0.3) * D), D / spread(draw, 4.0, 16.0)
    ends = [{"position": [x, 0.0, 0.5 * D], "rotation": "fixed"} for x in (0.0, D)]
    down, up = ({"start": [0.0, 0.0, z], "end": [D, 0.0, z]} for z in (0.5 * D - depth, 0.5 * D - 0.9 * depth))
    stages = [HANG | {"move": down}, *([HANG | {"name": "lift", "move": up}] if draw.random() < 0.5 else [])]
    half = figures(spread(draw, 3.0, 6.0) * D)
    block = {"x": [0.4 * D, 0.6 * D], "y": [-half, half], "depth": half}
    sizes = {"along": D, "across": figures(size), "strip": figures(1.5 * D + depth)}
    mesh = {"kind": "hex", "size_at_riser": sizes, "size_far": figures(max(0.3 * half, size))}
    stiff = pipe | {"EI": figures(1.0e3 * law.get("E", 300.0 * law.get("su", 1.0)) * D**4), "EA": 2.0e7}
    more: Mapping = {"contact": SURFACE, "water": {"density": SEA}, "dimension": 2, "riser": {"initial": "straight"}}
    return line(stiff, ends[0], ends[1], even(D, 4), stages, soil={"block": block, "mesh": mesh, "law": law}, **more)


def _drawn(seed: int, half: int) -> dict[str, Mapping]:
    return {f"{kind} {n}": random_soil(seed, kind, n) for kind, count in KINDS.items() for n in range(half, count, 2)}


EVEN, ODD = (_drawn(4, half) for half in (0, 1))
NEW = {f"unseen, {kind} {n}": random_soil(5, kind, n) for kind, numbers in UNSEEN.items() for n in numbers}
SOILS = EVEN | ODD | NEW
