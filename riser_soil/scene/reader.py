"""Reader: from a scene file to a checked scene.

Keys and values of the scene language that are not supported yet.

They are named as such instead of being called unknown. A value that switches the thing off is dropped.
"""

import copy
import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from riser_soil.errors import RiserSoilError, SceneError
from riser_soil.scene.document import Document, parse, read_text, refuse_others
from riser_soil.scene.explain import problems_in
from riser_soil.scene.line_checks import all_conflicts
from riser_soil.scene.overrides import override
from riser_soil.scene.problem import Path as KeyPath
from riser_soil.scene.problem import Problem, dotted, matching, message, shown, value_at
from riser_soil.scene.scene import Scene
from riser_soil.scene.sizes import doubts
from riser_soil.scene.void_overrides import void_overrides

_MOST_LINES = 20
# key -> values that mean "off"; the key itself is not part of the models. `*` stands for any name or number.
KEYS: dict[tuple[str, ...], tuple[Any, ...]] = {
    ("stages", "*", "initial_velocity"): (None,),
}


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
    data, unsupported = taken_out(document.data)
    try:
        scene = Scene.model_validate(data, context={"folder": folder})
    except ValidationError as err:
        others = [p for p in problems_in(err, data) if not _beside(p, unsupported)]
        raise with_doubts(error_of([*unsupported, *others], document), document) from err
    found = unsupported or all_conflicts(scene) or [*void_overrides(document, scene)]
    if found:
        raise with_doubts(error_of(found, document), document)
    return scene


def with_doubts(error: RiserSoilError, document: Document) -> RiserSoilError:
    """The error after other numbers of the scene that look like those of another unit: it may follow from them."""
    found = [each for each in doubts(document.data) if each.names_a_unit]
    others = [each for each in found if f" {dotted(each.path)}: " not in str(error)]
    lines = [f"{document.where(path)[1]}: {dotted(path)}: {text}" for path, text in others]
    return type(error)("\n".join([*lines, str(error)]))


def impossible(error: ValidationError) -> SceneError:
    """What the program makes of a scene, such as elements or cells, breaks a bound of the scene language."""
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


def taken_out(data: Any) -> tuple[Any, list[Problem]]:
    """A copy of the data without the keys of KEYS, and problems for what this version does not support, and for
    characters that results can't have.
    """
    rest = copy.deepcopy(data)
    return rest, [*_keys(rest), *_unwritable(rest)]


def _keys(data: Any) -> Iterator[Problem]:
    for pattern, off in KEYS.items():
        for path, value in matching(data, pattern):
            del value_at(data, path[:-1])[path[-1]]
            if not _among(value, off):
                yield Problem(path, "not supported yet", "leave the key out")


def _unwritable(data: Any, path: KeyPath = ()) -> Iterator[Problem]:
    """Texts and keys with characters that no result's file takes: NUL, other control characters, half a surrogate."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        texts = "".join(text for text in (key, value) if isinstance(text, str))
        found = {c for c in texts if unicodedata.category(c) in ("Cc", "Cs")} - {*"\t\n\r"}
        if found:
            named = ", ".join(f"U+{ord(c):04X}" for c in sorted(found))
            yield Problem((*path, key), f"a text has no control characters, which {named} is", "leave them out")
        yield from _unwritable(value, (*path, key))


def _among(value: Any, values: tuple[Any, ...]) -> bool:
    """Membership that tells true from 1."""
    return any(type(value) is type(other) and value == other for other in values)
