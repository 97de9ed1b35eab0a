"""Drafts of `riser-soil new`: they run as they come out, hang as asked, and refuse what can't be."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from riser_soil.assembly import build
from riser_soil.assembly.packages import communicator_of
from riser_soil.commands.app import app
from riser_soil.drafts.pipes import buoyant, chain, flexible, steel
from riser_soil.drafts.text import checked_draft, number
from riser_soil.drafts.wishes import Wishes, ask
from riser_soil.scene.document import parse
from riser_soil.scene.reader import checked
from riser_soil.scene.scene import Scene
from tests.support.said import line_with

KINDS = ("steel-catenary", "flexible", "lazy-wave", "top-tensioned", "mooring")
HANGING = {"steel-catenary": 12.0, "flexible": 10.0, "lazy-wave": 12.0, "mooring": 45.0}


def called(*words: str) -> Result:
    return CliRunner().invoke(app, list(words))


@pytest.mark.parametrize("kind", KINDS)
def test_a_draft_is_checked_and_runs_as_it_is(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    written = called("new", kind, "--current", "0.5")
    assert written.exit_code == 0, written.output
    verdict, last = written.output.splitlines()[-2:]
    assert verdict == "no warnings"
    line_with([last], f"{kind}.yaml: written", f"riser-soil run {kind}.yaml")
    checked = called("check", f"{kind}.yaml")
    assert (checked.exit_code, checked.output.splitlines()[-1]) == (0, "no warnings")
    done = called("run", f"{kind}.yaml", "--set", "stages.1.duration=1.0")
    assert done.exit_code == 0, done.output
    assert "warning" not in done.output


def scene(kind: str, wishes: Wishes) -> Scene:
    return checked(parse(checked_draft(kind, wishes, "test"), "test"), Path())


@pytest.mark.parametrize("kind", HANGING)
@pytest.mark.parametrize("depth", [80.0, 1200.0])
def test_a_line_hangs_at_its_angle_from_where_it_should_touch_down(kind: str, depth: float) -> None:
    """By the program's own cable, which stretches, lies on the ground and has all the line's weights."""
    drafted = scene(kind, Wishes(depth=depth))
    cable = build(drafted, communicator_of(drafted)).catenary
    assert cable is not None
    angle = math.degrees(math.asin(cable.H / cable.tension[-1]))
    assert angle == pytest.approx(HANGING[kind], rel=2e-3)
    lifted = cable.curve.position[:, 2] > cable.curve.position[0, 2] + 1e-3
    laid = {"steel-catenary": 0.25, "flexible": 0.4, "lazy-wave": 0.3, "mooring": 0.8}[kind] * depth
    largest = max(segment.element_lengths[0] for segment in drafted.line.segments)
    assert cable.curve.position[lifted.argmax(), 0] == pytest.approx(laid, abs=1.5 * largest)


def test_a_lazy_wave_has_its_hog_and_sag_where_they_are_meant() -> None:
    drafted = scene("lazy-wave", Wishes(depth=400.0))
    cable = build(drafted, communicator_of(drafted)).catenary
    assert cable is not None
    z = cable.curve.position[:, 2]
    turns = [n for n in range(1, len(z) - 1) if z[n] > 1.0 and (z[n + 1] - z[n]) * (z[n] - z[n - 1]) < 0.0]
    assert [float(z[n]) for n in turns] == pytest.approx([0.5 * 390.0, 0.35 * 390.0], rel=0.01)


def test_cross_sections() -> None:
    """A steel pipe by hand; by its mass it is the same; modules lift by the pipe's own weight; chain of 0.1 m."""
    area = math.pi / 4.0 * (0.3**2 - 0.26**2)
    pipe = steel(0.3, 0.02, None)
    assert (pipe.mass, pipe.EA) == pytest.approx((7850.0 * area, 2.07e11 * area))
    second = math.pi / 64.0 * (0.3**4 - 0.26**4)
    assert pytest.approx(2.07e11 * second) == pipe.EI
    assert steel(0.3, None, pipe.mass).inner == pytest.approx(0.26)
    bare = flexible(0.3, None, 130.0)
    assert (bare.mass, bare.inner) == pytest.approx((130.0, 0.2))
    assert bare.weight == pytest.approx(9.81 * (130.0 + math.pi / 4.0 * (800.0 * 0.2**2 - 1025.0 * 0.3**2)))
    assert buoyant(bare).weight == pytest.approx(-bare.weight)
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
    reported = number(value)
    assert float(reported) == pytest.approx(value, rel=5e-4)
    assert "." in reported
    assert "e" not in reported or reported.partition("e")[2][0] in "+-"


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
}


@pytest.mark.parametrize("reported", REFUSED)
def test_bad_input_is_reported_in_a_line_and_leaves_no_file(
    reported: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = called(*REFUSED[reported])
    assert done.exit_code == 2
    assert reported in done.output
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


def test_a_terminal_is_asked_for_what_is_not_given() -> None:
    answers = iter(["lazy-wave", 200.0, 0.2, "rigid"])
    asked = list[str]()

    def prompt(text: str, default: object) -> object:
        asked.append(text)
        return next(answers)

    assert ask(Wishes(Hs=1.0), prompt) == ("lazy-wave", Wishes(depth=200.0, diameter=0.2, Hs=1.0, ground="rigid"))
    assert len(asked) == 4
