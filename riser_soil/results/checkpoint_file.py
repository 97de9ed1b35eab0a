"""Checkpoint of a run, checkpoint.npz: the saved state of all ranks, with what a run that resumes must have in common.

A zip of arrays as numpy writes them, each with a checksum. `about` is JSON; `0/stepper/before/u` is rank 0's array of
that name, see `saved_state`.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.core.saved_state import AnyArray, Saved, packed, unpacked, within
from riser_soil.errors import ResultsError
from riser_soil.results.folder import synchronise, write_atomically

FORMAT = 3  # grows with each change of what the file holds, or of what its arrays mean
_ABOUT = "about"


@dataclass(frozen=True)
class About:
    """Run and place in it of a checkpoint.

    scene: from `identity_of`, with sizes in numbers; ended: name of the stage that ends with it, None within a stage.
    """

    version: str
    ranks: int
    scene: dict[str, Any]
    ended: str | None = None
    format: int = FORMAT


@dataclass(frozen=True, eq=False)
class CheckpointFile:
    """A checkpoint that was read: shares[n] is the state of rank n."""

    about: About
    shares: list[Saved]


def write_checkpoint(path: Path, about: About, shares: Sequence[Saved]) -> None:
    """Replaces the file at once, and lasts through a power loss; OSError where the disk takes no more."""
    arrays: Saved = {_ABOUT: packed(asdict(about))}
    for rank, share in enumerate(shares):
        arrays |= {f"{rank}/{name}": value for name, value in share.items()}
    content = io.BytesIO()  # a zip that a full disk cuts short can't be closed
    np.savez(content, **dict[str, Any](arrays))
    write_atomically(path, content.getbuffer(), lasting=True)
    synchronise(path.parent)


def read_checkpoint(path: Path) -> CheckpointFile:
    """ResultsError where it is damaged, or has been written by a version with another format."""
    try:
        with np.load(path, allow_pickle=False) as file:
            about = _about(file[_ABOUT], path)
            arrays: Saved = {name: file[name] for name in file.files if name != _ABOUT}
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, zlib.error) as err:
        raise ResultsError(f"{path}: is not a whole checkpoint ({err}); begin anew by --force") from err
    return CheckpointFile(about, [within(arrays, str(rank)) for rank in range(about.ranks)])


def is_checkpoint(path: Path) -> bool:
    """Whether a file is a checkpoint, of whatever version."""
    try:
        with np.load(path, allow_pickle=False) as file:
            return {"version", "ranks", "scene"} <= unpacked(file[_ABOUT]).keys()
    except (OSError, ValueError, KeyError, TypeError, AttributeError, EOFError, zipfile.BadZipFile, zlib.error):
        return False


def _about(array: AnyArray, path: Path) -> About:
    content = unpacked(array)
    if content["format"] != FORMAT:
        raise ResultsError(
            f"{path}: was written by riser_soil {content['version']} in format {content['format']}, and this one "
            f"reads {FORMAT}; begin anew by --force"
        )
    return About(**content)
