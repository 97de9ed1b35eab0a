"""What a run tells at the end of a stage that could not be known before: strains, blurred bending, soil untouched."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.core.snapshot import Record
from riser_soil.results.plausibility import Plausibility
from riser_soil.results.soil_plausibility import PressedSoil, SoilPlausibility
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.driven_stage import built
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, dynamic, heave, prescribed, riser_scene, static, touchdown

ONE_CELL: Mapping = {"kind": "hex", "size_at_riser": 9.0, "size_far": 9.0}
ROPE: Mapping = {"EA": 1.0e4, "EI": 1.0, "mass": 5.0, "outer_diameter": 0.02}


def warnings_of(scene: Mapping, folder: Path) -> list[list[str]]:
    """Warnings in the summary, stage by stage."""
    run(scene_from_mapping(scene), folder)
    return [stage["warnings"] for stage in json.loads((folder / "summary.json").read_text())["stages"]]


def pulled(*stages: Mapping) -> Mapping:
    """A rope along x, clamped at its start."""
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    return riser_scene(*stages, pipe=ROPE, length=10.0, elements=5, start=start, end="free")


def test_axial_strain_beyond_what_beams_stand_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def force(name: str, size: float) -> Mapping:
        return static(name, loads=[{"at": "end", "force": [size, 0.0, 0.0]}])

    much, little = warnings_of(pulled(force("much", 5.7e3), force("little", 0.9e3)), tmp_path)
    (warning,) = much
    assert re.search(r"along its axis.* 0\.57 at arc\s\d", warning)
    assert "at most 10%" in warning
    assert little == []
    assert f"warning: much: {warning}\n" in capsys.readouterr().out


def test_strain_by_bending(tmp_path: Path) -> None:
    """Bent to a circle by a moment at its end: curvature M/EI = 12/m times half of 0.02 m."""
    curl = static("curl", loads=[{"at": "end", "moment": [0.0, 12.0, 0.0]}])
    scene = pulled(curl)
    scene["riser"]["segments"][0] |= {"length": 0.5, "elements": 20}
    ((warning,),) = warnings_of(scene, tmp_path)
    assert re.search(r"by bending,.* 0\.12 at arc\s\d", warning)


def test_a_stage_tells_its_worst_instant(tmp_path: Path) -> None:
    history = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]
    push = dynamic(2.0, 0.25, loads=[{"at": "end", "force": [4.0e3, 0.0, 0.0], "history": history}])
    ((warning, *_),) = warnings_of(pulled(push), tmp_path)
    assert "strained along its axis" in warning
    assert warning.split(" and ")[1].startswith(("0.75 s", "1 s", "1.25 s", "1.5 s"))


def test_section_changes_count_with_the_weaker_side() -> None:
    """At the node between two line types the smaller EA and the larger diameter tell."""
    scene = pulled(static())
    scene["line_types"]["thick"] = ROPE | {"EA": 4.0e4, "outer_diameter": 0.1}
    scene["riser"]["segments"] = [{"line_type": name, "length": 5.0, "elements": 1} for name in ("pipe", "thick")]
    plausibility = Plausibility(built(scene).riser)
    assert plausibility.EA.tolist() == [1.0e4, 1.0e4, 4.0e4]
    assert plausibility.radius.tolist() == [0.01, 0.05, 0.05]


@pytest.mark.parametrize(
    ("EI", "push", "said"),
    [
        (2.0e3, 780.0, []),  # of the 789.6 N that elements of 5 m bear, pi^2 EI/L^2
        (2.0e3, 800.0, ["arc 5 m", "compressed by 800 N", "5 m bow out", "= 789.6 N"]),
        (0.0, 9.0, []),
        (0.0, 11.0, ["arc 5 m", "compressed by 11 N", "no bending stiffness", "elements of 5 m"]),
    ],
)
def test_compression_beyond_what_elements_bear_is_reported(EI: float, push: float, said: list[str]) -> None:
    """Above a thousandth of the stage's largest tension, 10 N."""
    scene = pulled(static())
    scene["line_types"]["pipe"] |= {"EI": EI}
    scene["riser"]["segments"] = [{"line_type": "pipe", "length": 10.0, "elements": 2}]
    assembly = built(scene)
    warnings = judged(assembly, tension=[1.0e4, -push, 20.0])
    assert len(warnings) == bool(said)
    for words in said:
        line_with(warnings, words)


def judged(
    assembly: Assembly,
    tension: Sequence[float],
    moment: float = 0.0,
    smooth: Sequence[float] = (),
    steep: Sequence[float] = (),
) -> tuple[str, ...]:
    """Warnings of a state with these tensions at the nodes [N] and this largest moment [N m], which strain little, and
    with these misfits of the elements [N m], none by default.
    """
    plausibility, count = Plausibility(assembly.riser), len(tension)
    plausibility.begin_stage(assembly.scene.stages[0])
    plausibility.EA = np.full(count, 1.0e9)
    values = {"effective_tension": np.array([tension]), "curvature": np.zeros((1, count))}
    values["bending_moment"] = np.full((1, count), moment)
    plausibility.follow(np.ones(1), Record(assembly.riser.line.arc, values))
    misfits = {"smooth_misfit": smooth, "steep_misfit": steep}
    closely = {name: np.array([values or np.zeros(count - 1)]) for name, values in misfits.items()}
    plausibility.follow_bending(np.ones(1), Record(assembly.riser.line.arc, closely))
    again = Plausibility(assembly.riser)
    again.begin_stage(assembly.scene.stages[0])
    again.restore(plausibility.state())
    assert again.warnings() == plausibility.warnings()
    assert again.bending() == plausibility.bending()
    return plausibility.warnings()


