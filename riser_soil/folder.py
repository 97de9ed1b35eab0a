"""A run's folder: the names in it, and how it is taken over without ever looking whole before it is."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from riser_soil.errors import SceneError

SCENE = "scene.yaml"
SUMMARY = "summary.json"
SERIES = "results.nc"
RISER_XDMF = "riser.xdmf"
SOIL_XDMF = "soil.xdmf"
_OWN = (SERIES, RISER_XDMF, "riser.h5", SOIL_XDMF, "soil.h5", SCENE, SUMMARY)


def write_atomically(path: Path, text: str) -> None:
    """Replaces the file at once: a reader, or a kill, meets the old text or the new one."""
    draft = _draft(path)
    draft.write_text(text, encoding="utf-8")
    draft.replace(path)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Gives a copy of the file to change, or a name for a new one; it takes the file's place when the block ends well.

    An HDF5 file torn in mid-write cannot be opened at all: a kill must meet it as it was or as it is to be.
    """
    draft = _draft(path)
    if path.exists():
        shutil.copyfile(path, draft)
    yield draft
    draft.replace(path)


def is_finished(folder: Path) -> bool:
    """Whether the folder holds a run that says of itself that it has finished."""
    try:
        summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(summary, dict) and summary.get("finished") is True


def refuse_finished(folder: Path, force: bool) -> None:
    """Raises SceneError when the folder holds a finished run and `force` is not given. Touches nothing."""
    if not force and is_finished(folder):
        raise SceneError(f"{folder}: holds a finished run; choose another folder (-o) or add --force")


def prepare_folder(folder: Path, force: bool) -> None:
    """Makes the folder, or clears a previous run's files (and no others) out of it.

    The old summary goes first, so that a kill in between cannot leave a folder that looks finished.
    """
    refuse_finished(folder, force)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / SUMMARY).unlink(missing_ok=True)
        for name in _OWN:
            (folder / name).unlink(missing_ok=True)
            _draft(folder / name).unlink(missing_ok=True)
    except OSError as err:
        raise SceneError(f"{folder}: cannot be used as the output folder: {err.strerror or err}") from err


def _draft(path: Path) -> Path:
    return path.with_name(f".{path.name}.draft")
