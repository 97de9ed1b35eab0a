"""Scenes of one line as mappings: its pieces, a line by arguments, and the scenes that several tests share.

- pieces: `static`, `dynamic`, `quasi_static` and `heave` make stages, `prescribed` an end, `line` a line, `block` soil;
- a line on any ground, in any water: `riser_scene`; straight and level: `level_pipe`;
- in air: `column`, `blade`, `frame`, `turned_bar`; in water: `in_waves`, `in_water`, `below_vessel`, `end_led_around`;
- on a seabed: `ON_SEABED`, and pipes that fall: `pinned`, `flat`, `tilted`;
- on soil: `touchdown`, `lying_pipe`, `falling_on_soil`.

`line_scenes` has several lines and bodies.
"""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene

Mapping = dict[str, Any]

DEMO = Path(__file__).parents[2] / "demos" / "touchdown_clay" / "scene.yaml"
ON_BLOCK = Path(__file__).parents[1] / "scenes" / "touchdown_on_block.yaml"

AVERAGE = {"newmark": {"beta": 0.25, "gamma": 0.5}}
ELASTIC: Mapping = {"kind": "linear-elastic", "E": 1.2e6, "nu": 0.49}
CLAY: Mapping = {"kind": "von-mises", "su": 4.0e3, "E_over_su": 300.0, "nu": 0.49}


# Pieces


def static(name: str = "static", **more: Any) -> Mapping:
    return {"name": name, "kind": "static", **more}


def dynamic(duration: float, time_step: float, name: str = "dynamic", **more: Any) -> Mapping:
    return {"name": name, "kind": "dynamic", "duration": duration, "time_step": time_step, **more}


def quasi_static(duration: float, name: str = "quasi-static", **more: Any) -> Mapping:
    return {"name": name, "kind": "quasi-static", "duration": duration, **more}


LAY = static("lay")


def heave(duration: float, time_step: float = 0.1, amplitude: float = 0.3) -> Mapping:
    """A dynamic stage in which the upper end moves up and down [m] with a period of 3 s."""
    harmonic = {"amplitude": [0.0, 0.0, amplitude], "period": 3.0, "ramp": 1.5}
    return dynamic(duration, time_step, "heave", motion={"end": {"harmonic": harmonic}})


def prescribed(*position: float, rotation: Any = "free") -> Mapping:
    return {"position": list(position), "rotation": rotation}


def line(line_type: str, length: float, elements: int, start: Any, end: Any, **more: Any) -> Mapping:
    """A line of one type in equal elements; more: its other keys."""
    return {
        "segments": [{"line_type": line_type, "length": length, "elements": elements}],
        "start": start,
        "end": end,
        **more,
    }


def block(
    law: Mapping, x: tuple[float, float], half_width: float, depth: float, mesh: Mapping | str, /, **more: Any
) -> Mapping:
    """Soil under a line along x, as far to either side; more: its other keys, or others in the place of these."""
    around = {"x": list(x), "y": [-half_width, half_width], "depth": depth}
    return {"block": around, "mesh": mesh, "law": dict(law), **more}


def cells(size_at_riser: Any, size_far: float, kind: str = "hex") -> Mapping:
    """A mesh by the sizes of its cells [m]."""
    return {"kind": kind, "size_at_riser": size_at_riser, "size_far": size_far}


def overlaid(base: Any, piece: Any) -> Any:
    """A mapping with another laid over it, key by key."""
    if not isinstance(base, dict) or not isinstance(piece, dict):
        return piece
    return base | {key: overlaid(base.get(key), value) for key, value in piece.items()}


# A line by arguments


def riser_scene(
    *stages: Mapping,
    pipe: Mapping,
    length: float,
    elements: int,
    start: Any,
    end: Any,
    line_type: Any = "pipe",
    **more: Any,
) -> Mapping:
    """A riser of one line type, without gravity and in space or a plane as its ends move, unless `more` says otherwise.

    more: sections of the scene; riser: other keys of the riser.
    """
    riser = line(line_type, length, elements, start, end) | more.pop("riser", {})
    scene: Mapping = {"title": "A riser", "gravity": 0.0, "line_types": {line_type: dict(pipe)}}
    scene |= {"riser": riser, "stages": list(stages)} | deepcopy(more)
    return scene


def level_pipe(
    *stages: Mapping,
    pipe: Mapping,
    length: float,
    elements: int,
    height: float,
    rotation: Any = "fixed",
    initial: Any = "straight",
    **more: Any,
) -> Mapping:
    """A straight pipe in a plane, from the origin along x at a height [m]; more: sections of the scene."""
    ends = {end: prescribed(x, 0.0, height, rotation=rotation) for end, x in (("start", 0.0), ("end", length))}
    riser, sections = {"initial": initial}, {"gravity": 9.81, "dimension": 2} | more
    return riser_scene(*stages, pipe=pipe, length=length, elements=elements, riser=riser, **ends, **sections)


