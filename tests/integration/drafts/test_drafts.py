"""Drafts of `riser-soil new`: they run as they come out, hang as asked, and refuse what can't be."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from riser_soil.assembly import build
from riser_soil.assembly.packages import communicator_of
from riser_soil.commands.app import app
from riser_soil.drafts.pipes import buoyant, chain, flexible, steel
from riser_soil.drafts.text import draft, number
from riser_soil.drafts.wishes import Wishes, ask
from riser_soil.scene.document import parse
from riser_soil.scene.reader import checked
from riser_soil.scene.scene import Scene
from tests.support.coarse_cables import coarse_cables
from tests.support.said import line_with

KINDS = ("steel-catenary", "flexible", "lazy-wave", "top-tensioned", "mooring")
HANGING = {"steel-catenary": 12.0, "flexible": 10.0, "lazy-wave": 12.0, "mooring": 45.0}


@pytest.fixture
def coarse() -> Iterator[None]:
    """Catenaries, from which the runs and searches begin, have few bars."""
    with coarse_cables(300):
        yield


def called(*words: str) -> Result:
    return CliRunner().invoke(app, list(words))


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("kind", KINDS)
def test_a_draft_is_checked_and_runs_as_it_is(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    written = called("new", kind, "--current", "0.5")
    assert written.exit_code == 0, written.output
    lines = written.output.splitlines()
    assert "no warnings" in lines
    line_with(lines[-1:], f"{kind}.yaml: written", f"riser-soil run {kind}.yaml")
    checked = called("check", f"{kind}.yaml")
    assert checked.exit_code == 0
    assert "no warnings" in checked.output.splitlines()
    done = called("run", f"{kind}.yaml", "--set", "stages.1.duration=1.0")
    assert done.exit_code == 0, done.output
    assert "warning" not in done.output


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize(
    ("wishes", "seconds"),
    [
        ("steel-catenary --depth 900 --diameter 0.219 --wall 0.0222 --angle 14 --hs 7 --tp 12", 20.0),
        ("lazy-wave --depth 250 --diameter 0.25 --hs 9", 1.0),
    ],
)
def test_steps_and_elements_of_a_draft_are_fine_enough_for_its_motion(
    wishes: str, seconds: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A thin pipe moves by some of its diameters in a step, and a short bend has few elements."""
    monkeypatch.chdir(tmp_path)
    assert called("new", *wishes.split(), "-o", "mine.yaml").exit_code == 0
    done = called("run", "mine.yaml", "--set", f"stages.1.duration={seconds}")
    assert done.exit_code == 0, done.output
    assert "warning" not in done.output


def scene(kind: str, wishes: Wishes) -> Scene:
    return checked(parse(draft(kind, wishes, "test"), "test"), Path())


# Outer diameters of API 5L [inch]; those from 20 in on go by whole inches of an even number.
SMALL = [2.375, 2.875, 3.5, 4.0, 4.5, 5.5625, 6.625, 8.625, 10.75, 12.75, 14.0, 16.0, 18.0]
INCHES = [*SMALL, *map(float, range(20, 49, 2))]
IN_TABLES = [0.0603, 0.1413, 0.1683, 0.2191, 0.2731, 0.3239]  # m, as tables in millimetres round them


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize(
    "kind",
    [
        *("steel-catenary", "top-tensioned"),
        *(pytest.param(kind, marks=pytest.mark.verify) for kind in ("flexible", "lazy-wave", "mooring")),
    ],
)
def test_every_size_of_api_5l_gives_a_scene_that_builds(kind: str) -> None:
    """The start rests on the ground to the last figure, and no digit of the diameter is lost."""
    for diameter in [*(round(0.0254 * inches, 7) for inches in INCHES), *IN_TABLES]:
        drafted = scene(kind, Wishes(diameter=diameter))
        build(drafted, communicator_of(drafted))
        outer = drafted.line_types["pipe"].outer_diameter
        assert outer == pytest.approx(1.8 * diameter if kind == "mooring" else diameter, rel=1e-12)


