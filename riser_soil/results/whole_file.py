"""Files that are written whole or not at all, one by one or together."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from riser_soil.errors import RiserSoilError, SceneError, WriteError, is_full


@contextmanager
def written_whole(file: Path) -> Iterator[Path]:
    """A path beside the file for the block to write: it takes the file's place then, and vanishes after an error.

    WriteError where it cannot be written.
    """
    part = file.with_name(f".{file.stem}.part{file.suffix}")
    require_folder_of(file)
    try:
        yield part
        part.replace(file)
    except OSError as err:
        raise WriteError(f"{file}: cannot be written: {err.strerror or err}; choose another file") from err
    finally:
        if file.parent.is_dir():
            part.unlink(missing_ok=True)


def require_folder_of(file: Path) -> None:
    """WriteError where a file has no folder to be written to."""
    if not file.parent.is_dir():
        raise WriteError(f"{file}: cannot be written: there is no folder {file.parent}; choose another file")


@contextmanager
def written_together(folder: Path, names: Sequence[str]) -> Iterator[Path]:
    """A place for the block to write files of these names: they take their places in the folder then, and vanish after
    an error, a folder that was made for them, too.

    WriteError where the disk takes no more, SceneError where it can't be the folder.
    """
    there = folder.is_dir()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        try:
            with tempfile.TemporaryDirectory(dir=folder, prefix=".riser_soil_") as place:
                yield Path(place)
                for name in names:
                    (Path(place) / name).replace(folder / name)
        finally:
            if not there and not any(folder.iterdir()):
                folder.rmdir()
    except OSError as err:
        raise unusable(folder, err) from err


def refuse_file(folder: Path) -> None:
    """Raises SceneError for a result folder that is a file."""
    if os.path.lexists(folder) and not folder.is_dir():
        raise SceneError(f"{folder}: is a file, not a folder; choose another result folder with -o FOLDER")


def refuse_folder(folder: Path, files: Collection[str], what: str, force: bool) -> None:
    """Raises SceneError for a folder that is not empty, unless by force one that has these files alone.

    what: they are, for messages: `a calibration`.
    """
    refuse_file(folder)
    there = sorted(entry.name for entry in folder.iterdir()) if folder.is_dir() else []
    if others := [name for name in there if name not in files]:
        raise SceneError(f"{folder}: holds more than {what}, {others[0]}; choose another with -o FOLDER")
    if there and not force:
        raise SceneError(f"{folder}: holds {what}; overwrite it with --force, or choose another with -o FOLDER")


def unusable(folder: Path, err: OSError, when_full: str = "") -> RiserSoilError:
    """The error of a result folder in which nothing can be written; when_full: said where the disk takes no more."""
    if is_full(err):
        return WriteError(f"{folder}: cannot be written: {err.strerror}{when_full}")
    return SceneError(f"{folder}: cannot be used as the output folder: {err.strerror or err}")
