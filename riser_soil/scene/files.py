"""Paths of the files that a scene names, and reading of input files with a size limit."""

import errno
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ValidationInfo, model_validator
from pydantic_core import PydanticCustomError


class GivenByName(BaseModel):
    """Something from a file, for which the file's name alone may stand."""

    @model_validator(mode="before")
    @classmethod
    def _by_name(cls, data: Any) -> Any:
        return {"file": data} if isinstance(data, str) else data


def wrong_file(text: str) -> PydanticCustomError:
    """An error about a named file: what is wrong; what to do."""
    return PydanticCustomError("wrong_file", "{text}", {"text": text})


def _existing(file: Path, info: ValidationInfo) -> Path:
    path = (Path((info.context or {}).get("folder", ".")) / file).absolute()
    if not path.is_file():
        raise wrong_file(f"there is no such file as {path}; correct the name: it is sought beside the scene file")
    return path


def _existing_folder(folder: Path, info: ValidationInfo) -> Path:
    path = (Path((info.context or {}).get("folder", ".")) / folder).absolute()
    if not path.is_dir():
        raise wrong_file(f"there is no such folder as {path}; correct the name: it is sought beside the scene file")
    return path


NamedFile = Annotated[Path, AfterValidator(_existing)]
"""A file that is there, by its absolute path; a relative name is sought beside the scene file."""

NamedFolder = Annotated[Path, AfterValidator(_existing_folder)]
"""A folder that is there, likewise."""


def content(file: Path, most: int) -> bytes:
    """All bytes of a regular file; OSError when it is none (a device may never end) or has more than `most`."""
    if file.exists() and not file.is_file():
        raise OSError(errno.EINVAL, "it is no regular file")
    with file.open("rb") as stream:
        data = stream.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most / 1e6:g} MB")
    return data
