"""Where the class of a law of one's own comes from: a Python file or module, its class, and how this is called.

The class is looked up when the scene is read, which runs the user's code. Its constructor takes the law's parameters by
name, and where it asks for them `depth` (n,) [m] and `initial` (n, 6) [Pa], as `SoilLaw.at_points` has them.
"""

from __future__ import annotations

import difflib
import importlib
import importlib.util
import inspect
import sys
import traceback
import typing
from collections.abc import Mapping
from enum import Enum
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, NamedTuple

from pydantic import PlainSerializer, PlainValidator, ValidationInfo, WithJsonSchema
from pydantic_core import PydanticCustomError

PACKAGE = Path(__file__).parents[1]
GIVEN = ("depth", "initial")  # arguments that come from the program
WRITE = 'write from: "my_clay.py:CamClay", a file beside the scene and its class, or "package.module:Class"'


class LawError(Exception):
    """Message of one line about a fault of a law of one's own."""


class LawSource(NamedTuple):
    """A class by its name. file: where its code is, for the scene's identity; module: "" where the file is given."""

    file: Path | None
    module: str
    name: str

    def __str__(self) -> str:
        return f"{self.module or self.file}:{self.name}"

    @property
    def label(self) -> str:
        """The law's name in messages."""
        return f"{self.module or (self.file and self.file.name)}:{self.name}"

    @property
    def loaded(self) -> type[Any]:
        """The class; LawError where there is none, or its code fails."""
        return _class_in(_module(self.module, self.file), self.name, self.label)


def _module(name: str, file: Path | None) -> ModuleType:
    try:
        if name:
            return importlib.import_module(name)
        assert file is not None
        return run_file(file)
    except (Exception, SystemExit) as err:
        raise LawError(failure_in_words(err)) from err


def run_file(file: Path) -> ModuleType:
    """The module of a user's file, which this runs unless it has been run as it is now."""
    return _run(file, file.stat().st_mtime_ns)


@cache
def _run(file: Path, changed: int) -> ModuleType:
    """The module of a file as it was at a time; what lies beside it can be imported, too."""
    if str(file.parent) not in sys.path:
        sys.path.append(str(file.parent))
    name = f"{file.stem}_{abs(hash((file, changed))):x}"
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _class_in(module: ModuleType, name: str, label: str) -> type[Any]:
    member = getattr(module, name, None)
    if isinstance(member, type):
        return member
    classes = [key for key, value in vars(module).items() if isinstance(value, type)]
    own = [key for key in classes if vars(module)[key].__module__ == module.__name__]
    known = f"it has {', '.join(own)}" if own else "it has none"
    raise LawError(f"there is no class {name} in {label.rpartition(':')[0]}; {known}{near(name, own)}")


def near(word: str, known: list[str]) -> str:
    """' (did you mean "..."?)' when a known word is near, else nothing."""
    matches = difflib.get_close_matches(word, known, n=1, cutoff=0.5)
    return f' (did you mean "{matches[0]}"?)' if matches else ""


def failure_in_words(error: BaseException) -> str:
    """An error of the user's code in one line: file, line, kind and text."""
    if isinstance(error, SyntaxError) and error.filename:
        place = f"{Path(error.filename).name}:{error.lineno}: "
    else:
        frames = [frame for frame in traceback.extract_tb(error.__traceback__) if _is_the_users(frame.filename)]
        place = f"{Path(frames[-1].filename).name}:{frames[-1].lineno}: " if frames else ""
    text = error.msg if isinstance(error, SyntaxError) else str(error)
    return f"{place}{type(error).__name__}: {' '.join(text.split())}"


def _is_the_users(file: str) -> bool:
    """Neither this program's nor an installed package's or Python's own."""
    path = Path(file)
    installed = {"site-packages", "dist-packages"} & {*path.parts} or file.startswith(("<", sys.base_prefix + "/lib"))
    return not installed and not path.is_relative_to(PACKAGE)


def _wrong(text: str, key: str | None = None) -> PydanticCustomError:
    return PydanticCustomError("conflict", "{text}", {"text": text} | ({"key": key} if key else {}))


def _source(value: object, info: ValidationInfo) -> LawSource:
    if isinstance(value, LawSource):
        return value
    place, _, name = value.rpartition(":") if isinstance(value, str) else ("", "", "")
    if not place or not name.isidentifier():
        raise _wrong(f"must name a file or module and its class; {WRITE}")
    if not place.endswith(".py"):
        return _of_module(place, name)
    file = (Path((info.context or {}).get("folder", ".")) / place).absolute()
    if not file.is_file():
        raise _wrong(f"there is no such file as {file}; correct the name: it is sought beside the scene file")
    return _checked(LawSource(file, "", name))


def _of_module(module: str, name: str) -> LawSource:
    source = _checked(LawSource(None, module, name))
    file = getattr(sys.modules[module], "__file__", None)
    return source._replace(file=Path(file) if file else None)


def _checked(source: LawSource) -> LawSource:
    try:
        _ = source.loaded
    except LawError as err:
        raise _wrong(f"{err}; correct the name or the code") from err
    return source


Source = Annotated[
    LawSource,
    PlainValidator(_source),
    PlainSerializer(str, when_used="json"),
    WithJsonSchema({"type": "string"}),
]
"""Value of the key `from`: "file.py:Class", the file sought beside the scene, or "package.module:Class"."""


def arguments(law: type[Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters as the constructor takes them, enumerations by the names of their members; PydanticCustomError for
    what it does not know or lacks.
    """
    parameters = _parameters(law)
    if parameters is None:
        return dict(given)
    names = [name for name in parameters if name not in GIVEN]
    for key in given:
        if key in GIVEN:
            raise _wrong(f"comes from the program, for each point; leave {key} out", key)
        if key not in parameters and not _takes_all(parameters):
            has = f"known are {', '.join(names)}" if names else "it has none"
            raise _wrong(f"no such parameter of {law.__name__}, {has}; correct or remove it{near(key, names)}", key)
    for name in names:
        if parameters[name].default is inspect.Parameter.empty and name not in given and not _is_open(parameters[name]):
            raise _wrong(f"the constructor of {law.__name__} requires it; add it", name)
    hints = _hints(law)
    return {key: _as_member(key, value, hints.get(key)) for key, value in given.items()}


def accepted_by(law: type[Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Those of the program's values that are parameters of a law's constructor."""
    parameters = _parameters(law) or {}
    return {key: value for key, value in values.items() if key in parameters}


def _parameters(law: type[Any]) -> dict[str, inspect.Parameter] | None:
    """Parameters of a law's constructor by name; None where Python doesn't know them."""
    try:
        return dict(inspect.signature(law).parameters)
    except (ValueError, TypeError):
        return None


def _is_open(parameter: inspect.Parameter) -> bool:
    return parameter.kind in (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)


def _takes_all(parameters: Mapping[str, inspect.Parameter]) -> bool:
    return any(each.kind is inspect.Parameter.VAR_KEYWORD for each in parameters.values())


def _hints(law: type[Any]) -> dict[str, Any]:
    try:
        return typing.get_type_hints(law.__init__)
    except Exception:  # a hint that only type checkers can resolve
        return {}


def _as_member(key: str, value: Any, hint: Any) -> Any:
    if not (isinstance(hint, type) and issubclass(hint, Enum) and isinstance(value, str)):
        return value
    if value not in hint.__members__:
        raise _wrong(f"must be one of {', '.join(hint.__members__)}; choose one", key)
    return hint[value]
