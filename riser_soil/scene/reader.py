"""Reader: from a scene file, or data as a file would give it, to a checked scene."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from riser_soil.errors import RiserSoilError, SceneError
from riser_soil.scene.document import Document, parse, read_text, refuse_others
from riser_soil.scene.explain import problems_in
from riser_soil.scene.line_checks import all_conflicts
from riser_soil.scene.overrides import override
from riser_soil.scene.problem import Problem, dotted, message, shown
from riser_soil.scene.scene import Scene
from riser_soil.scene.sizes import doubts
from riser_soil.scene.unsupported import without_unsupported
from riser_soil.scene.void_overrides import void_overrides

_MOST_LINES = 20


def read_scene(file: str | Path, overrides: Sequence[str] = ()) -> Scene:
    """The scene in a file, with `path=value` overrides; SceneError has one line per problem found."""
    return checked(overridden_document(file, overrides), Path(file).parent)


def read_document(file: str | Path) -> Document:
    """The content of a scene file, as yet unchecked; SceneError where it is another kind of file."""
    return refuse_others(parse(read_text(Path(file)), str(file)), "scene")


def overridden_document(file: str | Path, overrides: Sequence[str] = ()) -> Document:
    """The content of a scene file with `path=value` overrides, as yet unchecked."""
    document = read_document(file)
    override(document, overrides)
    return document


def scene_from_mapping(data: dict[str, Any], folder: Path = Path()) -> Scene:
    """A scene from plain data as a file would give it; relative file names are sought in `folder`."""
    return checked(Document("scene", data), folder)


def with_place_in(document: Document, message: str) -> str:
    """A message that begins with a path of the scene, as the parts write it, after the place of that path."""
    words = re.split(r"[^\w.]", message, maxsplit=1)[0].split(".")
    if words[0] not in Scene.model_fields:
        return message
    _, place = document.where(tuple(int(word) if word.isdecimal() else word for word in words))
    return f"{place}: {message}"


def checked(document: Document, folder: Path) -> Scene:
    """The scene of a document; files that it names are sought in the folder."""
    data, unsupported = without_unsupported(document.data)
    try:
        scene = Scene.model_validate(data, context={"folder": folder})
    except ValidationError as err:
        others = [p for p in problems_in(err, data) if not _beside(p, unsupported)]
        raise with_doubts(error_of([*unsupported, *others], document), document) from err
    problems = unsupported or all_conflicts(scene) or [*void_overrides(document, scene)]
    if problems:
        raise with_doubts(error_of(problems, document), document)
    return scene


def with_doubts(error: RiserSoilError, document: Document) -> RiserSoilError:
    """The error after other numbers of the scene that look like those of another unit: it may follow from them."""
    with_units = [each for each in doubts(document.data) if each.names_a_unit]
    others = [each for each in with_units if f" {dotted(each.path)}: " not in str(error)]
    lines = [f"{document.where(path)[1]}: {dotted(path)}: {text}" for path, text in others]
    return type(error)("\n".join([*lines, str(error)]))


def impossible(error: ValidationError) -> SceneError:
    """A model made from a scene, such as elements or cells, breaks a bound of the scene language."""
    first = error.errors(include_url=False)[0]
    made = f"{error.title}: {dotted(first['loc'])}: value {shown(first['input'])}" if first["loc"] else error.title
    return SceneError(f"{made}: {first['msg']}: the scene's numbers lead to this; check the sizes that it follows from")


def _beside(problem: Problem, others: Iterable[Problem]) -> bool:
    """Whether a problem may only follow from another one in the same mapping."""
    return any(problem.path[: len(other.path) - 1] == other.path[:-1] for other in others)


def error_of(problems: Sequence[Problem], document: Document) -> SceneError:
    """One line for each problem, with its place in the file."""
    placed = sorted({(*document.where(problem.path), _with_line(problem, document)) for problem in problems})
    lines = [f"{place}: {text}" for _, place, text in placed]
    more = len(lines) - _MOST_LINES
    return SceneError(
        "\n".join([*lines[:_MOST_LINES], *([f"... and {more} more problems"] if more > 0 else [])])
    )


def _with_line(problem: Problem, document: Document) -> str:
    """The problem in words, with the line of the file where that makes it plain."""
    line = document.line_of(problem.path) if problem.shows_line else ""
    return message(problem, document.data) + (f'; the line is "{line}"' if line else "")
