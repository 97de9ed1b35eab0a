"""Scenes on which error bars are calibrated: small ones of all kinds, each computed in seconds, as mappings by name."""

from __future__ import annotations

from typing import Any

Mapping = dict[str, Any]

FLEXIBLE: Mapping = {"outer_diameter": 0.3, "inner_diameter": 0.2, "mass": 120.0, "EA": 3.0e8, "EI": 5.0e4}
FLEXIBLE |= {"GJ": 4.0e4, "drag": {"normal": 1.1, "tangential": 0.05}, "added_mass": {"normal": 1.0}}
STEEL: Mapping = {"outer_diameter": 0.27, "inner_diameter": 0.22, "mass": 150.0, "EA": 4.0e9, "EI": 3.0e7}
STEEL |= {"GJ": 2.3e7, "drag": {"normal": 1.0}, "added_mass": {"normal": 1.0}}
HOSE: Mapping = {"outer_diameter": 0.15, "mass": 33.113, "submerged_weight": 147.1, "EA": 1.0e6, "EI": 1.0e3}
HOSE |= {"drag": {"normal": 1.2}, "added_mass": {"normal": 1.0}}
BEAM: Mapping = {"outer_diameter": 0.2, "mass": 50.0, "EA": 1.0e8, "EI": 5.0e5}
WATER: Mapping = {"density": 1025.0}
CLAY: Mapping = {"kind": "von-mises", "su": 2.0e3, "su_gradient": 1.5e3, "E_over_su": 300.0, "nu": 0.49}
CYCLIC: Mapping = CLAY | {"kind": "kinematic-hardening", "elastic_share": 0.1}
ELASTIC: Mapping = {"kind": "linear-elastic", "E": 1.2e6, "nu": 0.45}
SURFACE: Mapping = {"method": "surface"}
HANG: Mapping = {"name": "hang", "kind": "static"}


def line(pipe: Mapping, start: Any, end: Any, segments: list[Mapping], stages: list[Mapping], **more: Any) -> Mapping:
    """A riser between two places, each [x, y, z] or a whole support; lengths and elements of its segments."""
    ends = {"start": _support(start), "end": _support(end)}
    cut = [{"line_type": "pipe"} | segment for segment in segments]
    riser = {"segments": cut} | ends | more.pop("riser", {})
    return {"line_types": {"pipe": pipe}, "riser": riser, "stages": stages} | more


def _support(place: Any) -> Any:
    return {"position": place} if isinstance(place, list) else place


def even(length: float, elements: int) -> list[Mapping]:
    return [{"length": length, "elements": elements}]


def moved(amplitude: list[float], period: float, periods: float, steps: float) -> Mapping:
    """The end moves harmonically; steps: to a period."""
    harmonic = {"amplitude": amplitude, "period": period, "ramp": period}
    stage: Mapping = {"name": "motion", "kind": "dynamic", "duration": periods * period, "time_step": period / steps}
    return stage | {"motion": {"end": {"harmonic": harmonic}}}


def freely(duration: float, steps: int, **more: Any) -> Mapping:
    return {"name": "motion", "kind": "dynamic", "duration": duration, "time_step": duration / steps} | more


def hanging(elements: int, span: float, *stages: Mapping, EI: float = 2.096e4, **more: Any) -> Mapping:
    """The published 350 m riser, hung over another span."""
    pipe = FLEXIBLE | {"outer_diameter": 0.26, "mass": 57.5, "EA": 1.538e9, "EI": EI}
    more = {"water": WATER} | more
    contents = {"contents": {"density": 1025.0}}
    ends = [0.0, 0.0, 0.0], [span, 0.0, 150.0]
    return line(pipe, *ends, even(350.0, elements), [HANG, *stages], riser=contents, **more)


