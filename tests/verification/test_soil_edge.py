"""Edge of the soil: settlement and penetration by the riser's weight against computed ones, steps in height told."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly.scales import Scales
from riser_soil.checks.check import describe
from riser_soil.checks.soil_edge import penetration, settlement
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin
from tests.support.driven_stage import built, take
from tests.support.said import line_with
from tests.support.scenes import Mapping, touchdown

D, DOWN, LENGTH = 0.3, 2.0e-3, 0.02
SOFT: Mapping = {"kind": "linear-elastic", "E": 1.5e6, "nu": 0.49}
STIFF: Mapping = {"kind": "linear-elastic", "E": 1.5e9, "nu": 0.49}
CLAY: Mapping = {"kind": "von-mises", "su": 5.0e3, "E_over_su": 300.0, "nu": 0.49}


def pressed(down: float, soil: Mapping) -> Mapping:
    """A stiff pipe without weight is pushed into a slice of soil, 1.2 m deep."""
    z = 0.5 * D
    ends = {end: {"position": [x, 0.0, z], "rotation": "fixed"} for end, x in (("start", 0.0), ("end", LENGTH))}
    pipe = {"outer_diameter": D, "EA": 1e10, "EI": 1e8, "submerged_weight": 0.0}
    move = {end: [x, 0.0, z - down] for end, x in (("start", 0.0), ("end", LENGTH))}
    return {
        "gravity": 0.0,
        "line_types": {"pipe": pipe},
        "riser": {
            "segments": [{"line_type": "pipe", "length": LENGTH, "elements": 2}],
            **ends,
            "initial": "unstressed",
        },
        "soil": {
            "block": {"x": [0.0, LENGTH], "y": [-3.0, 3.0], "depth": 1.2},
            "mesh": {"kind": "hex", "size_at_riser": 0.008, "size_far": 0.4},
            **soil,
        },
        "contact": {"method": "surface"},
        "stages": [{"name": "press", "kind": "static", "move": move}],
    }


def force_per_length(mapping: Mapping) -> float:
    """What the soil bears at the end [N/m]."""
    assembly = built(mapping)
    state = take(assembly, assembly.scene.stages[0])
    assert assembly.soil is not None
    return -float(assembly.soil.contact.force_on_soil(state)[2]) / LENGTH


@pytest.mark.parametrize(
    ("soil", "within"),
    [
        ({"law": SOFT}, 0.02),
        ({"layers": [{"to": 0.4, "law": SOFT}, {"law": STIFF}]}, 0.02),
        ({"layers": [{"to": 0.4, "law": SOFT}, {"law": {**SOFT, "E": 7.5e5}}]}, 0.08),
    ],
    ids=["one", "1:1000", "softer below"],
)
def test_a_pipe_settles_as_estimated(soil: Mapping, within: float) -> None:
    """The estimate neither knows the rigid bottom, 4 D down, nor how a layer spreads the load."""
    mapping = pressed(DOWN, soil)
    q = force_per_length(mapping)
    given = scene_from_mapping(mapping).soil
    assert given is not None
    assert settlement(given, Scales(q, D, 1.0), 1.2) == pytest.approx(DOWN, rel=within)


def test_penetration_of_a_law_bears_the_weight() -> None:
    law = RandolphQuiggin(kind="randolph-quiggin", su=2.0e3, su_gradient=1.5e3).of_pipe(D)
    sunk = np.array([penetration(law, 700.0, D)])
    assert law.update(sunk, law.initial_history((1,))).force[0] == pytest.approx(700.0, rel=1e-9)
    assert penetration(law, 1.0e9, D) == D


def warnings_of(mapping: Mapping) -> list[str]:
    return [line for line in describe(scene_from_mapping(mapping)).splitlines() if "seabed beside" in line]


def beside(seabed: Mapping, **soil: Any) -> Mapping:
    mapping = touchdown(su=2.0e3)
    return mapping | {"seabed": seabed, "soil": mapping["soil"] | soil}


def test_check_tells_the_step() -> None:
    """728 N/m sink 7.3 mm into springs of 1e5 N/m2, about as much into the soil."""
    (line,) = warnings_of(beside({"kind": "spring", "stiffness": 1.0e5}))
    line_with([line], "7.3 mm in the seabed", "(1e+05 N/m2)", "a step of")


def test_a_step_is_warned_of() -> None:
    soft = {"law": {**CLAY, "su": 150.0, "su_gradient": 600.0}}
    warning, fact = warnings_of(beside({"kind": "rigid"}, **soft))
    assert re.search(r"\d mm higher", warning)
    stiffness = float(warning.split("take seabed.stiffness ")[1].split()[0])
    assert f"({stiffness:.2g} N/m2)" in fact
    assert len(warnings_of(beside({"kind": "spring", "stiffness": stiffness}, **soft))) == 1


def test_a_trench_that_ends_at_the_edge_is_reported() -> None:
    mesh = {"kind": "tet", "size_at_riser": 0.4, "size_far": 0.8}
    mapping = beside({"kind": "spring", "stiffness": 1.0e5}, mesh=mesh)
    mapping["soil"]["block"]["trench"] = {"depth": 0.25, "width": 0.6, "side_slope_deg": 60.0}
    warning, fact = warnings_of(mapping)
    line_with([fact], "250 mm deep", "edge")
    line_with([warning], "end within the block")
    mapping["soil"]["block"]["trench"] |= {"along": [4.0, 7.0], "run_out": 1.0}
    assert len(warnings_of(mapping)) == 1
