"""A file that is written whole or not at all."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from riser_soil.errors import WriteError


@contextmanager
def written_whole(file: Path) -> Iterator[Path]:
    """A path beside the file for the block to write: it takes the file's place then, and vanishes after an error.

    WriteError where it cannot be written.
    """
    part = file.with_name(f".{file.stem}.part{file.suffix}")
    try:
        if not file.parent.is_dir():
            raise WriteError(f"{file}: cannot be written: there is no folder {file.parent}; choose another file")
        yield part
        part.replace(file)
    except OSError as err:
        raise WriteError(f"{file}: cannot be written: {err.strerror or err}; choose another file") from err
    finally:
        if file.parent.is_dir():
            part.unlink(missing_ok=True)
