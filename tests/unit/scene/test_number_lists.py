"""Long lists of numbers are read at once, and as the YAML reader would; files have bounds."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from riser_soil.errors import SceneError
from riser_soil.scene import document
from riser_soil.scene.document import Document, parse, read_text
from riser_soil.scene.number_lists import without_lists
from tests.support.said import telling

N = 250
PAIRS = ", ".join(f"[{n}, -{n}.5e-3]" for n in range(N))
LISTS = {
    "flow": f"a: {{b: [{PAIRS}], c: 3}}\nd: 4\n",
    "flow over lines": "a: {b: [\n" + "".join(f"    [{n}, 0.5],\n" for n in range(N)) + "    [1]\n  ], c: 3}\nd: 4\n",
    "rows of lists": "a:\n" + "".join(f"  - [{n}, 0.5]\n" for n in range(N)) + "d: 4\n",
    "rows of numbers": "a:\n" + "".join(f"- {n}.25\n" for n in range(N)) + "d: 4\n",
    "open points": "a: [" + "1., 2.e3, " * N + "2]\nb: 1\n",
    "rows with remarks": "a:\n" + "".join(f"- [{n}, 2.]  # [{n}]\n" for n in range(N)) + "- [1, 2]",
    "lines of Windows": "a:\r\n" + "".join(f"- [{n}]\r\n" for n in range(N)) + "b: [" + "1,\r\n" * N * 4 + "2]\r\n",
    "deep": "a:\n  b:\n    - {c: 1}\n    - {c: [" + "1, " * N * 4 + "2]}\n    - 3\n",
    "two": f"a: [{PAIRS}]\nb: [{PAIRS}]\n",
    "shared": f"a: &x [{PAIRS}]\nb: *x\n",
    "quoted": f"a: '[{PAIRS}]'\nb: 1\n",
    "comment": f"a: 1 # [{PAIRS}]\nb: 1\n",
    "a word in it": f"a: [{PAIRS}, auto]\nb: 1\n",
    "no plain numbers": "a: [" + "01, +1, 1., " * N + "2]\nb: 1\n",
    "a comma too many": f"a: [{PAIRS},]\n",
    "words of numbers": "a: [" + "1 2, " * N + "2]\n",
    "rows beside others": "a:\n  - x\n" + "".join(f"  - {n}\n" for n in range(N)) + "  - y\nb: 1\n",
    "followed by digits": f"a: [{PAIRS}]\n\n\n1: [2]\n",
}


def slowly(text: str, monkeypatch: pytest.MonkeyPatch) -> Document:
    """The text as the YAML reader reads it."""
    with monkeypatch.context() as patch:
        patch.setattr(document, "without_lists", lambda text: (text, {}))
        return parse(text, "scene")


@pytest.mark.parametrize("name", LISTS)
def test_values_and_lines_are_those_of_the_yaml_reader(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    fast, slow = parse(LISTS[name], "scene"), slowly(LISTS[name], monkeypatch)
    assert repr(fast.data) == repr(slow.data)  # 1 and 1.0 are different
    assert fast.lines == slow.lines


SHORTENED = ["flow", "flow over lines", "rows of lists", "rows of numbers", "open points", "rows with remarks"]
SHORTENED += ["lines of Windows", "deep", "two", "shared"]


@pytest.mark.parametrize("name", SHORTENED)
def test_long_lists_leave_the_text(name: str) -> None:
    short, lists = without_lists(LISTS[name])
    assert len(short) < 100 + LISTS[name].count("\n")
    assert short.count("\n") == LISTS[name].count("\n")
    assert all(short[place] == "[" for place in lists)


def test_lists_that_are_shared_are_not_the_same() -> None:
    data = parse(LISTS["shared"], "scene").data
    data["a"][0][0] = 7
    assert data["b"][0][0] == 0


def test_wrong_text_behind_a_long_list_is_reported_with_its_line() -> None:
    with pytest.raises(SceneError, match=rf"^scene:{N + 3}: not valid YAML"):
        parse(LISTS["rows of lists"] + "e: ]\n", "scene")


def test_very_many_values_are_refused() -> None:
    with pytest.raises(SceneError, match=r"more than 1000000 values"):
        parse("a: [" + "0," * 1_000_000 + "1]\n", "scene")


def test_a_very_long_text_beside_its_lists_is_refused() -> None:
    with pytest.raises(SceneError, match=telling("3000003 letters", "lists", "more than 2000000")):
        parse("a: " + "x" * 3_000_000, "scene")


def test_endless_files_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for file in (Path("/dev/zero"), tmp_path / "pipe"):
        with pytest.raises(SceneError, match=telling("can't be read", "no regular file")):
            read_text(file)


def test_large_files_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    with file.open("wb") as stream:
        stream.truncate(64_000_001)
    with pytest.raises(SceneError, match=telling("can't be read", "larger than 64 MB")):
        read_text(file)