def pushed_to(length: float, height: float) -> Mapping:
    """A static stage that moves a level pipe, so long, to a height [m]."""
    return static("push", move={"start": [0.0, 0.0, height], "end": [length, 0.0, height]})


# In air

EULER = 0.25 * np.pi**2  # of a cantilever of unit length and bending stiffness
ALONG, SLANTING = (1.0, 0.0, 0.0), (0.6, 0.0, 0.8)


def cantilever(load: list[float], points: list[list[float]], pipe: Mapping, elements: int, dimension: int) -> Mapping:
    """Clamped at its start, unstressed along points, with a force at its free end."""
    return riser_scene(
        static(loads=[{"at": "end", "force": load}]),
        pipe=pipe,
        length=float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()),
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        riser={"unstressed": {"points": points}},
        dimension=dimension,
    )


def column(elements: int, ratio: float, EA: float = 1e7, dimension: int = 2, axis: Any = ALONG) -> Mapping:
    """A straight cantilever without weight or imperfection, pushed along its axis by `ratio` times Euler's load."""
    pipe = {"EA": EA, "EI": 1.0, "GJ": 1.0}
    return cantilever([-ratio * EULER * a for a in axis], [[0.0, 0.0, 0.0], list(axis)], pipe, elements, dimension)


def blade(elements: int, force: float) -> Mapping:
    """The cantilever blade of `test_space_beams`, loaded across its deep section at the tip."""
    pipe = {"EA": 1e5, "EI_y": 1e3, "EI_z": 1.0, "GJ": 0.5}
    return cantilever([0.0, 0.0, -force], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], pipe, elements, 3)


def frame(elements: int, force: float, across: float = 0.0) -> Mapping:
    """The right-angle frame of `test_space_beams`, N and mm, its joint bent within the two elements beside it.

    force: in its plane, positive pulls the clamped leg; across: out of it.
    """
    soft, deep = 71240.0 * 30.0 * 0.6**3 / 12.0, 71240.0 * 0.6 * 30.0**3 / 12.0
    pipe = {"EA": 71240.0 * 18.0, "EI_y": deep, "EI_z": soft, "GJ": 71240.0 / 2.62 * 30.0 * 0.6**3 / 3.0}
    points = [[0.0, 0.0, 0.0], [240.0, 0.0, 0.0], [240.0, 0.0, -240.0]]
    return cantilever([force, across, 0.0], points, pipe, elements, 3)


def turned_bar(turns: int, dt: float = 0.01, rest: float = 1.0, **more: Any) -> Mapping:
    """A clamped bar of 1 m whose support turns in steps of dt [s] for 20 s and rests for some time [s]; more: of the
    first stage.
    """
    turn = {"axis": [0.0, 1.0, 0.0], "amplitude_deg": 360.0 * turns, "period": 80.0, "ramp": 20.0}
    return riser_scene(
        dynamic(20.0, dt, "turn", motion={"start": {"rotation": turn}}, **more),
        dynamic(rest, 0.01, "rest"),
        pipe={"EA": 1e6, "EI": 1e3, "mass": 1.0, "damping": {"ratio": 0.05, "frequency": 5.0}},
        length=1.0,
        elements=10,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        riser={"unstressed": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]}},
        output={"interval": 0.1},
    )


# In water

PIPE: Mapping = {"outer_diameter": 0.3, "mass": 120.0, "EA": 3.0e8, "EI": 5.0e4, "GJ": 4.0e4}

IN_WAVES: Mapping = {"EA": 1.0e6, "EI": 2.0e3, "outer_diameter": 0.3, "mass": 120.0}
IN_WAVES |= {"drag": {"normal": 1.1, "tangential": 0.05}, "added_mass": {"normal": 1.0, "tangential": 0.2}}


def in_waves(time_step: float, top: float, rho_inf: float = 0.8) -> Mapping:
    """A hanging riser in waves and a sheared current, its top at a height below or above the surface at 20 m."""
    water: Mapping = {"surface_level": 20.0, "depth": 60.0}
    water |= {"current": {"profile": [[0.0, 0.1, 0.0], [20.0, 0.8, 0.0]]}}
    water |= {"waves": {"airy": {"height": 2.0, "period": 5.0}, "ramp": 2.0}}
    return riser_scene(
        static("hang"),
        dynamic(4.0, time_step, scheme={"generalized_alpha": {"rho_inf": rho_inf}}),
        pipe=IN_WAVES,
        length=26.0,
        elements=8,
        start=prescribed(0.0, 0.0, 3.0),
        end=prescribed(14.0, 0.0, top),
        water=water,
        gravity=9.81,
        solver={"tolerance": 1e-10},
    )


