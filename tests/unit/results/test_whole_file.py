"""Files that are written together: all of them or none, in a folder that was there or is made."""

from __future__ import annotations

from pathlib import Path

import pytest

from riser_soil.errors import SceneError
from riser_soil.results.whole_file import refuse_file, written_together
from tests.support.said import telling

NAMES = "a.txt", "b.txt"


def write(folder: Path, names: tuple[str, ...] = NAMES) -> None:
    with written_together(folder, NAMES) as place:
        for name in names:
            (place / name).write_text("new")


def fail_on_the_way(folder: Path) -> None:
    with written_together(folder, NAMES) as place:
        (place / "a.txt").write_text("new")
        raise ValueError("on the way")


def test_all_are_written_and_others_stay(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    (tmp_path / "mine.txt").write_text("mine")
    write(tmp_path)
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        "a.txt": "new", "b.txt": "new", "mine.txt": "mine",
    }  # fmt: skip


def test_after_an_error_there_is_no_folder(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="on the way"):
        fail_on_the_way(tmp_path / "new")
    assert not list(tmp_path.iterdir())


def test_after_an_error_a_folder_is_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    with pytest.raises(ValueError, match="on the way"):
        fail_on_the_way(tmp_path)
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]


def test_what_cannot_be_a_folder_is_said_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(SceneError, match=telling("cannot be used", "Not a directory")) as caught:
        write(tmp_path / "file" / "below")
    assert "\n" not in str(caught.value)
    with pytest.raises(SceneError, match=telling(f"{tmp_path / 'file'}:", "is a file")):
        refuse_file(tmp_path / "file")
    refuse_file(tmp_path / "nothing")
