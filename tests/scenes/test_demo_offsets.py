"""A steel catenary riser at offsets of its vessel: by the offset, by a stage that moves its end, by hand; its page."""

from __future__ import annotations

from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest

from demos.offsets.by_hand import LaidCable, cable_of
from demos.offsets.run import HERE, OFFSETS, SCENE, Computed, by_move, computed
from demos.page import block
from riser_soil.accuracy.chosen_run import in_numbers
from riser_soil.cases.expansion import read_cases
from riser_soil.hang_off import with_hang_offs_solved
from riser_soil.scene.reader import read_scene
from tests.support.coarse_cables import coarse_cables
from tests.support.on_ranks import ROOT

SHORT = "stages.1.duration=5.0"  # s: the ramp of the waves has begun


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Computed, Computed]]:
    """At each offset what is found by it, and by a stage that moves the end. Near hangs off by a search of its own;
    elsewhere it is the one of the mean.
    """
    with coarse_cables(500):
        return runs_in(tmp_path_factory.mktemp("offsets"))


def runs_in(folder: Path) -> dict[str, tuple[Computed, Computed]]:
    solved, results = with_hang_offs_solved(read_scene(SCENE, [SHORT])), {}
    assert solved is not None
    with redirect_stdout(StringIO()):
        hung, _ = in_numbers(solved.scene)
    for name, offset in OFFSETS.items():
        asked = read_scene(SCENE, [SHORT, f"vessel.offset.0={offset}"])
        scene = asked if name == "near" else solved.scene.model_copy(update={"vessel": asked.vessel})
        results[name] = computed(scene, folder / name), computed(by_move(hung, offset), folder / f"{name}_by_move")
    return results


def laid(name: str) -> tuple[LaidCable, float]:
    """The cable, and its horizontal tension [N] at an offset from where it hangs at 12 degrees."""
    cable = cable_of(read_scene(SCENE))
    return cable, cable.at_layback(cable.layback(cable.at_angle(12.0)) + OFFSETS[name])


@pytest.mark.parametrize("name", [*OFFSETS])
def test_an_offset_is_a_move_of_the_vessel(runs: dict[str, tuple[Computed, Computed]], name: str) -> None:
    by_offset, moved = runs[name]
    assert by_offset == pytest.approx(moved, rel=1e-7)


@pytest.mark.parametrize("name", [*OFFSETS])
def test_it_hangs_as_a_cable(runs: dict[str, tuple[Computed, Computed]], name: str) -> None:
    run, (cable, H) = runs[name][0], laid(name)
    assert run.tension == pytest.approx(cable.top_tension(H), rel=2e-3)
    assert run.moment == pytest.approx(cable.moment(H), rel=0.02)
    assert cable.touchdown(H) - run.touchdown == pytest.approx((cable.EI / H) ** 0.5, abs=2.0)


def test_near_bends_it_most(runs: dict[str, tuple[Computed, Computed]]) -> None:
    near, mean, far = (runs[name][0] for name in OFFSETS)
    assert near.moment > 1.3 * mean.moment > 1.6 * far.moment


@pytest.mark.parametrize("page", [HERE / "README.md", ROOT / "docs/cases.md"])
def test_the_pages_have_what_is_found(runs: dict[str, tuple[Computed, Computed]], page: Path) -> None:
    rows = block(page.read_text(encoding="utf-8"), "offsets").splitlines()[2:]
    for name, row in zip(OFFSETS, rows, strict=True):
        place, *cells = (cell.strip() for cell in row.strip("| ").split("|"))
        shown, run, (cable, H) = [float(cell) for cell in cells], runs[name][0], laid(name)
        expected = [run.tension, cable.top_tension(H), run.touchdown, cable.touchdown(H)]
        expected += [run.moment, cable.moment(H), run.moment]
        expected = [1e-3 * value if n not in (2, 3) else value for n, value in enumerate(expected)]
        assert place.startswith(name)
        assert shown[:7] == pytest.approx(expected, abs=0.06)
        assert shown[7] == shown[8] > shown[4]


def test_the_cases_are_those_of_the_page() -> None:
    _, cases = read_cases(SCENE.parent / "cases.yaml")
    assert {case.name: case.values["vessel.offset"][0] for case in cases} == OFFSETS
