"""Scenes of soil as mappings, on cells of D/n under the pipe: n is their fineness."""

from __future__ import annotations

from typing import Any

Mapping = dict[str, Any]

D = 0.3  # m
PIPE: Mapping = {"outer_diameter": D, "inner_diameter": 0.2, "mass": 120.0, "EA": 3.0e8, "EI": 5.0e4}
PIPE |= {"drag": {"normal": 1.1}, "added_mass": {"normal": 1.0}}
STIFF: Mapping = {"outer_diameter": D, "submerged_weight": 500.0, "mass": 120.0, "EA": 1.0e10, "EI": 1.0e9}
CLAY: Mapping = {"kind": "von-mises", "su": 2.0e3, "su_gradient": 1.5e3, "E_over_su": 300.0}
FIRM: Mapping = {"kind": "von-mises", "su": 5.0e3, "E_over_su": 400.0}
ELASTIC: Mapping = {"kind": "linear-elastic", "E": 6.0e5, "nu": 0.45}
DEPTHS = (0.05, 0.1, 0.15, 0.2)  # of D
PERIOD, HEAVE = 4.0, 0.3  # s, m


def pushed(n: int, method: Mapping) -> Mapping:
    """A stiff pipe pushed into a slice of clay, half a diameter long, by stages down to 0.2 D."""
    ends = {name: {"position": [x, 0.0, 0.5 * D], "rotation": "fixed"} for name, x in (("start", 0.0), ("end", D))}
    stages = [{"name": f"push {depth:g}", "kind": "static", "move": _down(ends, depth * D)} for depth in DEPTHS]
    around = {"x": [0.25 * D, 0.75 * D], "y": [-4.0 * D, 4.0 * D], "depth": 4.0 * D}
    scene: Mapping = {
        "title": "Pipe pushed into clay",
        "dimension": 2,
        "line_types": {"pipe": STIFF},
        "riser": {"segments": [{"line_type": "pipe", "length": D, "elements": 2}], **ends, "initial": "straight"},
        "soil": {"block": around, "mesh": _mesh(n, 0.5 * D, 2.0 * D, D, method), "law": FIRM},
        "solver": {"load_steps": 5},
        "stages": stages,
        "output": {"sections": {"arcs": [0.5 * D], "half_width": 2.0 * D, "points": 81}},
    }
    return _by(scene, method)


def _down(ends: Mapping, depth: float) -> Mapping:
    return {name: [*end["position"][:2], 0.5 * D - depth] for name, end in ends.items()}


def laid(n: int, method: Mapping, law: Mapping = CLAY) -> Mapping:
    """A riser of 30 m comes down on a block of 6 m of clay, and is heaved for a period."""
    size = 1.2 / n**0.5  # along the riser, where fields are smoother [m]
    fine, coarse = {"length": 12.0, "element_length": 0.5 * size}, {"length": 18.0, "element_length": [0.5 * size, 1.5]}
    harmonic = {"amplitude": [0.0, 0.0, HEAVE], "period": PERIOD, "ramp": 0.5 * PERIOD}
    heave: Mapping = {"name": "heave", "kind": "dynamic", "duration": PERIOD, "time_step": PERIOD / 32.0}
    heave["motion"] = {"end": {"harmonic": harmonic}}
    scene: Mapping = {
        "title": "Riser laid on clay and heaved",
        "dimension": 2,
        "water": {"density": 1025.0},
        "line_types": {"pipe": PIPE},
        "riser": {
            "contents": {"density": 850.0},
            "segments": [{"line_type": "pipe"} | segment for segment in (fine, coarse)],
            "start": {"position": [0.0, 0.0, 0.5 * D]},
            "end": {"position": [22.5, 0.0, 15.0]},
        },
        "seabed": {"kind": "spring", "stiffness": 5.0e4},
        "soil": {
            "block": {"x": [4.0, 10.0], "y": [-1.0, 1.0], "depth": 1.0},
            "mesh": _mesh(n, size, D, 0.5, method),
            "law": law,
        },
        "stages": [{"name": "lay", "kind": "static"}, heave],
        "output": {"sections": {"arcs": [7.0], "half_width": 2.0 * D, "points": 81}},
    }
    return _by(scene, method)


def elastic(n: int, method: Mapping) -> Mapping:
    """A pressed riser on elastic soil."""
    return laid(n, method, ELASTIC)


def _mesh(n: int, along: float, strip: float, far: float, method: Mapping) -> Mapping:
    if method.get("kind") == "tet":
        return {"kind": "tet", "size_at_riser": D / n, "size_far": far}
    return {"kind": "hex", "size_at_riser": {"along": along, "across": D / n, "strip": strip}, "size_far": far}


def _by(scene: Mapping, method: Mapping) -> Mapping:
    """The scene with a method's keys in it."""
    scene["soil"] |= method.get("soil", {})
    scene["contact"] = {"method": method.get("contact", "surface")}
    scene["solver"] = scene.get("solver", {}) | method.get("solver", {})
    return scene
