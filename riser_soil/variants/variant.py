"""Variants of a scene by values at its key paths, and the text and key by which a variant's run is known."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, Self

from riser_soil import __version__
from riser_soil.results.folder import CHECKPOINT
from riser_soil.scene.document import Document
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.identity import paths_in
from riser_soil.scene.overrides import override, put_once
from riser_soil.scene.problem import shown
from riser_soil.scene.reader import checked, read_document
from riser_soil.scene.scene import Scene

Overrides = dict[str, Any]
"""Values by the paths that `run --set` takes."""


@dataclass(frozen=True, eq=False)
class BaseScene:
    """A scene file that is read once, as yet unchecked. folder: where files that it names are sought."""

    document: Document
    folder: Path

    @classmethod
    def read(cls, file: Path | str, overrides: Sequence[str] = (), values: Mapping[str, Any] | None = None,
             place: str = "") -> Self:  # fmt: skip
        """The scene of a file with values by their paths, then with `path=value` overrides.

        place: of the values in messages. SceneError where one can't be.
        """
        document = read_document(file)
        put_values(document, values or {}, place)
        override(document, overrides)
        return cls(document, Path(file).parent)

    def with_values(self, values: Mapping[str, Any], place: str, again: bool = False) -> Scene:
        """The checked scene with values at its paths. place: of the values in messages.

        again: whether a path may have been overridden before. SceneError has one line per problem.
        """
        document = deepcopy(self.document)
        put_values(document, values, place, again)
        return checked(document, self.folder)


def put_values(document: Document, values: Mapping[str, Any], place: str, again: bool = False) -> None:
    """Replace values of a document by their paths; SceneError where one would undo another override."""
    for path, value in values.items():
        put_once(document, path, deepcopy(value), f"{place} {path}={shown(value)}", again)


class Variant(NamedTuple):
    """A scene to be run, as text.

    key: digest of the text, of the files that the scene names and of the program's version: runs with the same key
    have the same results.
    """

    text: str
    key: str


def variant_of(scene: Scene) -> Variant:
    """The scene as text, without a result folder: its results have their place among those of other variants."""
    scene = scene.model_copy(update={"output": scene.output.model_copy(update={"directory": None})})
    text = dump_scene(scene)
    digest = hashlib.sha256(f"{__version__}\n{text}".encode())
    for _, at in paths_in(scene):
        file = at / CHECKPOINT if at.is_dir() else at  # checkpoint of the run with whose end the variant begins
        if file.is_file():
            digest.update(_digest(file, file.stat().st_mtime_ns))
    return Variant(text, digest.hexdigest())


@cache
def _digest(file: Path, modified: int) -> bytes:
    return hashlib.sha256(file.read_bytes()).digest()
