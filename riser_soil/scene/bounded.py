"""Reading of input files with a size limit."""

import errno
from pathlib import Path


def content(file: Path, most: int) -> bytes:
    """All bytes of a regular file; OSError when it is none (a device may never end) or has more than `most`."""
    if file.exists() and not file.is_file():
        raise OSError(errno.EINVAL, "it is no regular file")
    with file.open("rb") as stream:
        found = stream.read(most + 1)
    if len(found) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most / 1e6:g} MB")
    return found
