"""Ownership of result files: a run replaces only files that this program has written.

A file of the same name that somebody else wrote, or changed since, is refused, whatever else is allowed.
"""

from __future__ import annotations

import hashlib
import html
import json
import re
from collections.abc import Callable
from pathlib import Path

import h5py

from riser_soil.core.communicator import Communicator
from riser_soil.errors import SceneError, WriteError
from riser_soil.results.checkpoint_file import is_checkpoint
from riser_soil.results.folder import (
    CHECKPOINT,
    FORMER_RISER_NUMBERS,
    FORMER_SOIL_NUMBERS,
    RISER_NUMBERS,
    RISER_XDMF,
    SCENE,
    SERIES,
    SOIL_NUMBERS,
    SOIL_XDMF,
    SUMMARY,
    FolderLock,
    is_finished,
    names_in,
)
from riser_soil.results.growing_file import reading
from riser_soil.results.whole_file import unusable

PROGRAM = "riser_soil"
XDMF_HEAD = """<?xml version="1.0"?>
<Xdmf Version="3.0">
 <Domain>
  <Grid Name={name} GridType="Collection" CollectionType="Temporal">
"""
_SEAL = "# Written by riser_soil, which replaces this file as long as it is unchanged: sha256 {}\n"
_SEALED = re.compile(_SEAL.format("([0-9a-f]{64})").encode())
_FRAMES = re.compile(r"frame_\d+|cells|points")


def quoted(text: str) -> str:
    """A text as the value of an XML attribute. The standard library's xml.sax would import all of HTTP for it."""
    return f'"{html.escape(text)}"'


def sealed(text: str) -> str:
    """The text below a line with its checksum, by which changes of it are known."""
    return _SEAL.format(hashlib.sha256(text.encode()).hexdigest()) + text


def refuse(folder: Path, force: bool, goes_on: bool = False) -> None:
    """Raises SceneError when a run may not have the folder. Touches nothing.

    It may not while another run writes there; where it would replace what the program has not written; and without
    `force` where a finished run is, or one with a checkpoint, unless the run goes on from that.
    """
    try:
        if not force and is_finished(folder):
            raise SceneError(f"{folder}: holds a finished run; choose another folder (-o) or add --force")
        FolderLock.try_out(folder)
        for name in names_in(folder):
            _refuse_foreign(folder / name)
        if not (force or goes_on) and (folder / CHECKPOINT).exists():
            raise SceneError(
                f"{folder}: holds an unfinished run; go on with it by --restart, overwrite it by --force, or choose "
                "another folder (-o)"
            )
    except OSError as err:
        raise unusable(folder, err, "; nothing was computed") from err


def refuse_together(folder: Path, force: bool, comm: Communicator, goes_on: bool = False) -> None:
    """`refuse` on all ranks by what the first one sees; collective."""
    failure = None
    if comm.rank == 0:
        try:
            refuse(folder, force, goes_on)
        except (SceneError, WriteError) as err:
            failure = err
    if failure := comm.bcast(failure):
        raise failure


def prepare(folder: Path, force: bool, goes_on: bool = False) -> FolderLock:
    """Makes the folder, or clears a previous run's files (and no others) out of it; returns its lock.

    The old summary goes first, so that a kill in between cannot leave a folder that looks finished. The scene stays
    until there is another: it may be the one that is run. goes_on: that run goes on, and its files stay.
    """
    refuse(folder, force, goes_on)
    try:
        lock = FolderLock(folder)
        lock.clear()
        for name in names_in(folder):
            _refuse_foreign(folder / name)
        for name in () if goes_on else names_in(folder):
            if name != SCENE:
                (folder / name).unlink(missing_ok=True)
    except OSError as err:
        raise unusable(folder, err, "; nothing was computed") from err
    return lock


def _refuse_foreign(path: Path) -> None:
    if path.is_symlink() or (path.exists() and not (path.is_file() and _owner(path)(path))):
        raise SceneError(
            f"{path}: was not written by riser_soil, or has been changed since, and would be replaced; move it away, "
            "or choose another folder (-o)"
        )


def _owner(path: Path) -> Callable[[Path], bool]:
    """Test of a file by its name: whether this program has written it."""
    return _OWN.get(path.name) or (_own_xdmf if path.suffix == ".xdmf" else _own_numbers)


def _own_scene(path: Path) -> bool:
    """Whether this program has written the scene, by its seal. Earlier versions had none: their scene is older than the
    results beside it, if it has not been changed.
    """
    text = path.read_bytes()
    if seal := _SEALED.match(text):
        return hashlib.sha256(text[seal.end() :]).hexdigest() == seal[1].decode()
    return _of_earlier_version(path.parent) and path.stat().st_mtime <= (path.parent / SERIES).stat().st_mtime


def _of_earlier_version(folder: Path) -> bool:
    names = SUMMARY, SERIES, FORMER_RISER_NUMBERS
    own = all((folder / name).is_file() and _OWN[name](folder / name) for name in names)
    return own and not _says(folder / FORMER_RISER_NUMBERS, lambda file: "source" in file.attrs)


def _own_summary(path: Path) -> bool:
    try:
        summary = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        return False
    return isinstance(summary, dict) and {"finished", "version", "stages", "parts"} <= summary.keys()


def _own_xdmf(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(200).startswith(XDMF_HEAD.format(name=quoted(path.stem)).encode())


def _own_series(path: Path) -> bool:
    return _says(path, lambda file: str(file.attrs.get("source", "")).startswith(PROGRAM))


def _own_numbers(path: Path) -> bool:
    """Earlier versions did not sign them."""
    return _says(path, lambda file: "source" in file.attrs or all(map(_FRAMES.fullmatch, file)))


def _says(path: Path, question: Callable[[h5py.File], bool]) -> bool:
    """Whether something is so in an HDF5 file; false for a file that isn't one."""
    try:
        with reading(path) as file:
            return question(file)
    except OSError:
        return False


_OWN: dict[str, Callable[[Path], bool]] = {
    SUMMARY: _own_summary,
    SERIES: _own_series,
    RISER_XDMF: _own_xdmf,
    RISER_NUMBERS: _own_numbers,
    SOIL_XDMF: _own_xdmf,
    SOIL_NUMBERS: _own_numbers,
    FORMER_RISER_NUMBERS: _own_numbers,
    FORMER_SOIL_NUMBERS: _own_numbers,
    CHECKPOINT: is_checkpoint,
    SCENE: _own_scene,
}
