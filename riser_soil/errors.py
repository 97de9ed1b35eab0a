"""Errors that a user can meet, each with the exit status of the command line."""

import errno
import re
import signal

LONGEST = 1200  # characters of a line of a message
_FEW = 8  # items of a long list that are named
_LIST = re.compile(rf"(?:[^,;:()]{{1,80}}, ){{{_FEW + 2},}}[^,;:()]{{1,80}}")


def in_short(message: str) -> str:
    """A message whose lines are readable: of a long one each list has its first items and their number, and what is
    still too long lacks its middle.
    """
    return "\n".join(map(_line_in_short, message.split("\n")))


def _line_in_short(line: str) -> str:
    if len(line) <= LONGEST:
        return line
    line = _LIST.sub(_first_items, line)
    if len(line) <= LONGEST:
        return line
    head, tail = line[: LONGEST // 2], line[-LONGEST // 3 :]
    return f"{head} ... ({len(line) - len(head) - len(tail)} more characters) ... {tail}"


def _first_items(match: re.Match[str]) -> str:
    items = match[0].split(", ")
    return f"{', '.join(items[:_FEW])}, ... ({len(items)} in all)"


class RiserSoilError(Exception):
    """Base of the errors that end a run with a message of one line per problem and no traceback."""

    exit_status = 1

    def __str__(self) -> str:
        return in_short(super().__str__())


class SceneError(RiserSoilError):
    """The scene (or the command line around it) is wrong: nothing was computed."""

    exit_status = 2


class MeshError(RiserSoilError):
    """A mesh file is missing or unusable, or no mesh can be made from the scene: nothing was computed."""

    exit_status = 2


class ResultsError(RiserSoilError):
    """A result folder can't be read or must not be written."""

    exit_status = 2


class SolveError(RiserSoilError):
    """The solve failed; everything up to the last accepted step is kept and marked unfinished."""

    exit_status = 3


class MemoryShortageError(RiserSoilError):
    """The solve ran out of memory, which no smaller step mends; what is kept is as after SolveError."""

    exit_status = 3


class AccuracyError(SolveError):
    """The accuracy that a scene asks for was not reached; the finest run is kept whole, with its error bars."""


class WriteError(RiserSoilError):
    """Results, or what the program prints, can't be written; the files are whole up to the last frame that went in."""

    exit_status = 4


class DiskShortageError(SceneError):
    """The results would not fit on the disk: nothing was computed."""

    exit_status = WriteError.exit_status


class Interruption(KeyboardInterrupt):
    """A signal that asks the program to end; as KeyboardInterrupt passes all that catches errors.

    place: where the run was, and what is in its folder; a run that has told this is concluded, and an error after that
    is one of its own. together: whether all ranks stopped at the same place. announced: whether the user has been told.
    """

    nowhere = "before the first stage; nothing was computed"

    def __init__(self, number: int, together: bool = False) -> None:
        super().__init__(number, together)
        self.number, self.together = number, together
        self.announced = False
        self.place = self.nowhere

    @property
    def concluded(self) -> bool:
        """Whether somebody has seen to it."""
        return self.announced or self.place != self.nowhere

    @property
    def exit_status(self) -> int:
        """Exit status by the convention of shells."""
        return 128 + self.number

    def __str__(self) -> str:
        return f"ended by {signal.Signals(self.number).name} {self.place}"


def is_full(err: OSError) -> bool:
    """Whether a write failed for what the disk, or a limit on it, can't take."""
    return err.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
