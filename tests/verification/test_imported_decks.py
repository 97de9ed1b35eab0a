"""Decks of MoorDyn at rest: closed forms, and MoorDyn 2.7.2 of the same decks (60 s more after its own relaxation)."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import pytest

from riser_soil.moordyn.scene_of import scene_of
from riser_soil.moordyn.whole_deck import whole_scene_of
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.moordyn_decks import LINES, POINTS, TYPES, deck_of_text, text_of_deck

G, RHO = 9.81, 1020.0
CHAIN = [*TYPES[:2], "chain 0.08 95 4.0e8 -0.8 0 2.0 1.0 0.1 0.0"]
ANCHORED = [*POINTS[:2], "1 Fixed -260 0 -75 0 0 0 0", "2 Coupled 0 0 -6 0 0 0 0"]
LINE = [*LINES[:2], "1 chain 1 2 276 60 -"]
OPTIONS = ["75 WtrDpth", "4e4 kBot", "1020 rho", "9.81 g"]
W = G * (95.0 - RHO * math.pi / 4.0 * 0.08**2)  # N/m

# Top tension [N] by MoorDyn; below the seabed by a fixed body, which does not lower its seabed.
ON_THE_SEABED, BELOW_IT = 289265.0, 293563.0
SPLICED = 10705.0
PEERS = 0.005  # MoorDyn lumps weight and contact at nodes


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("decks")


def rest(folder: Path, **parts: Any) -> Run:
    parts = {"line_types": CHAIN, "points": ANCHORED, "lines": LINE, "options": OPTIONS} | parts
    scene = scene_from_mapping(scene_of(deck_of_text(folder, text_of_deck(**parts))).data)
    results = Path(mkdtemp(dir=folder))
    run(scene, results)
    return Run(results)


def top_tension(run: Run) -> float:
    return float(run.summary["stages"][0]["final"]["end"]["effective_tension"])


@pytest.fixture(scope="module")
def usual(folder: Path) -> float:
    return top_tension(rest(folder))


def test_by_other_names_and_without_a_depth(usual: float, folder: Path) -> None:
    assert usual == pytest.approx(ON_THE_SEABED, rel=PEERS)
    named = rest(folder, options=["4e4 kb", "1020 WTRDNSTY", "9.81 Gravity", "1e3 cb"])
    assert top_tension(named) == pytest.approx(usual, rel=1e-12)


def test_an_anchor_below_the_seabed(usual: float, folder: Path) -> None:
    """The line takes a longer way: by what it gains so MoorDyn has it, too."""
    tension = top_tension(rest(folder, points=[*ANCHORED[:2], ANCHORED[2].replace("-75", "-77.5"), ANCHORED[3]]))
    assert tension == pytest.approx(BELOW_IT, rel=PEERS)
    assert tension - usual == pytest.approx(BELOW_IT - ON_THE_SEABED, rel=0.02)


def test_an_anchor_a_radius_above_the_seabed(usual: float, folder: Path) -> None:
    tension = top_tension(rest(folder, points=[*ANCHORED[:2], ANCHORED[2].replace("-75", "-74.96"), ANCHORED[3]]))
    assert tension == pytest.approx(usual, rel=1e-3)


@pytest.mark.parametrize("mass", [0.0, 400.0])
def test_a_chain_with_a_free_lower_end(mass: float, folder: Path) -> None:
    """The top bears the wet weight, also of what hangs at the end."""
    points = [*POINTS[:2], "1 Fixed 3 5 -6 0 0 0 0", f"2 Free 9 5 -40 {mass} {mass / 8000.0} 0 0"]
    hung = rest(folder, lines=[*LINES[:2], "1 chain 1 2 40 20 -"], points=points)
    assert top_tension(hung) == pytest.approx(40.0 * W + G * mass * (1.0 - RHO / 8000.0), rel=1e-6)
    assert hung["position"][-1][0] == pytest.approx([3.0, 5.0, -46.0], abs=0.01)


def test_a_body_without_inertia_that_is_pulled_aside(folder: Path) -> None:
    """A weight on a line, by a steady force: at the body the tension is that of the two."""
    pulled = rest(
        folder, lines=[*LINES[:2], "1 chain 2 1 40 20 -"],
        bodies=["ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca", "(-)",
                "1 Free 0 0 -46 0 0 0 9e3 0 0 1.5 0 0"],
        external_loads=["ID Object Fext Blin Bquad CSys", "(-)", "1 Body1 4e4|0|0 0 0 G"],
        points=[*POINTS[:2], "1 Body1 0 0 0 0 0 0 0", "2 Fixed 0 0 -6 0 0 0 0"],
    )  # fmt: skip
    weight = G * (9e3 - RHO * 1.5)
    assert top_tension(pulled) == pytest.approx(math.hypot(4e4, weight + 40.0 * W), rel=1e-4)
    assert pulled.summary["stages"][0]["final"]["start"]["effective_tension"] == pytest.approx(
        math.hypot(4e4, weight), rel=1e-2
    )


def test_lengths_spliced_by_rods_of_no_length(folder: Path) -> None:
    """A lazy wave whose guessed splices are farther apart than its lines are long."""
    spliced = rest(
        folder,
        line_types=[*TYPES[:2], "cable 0.14 35 2.5e8 -0.8 1.5e4 1.2 1 0 0", "float 0.32 50 2.5e8 -0.8 1.5e4 1.2 1 0 0"],
        rod_types=["Name Diam Mass/m Cd Ca CdEnd CaEnd", "(-)", "joint 0.14 35 1.2 1 0 0"],
        rods=["ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs Outputs", "(-)",
              "1 joint Free -10 0 -70 -10 0 -70 0 -", "2 joint Free -12 0 -9 -12 0 -9 0 -"],
        points=[*POINTS[:2], "1 Fixed -130 0 -75 0 0 0 0", "2 Coupled 0 0 -6 0 0 0 0"],
        lines=[*LINES[:2], "1 cable 1 R2A 60 30 -", "2 float R2B R1A 40 20 -", "3 cable R1B 2 75 38 -"],
        options=["75 WtrDpth", "3e5 kBot", "1020 rho", "9.81 g"],
    )  # fmt: skip
    assert top_tension(spliced) == pytest.approx(SPLICED, rel=0.02)


@pytest.mark.parametrize(
    ("mass", "volume"),
    [(2000.0, 0.5), *(pytest.param(*node, marks=pytest.mark.verify) for node in ((0.0, 0.0), (500.0, 3.0)))],
)
def test_a_bridle_whose_node_is_guessed_far_away(mass: float, volume: float, folder: Path) -> None:
    """The scene has it where it comes to rest: a run moves it by less than the elements are short of cables."""
    text = text_of_deck(
        line_types=[*CHAIN, "rope 0.12 11.5 4.2e7 -0.9 0 1.3 1.1 0.04 0.02"], options=OPTIONS,
        points=[*ANCHORED[:3], "2 Coupled 0 10 -6 0 0 0 0", "3 Coupled 0 -10 -6 0 0 0 0",
                f"4 Free -200 40 -10 {mass} {volume} 0 0", "5 Free -90 0 -70 0 0 0 0"],
        lines=[*LINES[:2], "1 chain 1 5 160 20 -", "2 rope 5 4 70 10 -", "3 rope 4 2 43 10 -", "4 rope 4 3 43 10 -"],
    )  # fmt: skip
    data = whole_scene_of(deck_of_text(folder, text)).data
    assert [*data["lines"]] == ["line1_2", "line3", "line4"]
    results = Path(mkdtemp(dir=folder))
    run(scene_from_mapping(data), results)
    stage = Run(results).summary["stages"][0]
    guessed = data["bodies"]["point4"]["position"] if mass else data["joints"]["at4_1"]["position"]
    assert stage["lines"]["line1_2"]["final"]["end"]["position"] == pytest.approx(guessed, abs=0.05)
    assert guessed[1] == pytest.approx(0.0, abs=1e-3), "midway between the two fairleads"
    assert stage["newton_iterations"] <= 10
