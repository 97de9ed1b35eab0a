"""Reader: from a scene file to a checked scene."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from riser_soil.errors import SceneError
from riser_soil.scene import not_yet
from riser_soil.scene.cross_checks import conflicts
from riser_soil.scene.document import Document, parse, read_text
from riser_soil.scene.explain import problems_in
from riser_soil.scene.overrides import override
from riser_soil.scene.problem import Problem, message
from riser_soil.scene.scene import Scene

_MOST_LINES = 20


def read_scene(file: str | Path, overrides: Sequence[str] = ()) -> Scene:
    """The scene in a file, with `path=value` overrides; SceneError has one line per problem found."""
    document = read_document(file)
    override(document, overrides)
    return checked(document, Path(file).parent)


def read_document(file: str | Path) -> Document:
    """The content of a scene file, as yet unchecked."""
    return parse(read_text(Path(file)), str(file))


def scene_from_mapping(data: dict[str, Any], folder: Path = Path()) -> Scene:
    """A scene from plain data as a file would give it; relative file names are sought in `folder`."""
    return checked(Document("scene", data), folder)


def with_place(message: str, file: str | Path, overrides: Sequence[str] = ()) -> str:
    """`with_place_in` the document of a file with `path=value` overrides."""
    document = read_document(file)
    override(document, overrides)
    return with_place_in(document, message)


def with_place_in(document: Document, message: str) -> str:
    """A message that begins with a path of the scene, as the parts write it, after the place of that path."""
    words = re.split(r"[^\w.]", message, maxsplit=1)[0].split(".")
    if words[0] not in Scene.model_fields:
        return message
    _, place = document.where(tuple(int(word) if word.isdecimal() else word for word in words))
    return f"{place}: {message}"


def checked(document: Document, folder: Path) -> Scene:
    """The scene of a document; files that it names are sought in the folder."""
    data, unsupported = not_yet.taken_out(document.data)
    try:
        scene = Scene.model_validate(data, context={"folder": folder})
    except ValidationError as err:
        others = [p for p in problems_in(err, data) if not _beside(p, unsupported)]
        raise error_of([*unsupported, *others], document) from err
    found = unsupported or conflicts(scene)
    if found:
        raise error_of(found, document)
    return scene


def _beside(problem: Problem, others: Iterable[Problem]) -> bool:
    """Whether a problem may only follow from another one in the same mapping."""
    return any(problem.path[: len(other.path) - 1] == other.path[:-1] for other in others)


def error_of(problems: Sequence[Problem], document: Document) -> SceneError:
    """One line for each problem, with its place in the file."""
    placed = sorted((*document.where(problem.path), message(problem, document.data)) for problem in problems)
    lines = [f"{place}: {text}" for _, place, text in placed]
    more = len(lines) - _MOST_LINES
    return SceneError(
        "\n".join([*lines[:_MOST_LINES], *([f"... and {more} more problems"] if more > 0 else [])])
    )