def touching(seabed: Mapping, size: float, *stages: Mapping, pipe: Mapping = FLEXIBLE, **more: Any) -> Mapping:
    """A flexible riser that comes down from 100 m; size: of the elements at the touchdown point [m]."""
    segments: list[Mapping] = [{"length": 50.0, "element_length": size}]
    segments.append({"length": 98.0, "element_length": [size, 4.0 * size]})
    ends = [0.0, 0.0, 0.15], [80.0, 0.0, 100.0]
    contents = {"contents": {"density": 850.0}}
    return line(pipe, *ends, segments, [HANG, *stages], seabed=seabed, water=WATER, riser=contents, **more)


def hose(elements: int, *stages: Mapping, **more: Any) -> Mapping:
    """A hose in a tank, on a rigid floor."""
    floor = {"kind": "rigid", "contact_at": "axis"}
    more = {"contact": {"stiffness": 1.0e5}} | more
    ends = [0.0, 0.0, 0.0], [28.0, 0.0, 15.0]
    return line(HOSE, *ends, even(40.0, elements), [HANG, *stages], seabed=floor, water=WATER, **more)


def pressed(law: Mapping, cells: int, depth: float, contact: Mapping = SURFACE, lifted: float = 0.0) -> Mapping:
    """A short stiff pipe, pressed by its ends into a slice of soil, then lifted a little; m. cells: to its diameter."""
    pipe = {"outer_diameter": 0.3, "submerged_weight": 500.0, "mass": 120.0, "EA": 1.0e10, "EI": 1.0e7}
    ends = [{"position": [x, 0.0, 0.15], "rotation": "fixed"} for x in (0.0, 0.3)]
    down, up = ({"start": [0.0, 0.0, z], "end": [0.3, 0.0, z]} for z in (0.15 - depth, 0.15 - depth + lifted))
    stages = [HANG | {"move": down}, *([HANG | {"name": "lift", "move": up}] if lifted else [])]
    more: Mapping = {"contact": contact, "dimension": 2, "riser": {"initial": "straight"}}
    return line(pipe, ends[0], ends[1], even(0.3, 8), stages, soil=slice_of(law, cells, 0.15, 0.04), **more)


def slice_of(law: Mapping, cells: int, at: float, thickness: float) -> Mapping:
    """A slice of soil, one cell thick, under a pipe of 0.3 m along x."""
    block = {"x": [at - 0.5 * thickness, at + 0.5 * thickness], "y": [-1.2, 1.2], "depth": 1.2}
    size = {"along": 5.0 * thickness, "across": 0.3 / cells, "strip": 0.3}
    return {"block": block, "mesh": {"size_at_riser": size, "size_far": 0.3}, "law": law}


def resting(law: Mapping, weight: float, thickness: float, contact: Mapping = SURFACE) -> Mapping:
    """A pipe between hinges sags by its weight [N/m] onto a slice of soil under its middle."""
    pipe = {"outer_diameter": 0.3, "submerged_weight": weight, "mass": 120.0, "EA": 1.0e6, "EI": 5.0e4}
    ends, soil = ([0.0, 0.0, 0.148], [6.0, 0.0, 0.148]), slice_of(law, 12, 3.0, thickness)
    straight: Mapping = {"dimension": 2, "riser": {"initial": "straight"}}
    return line(pipe, *ends, even(6.0, 24), [HANG], soil=soil, contact=contact, **straight)


def cantilever(elements: int, *stages: Mapping, **more: Any) -> Mapping:
    """A beam of 10 m along x, clamped at its start, without weight."""
    clamped = {"position": [0.0, 0.0, 0.0], "rotation": "fixed"}
    more = {"gravity": 0.0} | more
    return line(BEAM, clamped, "free", even(10.0, elements), list(stages), **more)


def loaded(name: str = "load", **load: Any) -> Mapping:
    return {"name": name, "kind": "static", "loads": [load]}


def tensioned(elements: int, *stages: Mapping, tension: float, **more: Any) -> Mapping:
    """A beam of 30 m along x with clamped ends, drawn to a tension [N], then loaded by its weight."""
    ends = [{"position": [x, 0.0, 0.0], "rotation": "fixed"} for x in (0.0, 30.0 * (1.0 + tension / BEAM["EA"]))]
    return line(BEAM, ends[0], ends[1], even(30.0, elements), list(stages), riser={"initial": "straight"}, **more)