CURRENT = {"profile": [[0.0, 0.2, 0.0], [100.0, 1.0, 0.0]]}
CALM_AND_STORM = (static("lay"), dynamic(20.0, 0.1, "calm"), static("rest"), dynamic(30.0, 0.1, "storm"))
MIDWATER = np.array([[10.0, 0.0, 50.0]])


def in_water(water: Mapping | None, *stages: Mapping, **more: Any) -> Scene:
    """A hanging riser in water that is given: four stages, of which two are dynamic. more: sections of the scene."""
    sections = {"gravity": 9.81, "water": water, **more}
    hanging = riser_scene(
        *(stages or CALM_AND_STORM),
        pipe=PIPE,
        length=148.0,
        elements=10,
        start=prescribed(0.0, 0.0, 1.0),
        end=prescribed(80.0, 0.0, 100.0),
    )
    return scene_from_mapping(hanging | {key: value for key, value in sections.items() if value is not None})


VESSEL_END = [40.0, 0.0, 3.0]
AIRY = {"airy": {"height": 3.0, "period": 9.0, "direction_deg": 35.0, "phase_deg": 70.0}}
JONSWAP = {"jonswap": {"Hs": 3.0, "Tp": 9.0, "components": 40, "direction_deg": 180.0}}


def below_vessel(*stages: Mapping, rotation: Any = "free", waves: Mapping = AIRY, **more: Any) -> Mapping:
    """A pipe that hangs under the sea's surface; its end moves in the stages as they say."""
    return riser_scene(
        *stages,
        pipe={"EA": 1.0e7, "EI": 1.0e5, "GJ": 1.0e5, "mass": 50.0, "submerged_weight": 200.0, "outer_diameter": 0.2},
        length=60.0,
        elements=6,
        start=prescribed(0.0, 0.0, -30.0),
        end=prescribed(*VESSEL_END, rotation=rotation),
        gravity=9.81,
        water={"surface_level": 10.0, "waves": waves},
        **more,
    )


RADIUS_AROUND, SECONDS_AROUND = 30.0, 40.0
LARGEST_AROUND = {1: 34375.0, -1: 47563.0}
"""Tension at the start [N], up first (+1) or down first (-1), in 2,000 steps."""


def way_around(way: int, side: int) -> str:
    """A motion table: once around, up (+1) or down (-1) first, from a side, +x or -x, with a smooth start and end."""
    t = np.linspace(0.0, SECONDS_AROUND, 161)
    s = t / SECONDS_AROUND
    angle = 2.0 * np.pi * way * (10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5)
    x, z = side * RADIUS_AROUND * (np.cos(angle) - 1.0), RADIUS_AROUND * np.sin(angle)
    rows = (f"{a:.9g},{b:.15g},0,{c:.15g}" for a, b, c in zip(t, x, z, strict=True))
    return "\n".join(("t [s],x [m],y [m],z [m]", *rows)) + "\n"


def end_led_around(table: str, side: int, time_step: float, elements: int = 60, dimension: int = 2) -> Mapping:
    """A riser whose end is led once around its start on a circle of 60 m. table: a file that holds `way_around`."""
    return riser_scene(
        static(),
        dynamic(SECONDS_AROUND, time_step, motion={"end": {"table": table}}),
        pipe=PIPE | {"drag": {"normal": 1.1}, "added_mass": {"normal": 1.0}},
        length=60.0,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(side * RADIUS_AROUND, 0.0, 0.0),
        gravity=9.81,
        water={"density": 1025.0},
        dimension=dimension,
    )


# On a seabed

ON_SEABED: Mapping = {
    "water": {"density": 1025.0},
    "line_types": {"pipe": PIPE | {"inner_diameter": 0.2, "drag": {"normal": 1.1}}},
    "riser": line("pipe", 140.0, 70, {"position": [0.0, 0.0, 0.15]}, {"position": [80.0, 0.0, 100.0]}),
    "seabed": {"kind": "rigid"},
    "stages": [dynamic(1.0, 0.1, "move")],
}
"""A riser of 140 m on a rigid seabed, moved for a second."""

DROP, FALLING_WEIGHT, FALLING_LENGTH = 1.0, 700.0, 20.0  # m, N/m, m
FALL = FALLING_WEIGHT * FALLING_LENGTH * DROP  # J, a measure of the energy in play
TILTED = {"points": [[0.0, 0.0, 0.0], [19.9, 0.0, 1.9974984]]}


