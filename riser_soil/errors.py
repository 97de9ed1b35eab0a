"""Errors that a user can act on; each message is one line."""


class SceneError(Exception):
    """The scene, a file it names, or the output folder cannot be used."""


class MeshError(Exception):
    """A mesh is missing, broken or unfit."""


class SolveError(Exception):
    """The solver gave up; the message says where the residual sits."""


class ResultsError(Exception):
    """A run folder cannot be read."""
