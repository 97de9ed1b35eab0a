"""The errors that a user can meet; each carries the exit status that the command line returns for it."""


class RiserSoilError(Exception):
    """Base of the errors that end a run with a message of one line per problem and no traceback."""

    exit_status = 1


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
