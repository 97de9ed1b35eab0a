"""Folder of a case: what became of it, and how a run that has ended gets its place.

A case is computed in a folder of its own among the attempts, and takes its place when it has ended. So a case that is
begun twice, as its worker seemed dead, has one folder all the same, and what stands at its place has come to an end.
"""

from __future__ import annotations

import errno
import json
import shutil
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self
from uuid import uuid4

from riser_soil.results.folder import SCENE, is_finished

CASES, ATTEMPTS = "cases", ".attempts"
_FORMER = ".former"
CASE, SAID = "case.json", "said.txt"  # what became of it, and what the run said
TABLE, EXTREMES, CHARACTERISTIC, DATA, PLOT = FILES = (  # of all cases
    *("cases.csv", "extremes.csv", "characteristic.csv"),
    *("cases.nc", "cases.png"),
)


@dataclass(frozen=True)
class Outcome:
    """What became of a case.

    status: exit status of its run; reason: why it failed. seconds: from its start to its end. machine: where it was
    computed.
    """

    name: str
    key: str
    status: int
    reason: str = ""
    seconds: float = 0.0
    machine: str = ""

    @property
    def done(self) -> bool:
        return self.status == 0

    @classmethod
    def of(cls, content: Mapping[str, Any]) -> Self:
        return cls(**{name: content[name] for name in cls.__dataclass_fields__})

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def place(folder: Path, name: str) -> Path:
    """Where a case has its results."""
    return folder / CASES / name


def found(folder: Path, name: str, key: str) -> Outcome | None:
    """The outcome of a case whose results are there; None where they are not, or those of another scene."""
    try:
        outcome = Outcome.of(json.loads((place(folder, name) / CASE).read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return outcome if outcome.done and outcome.key == key and is_finished(place(folder, name)) else None


def attempt(folder: Path, name: str, scene: str) -> Path:
    """A new folder in which a case can be computed, with its scene, as text, in it.

    Raises OSError, also where the folder of all cases isn't there, as on a machine that does not share it.
    """
    made = folder / CASES / ATTEMPTS / f"{name}.{uuid4().hex}"
    made.mkdir()
    (made / SCENE).write_text(scene, encoding="utf-8")
    return made


def running(folder: Path) -> set[str]:
    """Names of cases that are being computed."""
    with suppress(OSError):
        attempts = [entry.name for entry in (folder / CASES / ATTEMPTS).iterdir()]
        return {name.rpartition(".")[0] for name in attempts if not name.endswith(_FORMER)}
    return set()


def settle(made: Path, folder: Path, outcome: Outcome) -> Outcome:
    """Give an attempt that has ended the case's place; what stood there goes, unless it is the same, finished."""
    (made / CASE).write_text(json.dumps(outcome.as_dict(), indent=1) + "\n", encoding="utf-8")
    target, former = place(folder, outcome.name), made.with_suffix(_FORMER)
    while (known := found(folder, outcome.name, outcome.key)) is None:
        with suppress(FileNotFoundError):
            target.rename(former)
        try:
            made.rename(target)
        except OSError as err:
            if err.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                raise
            continue  # another attempt was quicker
        shutil.rmtree(former, ignore_errors=True)
        return outcome
    shutil.rmtree(made, ignore_errors=True)
    return known


def clear_attempts(folder: Path) -> None:
    """Remove what workers that died have left; the folder of the cases, too, where none has ended."""
    shutil.rmtree(folder / CASES / ATTEMPTS, ignore_errors=True)
    with suppress(OSError):  # holds cases, or isn't there
        (folder / CASES).rmdir()
