"""A case by riser_soil: corotational beams, generalised-alpha, its scene written from the case's numbers.

It records end tensions, moments and positions at all nodes, and all that a run tells anyway, at every step.
"""

from __future__ import annotations

import json
import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI
from scipy.interpolate import CubicSpline

from benchmarks.peers.case import GRAVITY, WATER, Case, Record, Surge
from demos.compute import timed
from riser_soil.assembly import build
from riser_soil.checks.bending_plausibility import asked_lengths, segments_for
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping

REPEATS = 2  # of a single step; the first ever compiles
HALVINGS = 40
LOOKED_AT = 321  # nodes at equal arcs, where those of the mesh are not


def run(case: Case, elements: int, time_step: float, newton: str = "snes", mesh: str = "equal") -> Record:
    """One run, and its time loop's seconds: those of the run less those of a run of a single step."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = folder / "scene.yaml"
        scene.write_text(json.dumps(scene_of(case, elements, time_step, newton, mesh)), encoding="utf-8")
        still = [timed(scene, folder / "still", f"stages.1.duration={time_step}")[1] for _ in range(REPEATS)]
        done, moving = timed(scene, folder / "moving")
        return _read(done, moving - min(still))


def scene_of(case: Case, elements: int, time_step: float, newton: str, mesh: str = "equal") -> dict[str, Any]:
    """The case as a scene: at rest, then in motion. mesh: equal, or graded as `riser-soil check` proposes."""
    line = {
        "outer_diameter": case.diameter,
        "mass": case.mass,
        "EA": case.EA,
        "EI": case.EI,
        "drag": {"normal": case.drag, "tangential": 0.0},
        "added_mass": {"normal": case.added_mass, "tangential": 0.0},
    }
    ends = {
        name: {"position": [x, 0.0, z], "rotation": "free"}
        for name, (x, z) in (("start", case.start), ("end", case.end))
    }
    segment = {"line_type": "line", "length": case.length, "elements": elements}
    moving = {"name": "moving", "kind": "dynamic", "duration": case.duration, "time_step": time_step}
    scene: dict[str, Any] = {
        "title": f"{case.name}, beside other programs",
        "gravity": GRAVITY,
        "water": {"density": WATER},
        "line_types": {"line": line},
        "riser": {"segments": [segment], "initial": "catenary", **ends},
        "stages": [{"name": "rest", "kind": "static"}, {**moving, "motion": {"end": _motion(case)}}],
        "output": {
            "interval": time_step,
            "xdmf_interval": case.duration,
            "fields": ["effective_tension", "bending_moment"],
        },
        "solver": {"newton": newton},
    }
    if case.floor is not None:
        scene["seabed"] = {"kind": "rigid", "level": 0.0, "contact_at": "axis"}
        scene["contact"] = {"stiffness": case.floor}
    if mesh == "graded":
        scene["riser"]["segments"] = _graded(scene, elements)
    return scene


def _graded(scene: dict[str, Any], elements: int) -> list[dict[str, Any]]:
    """Segments of no more elements than so many, in the lengths' proportions to each other that are proposed."""
    checked = scene_from_mapping(scene)
    asked = asked_lengths(build(checked, MPI.COMM_SELF).riser)
    assert asked is not None
    arc, lengths = asked
    coarse, fine = 1e3, 1e-3  # times the proposed lengths
    for _ in range(HALVINGS):
        middle = math.sqrt(coarse * fine)
        segments = segments_for(checked, arc, middle * lengths)
        enough = sum(segment.element_count for segment in segments) > elements
        coarse, fine = (coarse, middle) if enough else (middle, fine)
    return [segment.model_dump(mode="json") for segment in segments_for(checked, arc, coarse * lengths)]


def _motion(case: Case) -> dict[str, Any]:
    way, grown = case.motion, {"period": case.period, "ramp": case.period}
    if isinstance(way, Surge):
        return {"harmonic": {"amplitude": [way.amplitude, 0.0, 0.0], **grown}}
    hub = [case.end[0], 0.0, case.end[1] + way.arm]
    return {"arc": {"hub": hub, "amplitude_deg": math.degrees(way.amplitude), "plane": "xz", **grown}}


def _read(run: Run, seconds: float) -> Record:
    """The stage in motion; its first record is that of the rest."""
    tension, arc = run["effective_tension"], np.asarray(run.arc)
    position = run["position"][..., ::2]
    if np.ptp(np.diff(arc)) > 1e-6 * arc[-1]:
        position = CubicSpline(arc, position, axis=1)(np.linspace(0.0, arc[-1], LOOKED_AT))
    return Record(
        time=np.asarray(run.time),
        held=tension[:, 0],
        moved=tension[:, -1],
        arc=arc,
        moment=run["bending_moment"],
        position=position,
        seconds=seconds,
    )
