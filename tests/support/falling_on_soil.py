"""A pipe falls on a slice of soil that it touches with its surface."""

from __future__ import annotations

from tests.support.coupled_scenes import Mapping

WEIGHT, LENGTH, D = 700.0, 1.0, 0.3  # N/m, m, m
DROP = 0.3  # m from the start to the soil
FALL = WEIGHT * LENGTH * DROP  # J, a measure of the energy in play
ELASTIC: Mapping = {"kind": "linear-elastic", "E": 1.2e6, "nu": 0.49}
CLAY: Mapping = {"kind": "von-mises", "su": 4.0e3, "E_over_su": 300.0, "nu": 0.49}


MIDDLE, END = (0.3, 0.7), (-0.05, 0.35)  # m, where along the pipe it meets the slice


def falling(k: float, dt: float, law: Mapping, where: tuple[float, float] = MIDDLE, duration: float = 0.5) -> Mapping:
    """Level, free at both ends, it strikes after 0.32 s; k [N/m2] is the contact's stiffness."""
    pipe = {"EA": 3e7, "EI": 5e5, "mass": 120.0, "outer_diameter": D, "submerged_weight": WEIGHT}
    return {
        "title": "A pipe falls on soil",
        "gravity": 9.81,
        "dimension": 2,
        "line_types": {"pipe": pipe},
        "riser": {
            "segments": [{"line_type": "pipe", "length": LENGTH, "elements": 4}],
            "start": "free",
            "end": "free",
            "initial": {"points": [[x, 0.0, DROP + 0.5 * D] for x in (0.0, LENGTH)]},
        },
        "soil": {
            "block": {"x": list(where), "y": [-0.7, 0.7], "depth": 0.7},
            "mesh": {"kind": "hex", "size_at_riser": {"along": 0.4, "across": 0.1}, "size_far": 0.35},
            "law": law,
        },
        "contact": {"method": "surface", "stiffness": k, "smoothing": 1e-3},
        "stages": [{"name": "fall", "kind": "dynamic", "duration": duration, "time_step": dt}],
        "solver": {"tolerance": 1e-9},
    }