def falling(seabed: str, start: Any, initial: Any, k: float, dt: float, duration: float) -> Mapping:
    """A pipe of 20 m comes down by its weight on a floor 1 m below its start; k [N/m2]."""
    sections: Mapping = {"seabed": {"kind": seabed, "level": -DROP}, "contact": {"smoothing": 1e-3}}
    sections["seabed" if seabed == "spring" else "contact"]["stiffness"] = k
    return riser_scene(
        dynamic(duration, dt, "fall"),
        pipe={"EA": 3e7, "EI": 5e4, "mass": 120.0, "outer_diameter": 0.3, "submerged_weight": FALLING_WEIGHT},
        length=FALLING_LENGTH,
        elements=20,
        start=start,
        end="free",
        riser={"initial": initial},
        gravity=9.81,
        dimension=2,
        solver={"tolerance": 1e-9},
        **sections,
    )


def pinned(k: float, dt: float, duration: float = 3.0) -> Mapping:
    """Hinged at its start, the pipe swings down on springs."""
    return falling("spring", prescribed(0.0, 0.0, 0.0), TILTED, k, dt, duration)


def flat(k: float, dt: float, duration: float = 3.0) -> Mapping:
    """Free at both ends, level: all nodes strike a rigid floor at once."""
    return falling("rigid", "free", "straight", k, dt, duration)


def tilted(k: float, dt: float, duration: float = 3.0) -> Mapping:
    """Free at both ends, one end strikes a rigid floor first; on average the pipe falls 2 m."""
    return falling("rigid", "free", TILTED, k, dt, duration)


# On soil


def touchdown(
    *stages: Mapping, kind: str = "hex", su: float = 600.0, dimension: int = 2, tolerance: float = 1e-7
) -> Mapping:
    """A riser of 30 m touches down at about 8 m on a block that reaches from 2 to 9 m; su [Pa] at the surface.

    A su of 600 Pa yields below the touchdown point, as the riser's submerged weight is 717 N/m.
    """
    law = CLAY | {"su": su, "su_gradient": 500.0}
    fine, coarse = ({"line_type": "flexible", "length": s, "elements": n} for s, n in ((12.0, 24), (18.0, 12)))
    pipe = PIPE | {"inner_diameter": 0.20, "drag": {"normal": 1.1, "tangential": 0.05}}
    return riser_scene(
        *deepcopy(stages or (LAY,)),
        pipe=pipe | {"added_mass": {"normal": 1.0, "tangential": 0.0}},
        length=30.0,
        elements=36,
        start=prescribed(0.0, 0.0, 0.15),
        end=prescribed(22.5, 0.0, 15.0),
        line_type="flexible",
        riser={"segments": [fine, coarse], "contents": {"density": 850.0}, "initial": "catenary"},
        gravity=9.81,
        dimension=dimension,
        water={"density": 1025.0},
        seabed={"kind": "spring", "level": 0.0, "stiffness": 1.0e5},
        soil=block(law, (2.0, 9.0), 1.0, 1.0, cells(0.5, 1.0, kind), submerged_unit_weight=5.0e3),
        solver={"tolerance": tolerance},
    )


def lying_pipe(su: float) -> Mapping:
    """8 m of pipe, 717 N/m, pinned at its start, on a block of clay of strength su [Pa] and on nothing else."""
    scene = touchdown(LAY, su=su)
    del scene["seabed"]
    scene["riser"] |= line("flexible", 8.0, 16, scene["riser"]["start"], "free", initial="straight")
    scene["soil"]["block"]["x"] = [-1.0, 9.0]
    scene["soil"]["law"]["su_gradient"] = 0.0
    return scene


FALL_ON_SOIL = 700.0 * 1.0 * 0.3  # J, a measure of the energy in play
MIDDLE, END = (0.3, 0.7), (-0.05, 0.35)  # m, where along the pipe it meets the slice


def falling_on_soil(
    k: float, dt: float, law: Mapping, where: tuple[float, float] = MIDDLE, duration: float = 0.5
) -> Mapping:
    """A pipe of 1 m, 0.3 m over a slice of soil, free at both ends, strikes after 0.32 s; k [N/m2]: of contact."""
    return riser_scene(
        dynamic(duration, dt, "fall"),
        pipe={"EA": 3e7, "EI": 5e5, "mass": 120.0, "outer_diameter": 0.3, "submerged_weight": 700.0},
        length=1.0,
        elements=4,
        start="free",
        end="free",
        riser={"initial": {"points": [[x, 0.0, 0.3 + 0.15] for x in (0.0, 1.0)]}},
        gravity=9.81,
        dimension=2,
        soil=block(law, where, 0.7, 0.7, cells({"along": 0.4, "across": 0.1}, 0.35)),
        contact={"method": "surface", "stiffness": k, "smoothing": 1e-3},
        solver={"tolerance": 1e-9},
    )