def test_bending_that_elements_blur_is_reported_in_every_stage(tmp_path: Path) -> None:
    pipe: Mapping = {"EA": 3.0e8, "EI": 5.0e4, "mass": 120.0, "submerged_weight": 700.0}
    ends = prescribed(0.0, 0.0, 60.0), prescribed(80.0, 0.0, 100.0, rotation="fixed")
    stages = static("hang"), static("pull", move={"end": [90.0, 0.0, 100.0]}), dynamic(0.2, 0.1)
    options: Mapping = {"pipe": pipe, "length": 150.0, "elements": 20, "start": ends[0], "end": ends[1]}
    hang, *others = warnings_of(riser_scene(*stages, **options, gravity=9.81), tmp_path)
    assert hang == []
    for (warning,) in others:
        line_with([warning], "7.5 m", "too long", "bending", "arc 146.25 m", "N.m, 46%", "limit 20%")


@pytest.mark.parametrize(
    ("smooth", "steep", "limit"), [(9.9, 19.9, ""), (10.1, 0.0, "limit 10%"), (0.0, 20.1, "limit 20%")]
)
def test_bending_is_blurred_from_a_tenth_of_the_largest_moment_where_it_is_smooth_and_a_fifth_beside_a_clamp(
    smooth: float, steep: float, limit: str
) -> None:
    misfits = {"smooth": [0.0, 0.0, smooth, 0.0, 0.0], "steep": [0.0, 0.0, 0.0, 0.0, steep]}
    warnings = judged(built(pulled(static())), tension=6 * [0.0], moment=100.0, **misfits)
    assert [limit in warning for warning in warnings] == [True] * bool(limit)


@pytest.mark.parametrize(("tension", "warned"), [(0.0, True), (1.9e4, True), (2.1e4, False)])
def test_bending_that_moves_the_line_of_tension_by_a_fifty_thousandth_of_the_diameter_is_none(
    tension: float, warned: bool
) -> None:
    """All of the moment of a rope of 0.02 m is misfit, 8 mN m; it changes its stress by 8 M/(T D), less than 0.02 %."""
    rope, misfits = built(pulled(static())), [8.0e-3, 0.0, 0.0, 0.0, 0.0]
    warnings = judged(rope, tension=[0.0, *(5 * [tension])], moment=2.0e-3, steep=misfits)
    assert [("0.008 N.m, 100%" in warning) for warning in warnings] == [True] * warned


def test_a_small_turn_of_a_stiff_element_hides_no_other_one() -> None:
    """A stiff part with the larger misfit, which is a turn of 1e-3, beside a rope that the elements don't follow."""
    scene = pulled(static())
    scene["line_types"]["stiff"] = ROPE | {"EI": 1.0e6}
    scene["riser"]["segments"] = [{"line_type": name, "length": 5.0, "elements": 1} for name in ("stiff", "pipe")]
    (warning,) = judged(built(scene), tension=[0.0, 0.0, 0.0], moment=300.0, smooth=[200.0, 150.0])
    assert "150 N.m, 50%" in warning


def test_soil_that_is_never_touched_is_reported_after_the_last_stage(tmp_path: Path) -> None:
    aside = touchdown(LAY, heave(0.2))
    aside["soil"] |= {"block": {"x": [18.0, 21.0], "y": [-1.0, 1.0], "depth": 1.0}, "mesh": ONE_CELL}
    lay, moved = warnings_of(aside, tmp_path / "aside")
    assert lay == []
    warning = line_with(moved, "in no stage", "touch the soil", "18 to 21 m", "-1 to 1 m")
    assert "touches down at [6" in warning


def test_what_is_doubtful_about_soil_is_known_after_a_restart() -> None:
    """Pressed with 1 MN/m, stretched to twice its area, and left by 2 m at an instant; calm at the next."""
    assembly = built(touchdown(LAY, heave(0.2)))
    riser, soil = assembly.riser, assembly.riser.soil
    assert soil is not None
    high, nodes = soil.whole.grid.high, riser.line.nodes
    begun, again = SoilPlausibility(riser, soil), SoilPlausibility(riser, soil)
    for each in (begun, again):
        each.begin_stage(assembly.scene.stages[1])
    for t, force, stretch, beyond in ((0.1, 1.0e6, 2.0, 2.0), (0.2, 10.0, 1.0, -1.0)):
        values = {"touchdown_arc": np.array(7.5), "touchdown_position": high + np.array([beyond, -0.5 * high[1], 0.0])}
        begun.follow(t, PressedSoil(np.full(nodes, force), stretch), Record(riser.line.arc, values))
    warnings = begun.warnings()
    assert len(warnings) == 3
    line_with(warnings, "stretched to 2 times", "0.1 s")
    line_with(warnings, "the soil bears 1e+06 N/m", "0.1 s")
    line_with(warnings, "left the soil's block", "2 m beyond", "0.1 s", "arc 7.5 m")
    again.restore(begun.state())
    assert again.warnings() == warnings


def test_soil_that_is_touched_is_not_reported(tmp_path: Path) -> None:
    below = touchdown(su=2000.0)
    below["soil"] |= {"block": {"x": [2.0, 9.0], "y": [-1.0, 1.0], "depth": 1.0}, "mesh": ONE_CELL}
    assert warnings_of(below, tmp_path) == [[]]