RIGID, SPRING = {"kind": "rigid"}, {"kind": "spring", "stiffness": 1.0e5}
CLAY_SPRINGS = {"kind": "hysteretic", "law": {"kind": "randolph-quiggin", "su": 2.0e3, "su_gradient": 1.5e3}}
SUCTION_SPRINGS = {"kind": "hysteretic", "law": {"kind": "aubeny-biscontin", "su": 2.0e3, "su_gradient": 1.5e3}}
WAVES: Mapping = {"density": 1025.0, "surface_level": 160.0, "depth": 160.0}
WAVES |= {"waves": {"airy": {"height": 6.0, "period": 10.0}, "ramp": 10.0}}

SCENES: dict[str, Mapping] = {
    "catenary, 20 elements": hanging(20, 150.0),
    "catenary, 35 elements": hanging(35, 150.0),
    "catenary, 80 elements": hanging(80, 150.0),
    "slack catenary": hanging(50, 60.0),
    "taut catenary": hanging(30, 310.0),
    "limp catenary": hanging(60, 150.0, EI=2.0e3),
    "stiff catenary": hanging(16, 150.0, EI=2.0e6),
    "steel catenary": line(
        STEEL, [0.0, 0.0, 0.0], [500.0, 0.0, 300.0], even(650.0, 40), [HANG], water=WATER
    ),
    "clamped catenary": line(
        FLEXIBLE, [0.0, 0.0, 0.0], {"position": [60.0, 0.0, 60.0], "rotation": {"stiffness": 5.0e4}}, even(110.0, 44),
        [HANG], water=WATER,
    ),
    "catenary in a current across": hanging(
        30, 150.0, dimension=3, water=WATER | {"current": {"profile": [[0.0, 0.1, 0.3], [150.0, 0.2, 1.0]]}},
    ),
    "cantilever, tip load": cantilever(4, loaded(at="end", force=[0.0, 0.0, -3.0e4])),
    "cantilever, large tip load": cantilever(8, loaded(at="end", force=[0.0, 0.0, -5.0e4])),
    "cantilever, even load": cantilever(5, loaded(distributed=[0.0, 0.0, -4.0e3])),
    "cantilever, tip moment and force": cantilever(
        6, loaded(at="end", moment=[0.0, 1.0e5, 0.0], force=[0.0, 0.0, -1.0e4])
    ),
    "cantilever in space": cantilever(
        6, loaded(at="end", force=[0.0, 2.0e4, -2.0e4]), dimension=3, line_types={"pipe": BEAM | {"GJ": 4.0e5}},
    ),
    "beam under tension, resolved": tensioned(40, HANG, tension=1.0e5),
    "beam under tension, coarse": tensioned(10, HANG, tension=1.0e6),
    "beam under tension, unresolved": tensioned(6, HANG, tension=4.0e6),
    "on springs, coarse": touching(SPRING, 2.0),
    "on springs": touching(SPRING, 1.0),
    "on springs, fine": touching(SPRING, 0.5),
    "on hard springs": touching({"kind": "spring", "stiffness": 1.0e6}, 1.0),
    "on a rigid floor": touching(RIGID, 1.0, contact={"stiffness": 1.0e5}),
    "on a rigid floor, soft penalty": touching(RIGID, 1.0, contact={"stiffness": 1.0e4}),
    "hose on a rigid floor": hose(80),
    "on clay springs": touching(CLAY_SPRINGS, 1.0),
    "on clay springs with suction": touching(SUCTION_SPRINGS, 1.0),
    "on sloping springs": touching(SPRING | {"slope_deg": 5.0}, 1.0),
    "lazy wave": line(
        FLEXIBLE, [0.0, 0.0, 0.15], [110.0, 0.0, 80.0],
        [{"length": 70.0, "element_length": 1.5},
         {"length": 20.0, "element_length": 2.0, "line_type": "buoyant"}, {"length": 70.0, "element_length": 2.0}],
        [HANG], seabed=SPRING, water=WATER,
        line_types={"pipe": FLEXIBLE, "buoyant": FLEXIBLE | {"outer_diameter": 0.55, "mass": 165.0}},
    ),
    "cantilever let go": cantilever(
        6, loaded(at="end", force=[0.0, 0.0, -2.0e3]) | {"name": "hold"}, freely(1.5, 150),
    ),
    "cantilever under a sudden load": cantilever(
        5, freely(1.5, 100, loads=[{"at": "end", "force": [0.0, 0.0, -2.0e3]}]),
    ),
    "beam under tension, sudden load": tensioned(
        20, HANG, freely(1.5, 150, loads=[{"distributed": [0.0, 0.0, -500.0]}]), tension=1.0e6,
    ),
    "surge, 40 steps": hanging(35, 150.0, moved([2.0, 0.0, 0.0], 14.0, 2.5, 40)),
    "surge, 140 steps": hanging(35, 150.0, moved([2.0, 0.0, 0.0], 14.0, 2.5, 140)),
    "heave, 40 steps": hanging(30, 150.0, moved([0.0, 0.0, 3.0], 10.0, 2.5, 40)),
    "heave, 80 steps, slack": hanging(40, 80.0, moved([0.0, 0.0, 2.0], 8.0, 2.5, 80)),
    "fast surge": hanging(40, 150.0, moved([2.0, 0.0, 0.0], 6.0, 3.0, 60)),
    "taut line in surge": hanging(30, 305.0, moved([0.5, 0.0, 0.0], 10.0, 2.5, 80)),
    "surge across": hanging(24, 150.0, moved([0.0, 3.0, 0.0], 12.0, 2.0, 60), dimension=3),
    "waves": hanging(40, 150.0, freely(25.0, 125), water=WAVES),
    "waves and surge, automatic steps": hanging(
        40, 150.0, moved([1.0, 0.0, 1.0], 10.0, 2.0, 50) | {"time_step": "auto", "tolerance": 2.0e-3}, water=WAVES,
    ),
    "heave on springs, 50 steps": touching(SPRING, 1.0, moved([0.0, 0.0, 1.5], 10.0, 2.0, 50)),
    "heave on springs, 100 steps": touching(SPRING, 1.0, moved([0.0, 0.0, 1.5], 10.0, 2.0, 100)),
    "surge and heave on springs": touching(SPRING, 1.0, moved([1.0, 0.0, 1.0], 8.0, 2.0, 80)),
    "violent heave on springs": touching(SPRING, 1.0, moved([0.0, 0.0, 3.0], 6.0, 2.0, 120)),
    "heave on a rigid floor": touching(
        RIGID, 1.0, moved([0.0, 0.0, 1.5], 10.0, 2.0, 80), contact={"stiffness": 1.0e5}
    ),
    "hose swings on a rigid floor": hose(80, moved([1.5, 0.0, 0.5], 10.0, 2.0, 100)),
    "heave on clay springs": touching(CLAY_SPRINGS, 1.0, moved([0.0, 0.0, 1.0], 8.0, 2.0, 80)),
    "heave on clay springs with suction": touching(SUCTION_SPRINGS, 1.0, moved([0.0, 0.0, 1.0], 8.0, 2.0, 80)),
    "pipe pressed on elastic soil": pressed(ELASTIC, 12, 0.006),
    "pipe pressed on elastic soil that slides": pressed(ELASTIC, 24, 0.006, SURFACE),
    "pipe pressed on clay": pressed(CLAY, 12, 0.02),
    "pipe pressed on clay that slides": pressed(CLAY, 14, 0.012, SURFACE),
    "pipe pressed on cyclic clay and lifted": pressed(CYCLIC, 10, 0.015, lifted=0.0005),
    "pipe rests on elastic soil": resting(ELASTIC, 300.0, 0.1),
    "pipe rests on clay": resting(CLAY, 200.0, 0.5, SURFACE),
    "pipe rests on clay that slides": resting(CLAY, 120.0, 0.8),
}  # fmt: skip