def test_given_numbers_keep_all_their_digits() -> None:
    given = Wishes(
        depth=1234.5678, diameter=0.2730514, mass=98.765432, Hs=3.14159, Tp=9.87654, current=0.456789, angle=11.23456,
        su=2345.678, gradient=1234.567, contents=812.3456, min_bend_radius=4.567891, max_tension=1234567.8,
    )  # fmt: skip
    data = parse(draft("flexible", given, "test"), "test").data
    pipe, water, riser, law = data["line_types"]["pipe"], data["water"], data["riser"], data["seabed"]["law"]
    assert (pipe["outer_diameter"], pipe["mass"]) == (given.diameter, given.mass)
    assert (pipe["min_bend_radius"], pipe["max_tension"]) == (given.min_bend_radius, given.max_tension)
    assert (water["surface_level"], water["current"]["profile"][1][:2]) == (given.depth, [given.depth, given.current])
    assert (water["waves"]["jonswap"]["Hs"], water["waves"]["jonswap"]["Tp"]) == (given.Hs, given.Tp)
    assert (law["su"], law["su_gradient"]) == (given.su, given.gradient)
    assert (riser["contents"]["density"], riser["end"]["hang_off"]["angle"]) == (given.contents, given.angle)
    steel = parse(draft("steel-catenary", Wishes(yield_stress=4.1234567e8), "test"), "test").data
    assert steel["line_types"]["pipe"]["wall"]["yield_stress"] == 4.1234567e8


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize(
    "kind",
    [
        *("flexible", "mooring"),
        *(pytest.param(kind, marks=pytest.mark.verify) for kind in ("steel-catenary", "lazy-wave")),
    ],
)
def test_with_an_angle_clay_and_raos_it_runs_as_it_is(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A vessel that heaves as the waves do; the angle is solved for, and is there at rest. The scene is elsewhere."""
    monkeypatch.chdir(tmp_path)
    rao = "period [s], direction [deg], heave [m/m], heave phase [deg]"
    rows = [f"{period}, {direction}, 1.0, 0.0" for period in (1.5, 40.0) for direction in (150, 180, 210)]
    Path("rao.csv").write_text("\n".join([rao, *rows]))
    Path("scenes").mkdir()
    file = f"scenes/{kind}.yaml"
    options = ("--angle", "15", "--su", "3e3", "--gradient", "1e3", "--rao", "rao.csv", "--max-tension", "9e6")
    written = called("new", kind, *options, "-o", file)
    assert written.exit_code == 0, written.output
    assert "no warnings" in written.output
    done = called("run", file, "-o", "out", "--set", "stages.1.duration=1.0")
    assert done.exit_code == 0, done.output
    assert "warning" not in done.output
    at_rest = json.loads(Path("out/summary.json").read_text())["stages"][0]["final"]
    assert 90.0 - at_rest["end"]["angle_deg"] == pytest.approx(15.0, abs=0.02)


@pytest.mark.parametrize("kind", HANGING)
@pytest.mark.parametrize("depth", [80.0, 1200.0])
def test_a_line_hangs_at_its_angle_from_where_it_should_touch_down(kind: str, depth: float) -> None:
    """The angle is by the program's own cable, which stretches, lies on the ground and has all the line's weights."""
    drafted = scene(kind, Wishes(depth=depth))
    cable = build(drafted, communicator_of(drafted)).riser.catenary
    assert cable is not None
    angle = math.degrees(math.asin(cable.H / cable.tension[-1]))
    assert angle == pytest.approx(HANGING[kind], rel=2e-3)
    lifted = cable.curve.position[:, 2] > cable.curve.position[0, 2] + 1e-3
    laid = {"steel-catenary": 0.25, "flexible": 0.4, "lazy-wave": 0.3, "mooring": 0.8}[kind] * depth
    largest = max(segment.element_lengths[0] for segment in drafted.line.segments)
    assert cable.curve.position[lifted.argmax(), 0] == pytest.approx(laid, abs=1.5 * largest)


def test_a_lazy_wave_has_its_hog_and_sag_where_they_are_meant() -> None:
    drafted = scene("lazy-wave", Wishes(depth=400.0))
    cable = build(drafted, communicator_of(drafted)).riser.catenary
    assert cable is not None
    z = cable.curve.position[:, 2]
    turns = [n for n in range(1, len(z) - 1) if z[n] > 1.0 and (z[n + 1] - z[n]) * (z[n] - z[n - 1]) < 0.0]
    assert [float(z[n]) for n in turns] == pytest.approx([0.5 * 390.0, 0.35 * 390.0], rel=0.01)


def test_cross_sections() -> None:
    """A steel pipe by hand; by its mass it is the same; modules lift by the pipe's own weight; chain of 0.1 m."""
    area = math.pi / 4.0 * (0.3**2 - 0.26**2)
    pipe = steel(0.3, 0.02, None)
    assert (pipe.mass, pipe.EA) == pytest.approx((7850.0 * area, 2.07e11 * area), rel=5e-6)
    second = math.pi / 64.0 * (0.3**4 - 0.26**4)
    assert pytest.approx(2.07e11 * second, rel=5e-6) == pipe.EI
    assert steel(0.3, None, pipe.mass).inner == pytest.approx(0.26)
    bare = flexible(0.3, None, 130.0)
    assert (bare.mass, bare.inner) == pytest.approx((130.0, 0.2))
    assert bare.weight == pytest.approx(9.81 * (130.0 + math.pi / 4.0 * (800.0 * 0.2**2 - 1025.0 * 0.3**2)))
    assert buoyant(bare).weight == pytest.approx(-bare.weight, rel=2e-5)
    assert (chain(0.1, None, None).mass, chain(0.1, None, None).outer) == pytest.approx((199.0, 0.18))


def test_what_is_not_asked_for_is_left_out() -> None:
    calm = scene("flexible", Wishes(Hs=0.0))
    assert calm.water is not None
    assert (calm.water.waves, calm.water.current, len(calm.stages)) == (None, None, 1)
    standing = scene("top-tensioned", Wishes())
    assert standing.seabed is None
    mooring = scene("mooring", Wishes(ground="hysteretic"))
    assert mooring.seabed is not None
    assert mooring.seabed.kind == "hysteretic"


@pytest.mark.parametrize("value", [0.0, 0.1365, 50.0, 1025.0, 28208.4, 5.0e4, 99999.6, 3.7023e9, 1e-5, 123456.0])
def test_numbers_are_floats_to_every_reader(value: float) -> None:
    text = number(value)
    assert float(text) == pytest.approx(value, rel=5e-4)
    assert "." in text
    assert "e" not in text or text.partition("e")[2][0] in "+-"


REFUSED = {
    "spar": ("new", "spar"),
    "the kind is missing": ("new",),
    "--depth -1": ("new", "flexible", "--depth", "-1"),
    "--depth 1: too shallow": ("new", "flexible", "--depth", "1"),
    "--diameter nan": ("new", "flexible", "--diameter", "nan"),
    "--wall 0.2: must be less": ("new", "steel-catenary", "--wall", "0.2"),
    "floats": ("new", "steel-catenary", "--diameter", "0.8", "--wall", "0.005"),
    "leave one out": ("new", "top-tensioned", "--wall", "0.02", "--mass", "90"),
    "take less": ("new", "steel-catenary", "--mass", "900"),
    "chain has none": ("new", "mooring", "--wall", "0.01"),
    '--ground "mud"': ("new", "flexible", "--ground", "mud"),
    "does not lie": ("new", "top-tensioned", "--ground", "rigid"),
    "--hs -2": ("new", "flexible", "--hs", "-2"),
    "--tp 0": ("new", "flexible", "--tp", "0"),
    "--current inf": ("new", "flexible", "--current", "inf"),
    "Hs": ("new", "flexible", "--hs", "30", "--tp", "4"),
    "--angle 90: must be at most": ("new", "flexible", "--angle", "90"),
    "--angle 10: a top-tensioned riser stands upright": ("new", "top-tensioned", "--angle", "10"),
    "--su 3000: a top-tensioned riser": ("new", "top-tensioned", "--su", "3e3"),
    "--su 0: must be greater": ("new", "flexible", "--su", "0"),
    "--gradient 900: is of clay, and --ground is rigid": ("new", "flexible", "--gradient", "900", "--ground", "rigid"),
    "has no bore": ("new", "mooring", "--contents", "800"),
    "--contents -1: must be 0": ("new", "flexible", "--contents", "-1"),
    "has no metal wall": ("new", "flexible", "--yield-stress", "448e6"),
    "has no bending stiffness": ("new", "mooring", "--min-bend-radius", "3"),
    "--max-tension -2": ("new", "mooring", "--max-tension", "-2"),
    "--rao none.csv: there is no such file": ("new", "flexible", "--rao", "none.csv"),
    "--hs is 0": ("new", "flexible", "--rao", __file__, "--hs", "0"),
    "test_drafts.py": ("new", "flexible", "--rao", __file__),
}


@pytest.mark.parametrize("message", REFUSED)
def test_bad_input_is_reported_in_a_line_and_leaves_no_file(
    message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = called(*REFUSED[message])
    assert done.exit_code == 2
    assert message in done.output
    assert len(done.output.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_a_file_is_overwritten_only_by_force(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    mine = tmp_path / "mine.yaml"
    mine.write_text("mine")
    call = ("new", "mooring", "-o", str(mine), "--hs", "0")
    refused = called(*call)
    assert (refused.exit_code, mine.read_text()) == (2, "mine")
    assert "--force" in refused.output
    assert called(*call, "--force").exit_code == 0
    assert "Mooring line" in mine.read_text()


def test_an_unknown_kind_is_told_before_a_file_that_is_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("scr.yaml").write_text("mine")
    done = called("new", "scr")
    line_with(done.output.splitlines(), 'new "scr": must be one of', "steel-catenary")
    assert (done.exit_code, Path("scr.yaml").read_text()) == (2, "mine")


def test_a_terminal_is_asked_for_what_is_not_given() -> None:
    answers = iter(["lazy-wave", 200.0, 0.2, "rigid"])
    asked = list[str]()

    def prompt(text: str, default: object) -> object:
        asked.append(text)
        return next(answers)

    assert ask(Wishes(Hs=1.0), prompt) == ("lazy-wave", Wishes(depth=200.0, diameter=0.2, Hs=1.0, ground="rigid"))
    assert len(asked) == 4
