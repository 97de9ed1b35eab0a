"""What an importer of another program's files hands over: a scene, files beside it, and what they lack."""

from __future__ import annotations

import codecs
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from riser_soil.errors import SceneError
from riser_soil.scene.document import Document
from riser_soil.scene.files import content
from riser_soil.scene.problem import Path as KeyPath

MOST_BYTES = 10_000_000
_ORCAFLEX_BINARY = b"ORCAFLEX"  # near the beginning of its .dat files
_TWIST = 1e-4  # torsional stiffness of a line without bending stiffness, over EA D^2

Remark = tuple[int, str]
"""Line of the file, and what of it the scene does not have."""


@dataclass
class ImportedScene:
    """The scene as a mapping, remarks on what it lacks, and texts of the files that it names, by their names.

    origins: line of the other program's file that a value of the scene comes from, by the value's path in the scene,
    ("riser", "segments", 0); it counts for all values within that have none of their own.
    """

    data: dict[str, Any]
    remarks: list[Remark] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    origins: dict[KeyPath, int] = field(default_factory=dict)

    def document(self, name: str) -> Document:
        """The scene as a document whose lines are those of the other program's file of this name."""
        return Document(name, self.data, self.origins)


def text_of(file: Path) -> str:
    """The text of another program's file; SceneError where it can't be read or is no text."""
    try:
        raw = content(file, MOST_BYTES)
    except OSError as err:
        raise SceneError(f"{file}: can't be read ({err.strerror}); check the file's name") from err
    if _ORCAFLEX_BINARY in raw[:16]:
        raise SceneError(f"{file}: is binary data of OrcaFlex; save it there as text data (.yml), and import that")
    in_pairs = raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    text = raw.decode("utf-16" if in_pairs else "utf-8-sig", errors="replace")
    if "\0" in text:
        raise SceneError(f"{file}: is no text, for it has NUL characters; save it as text in UTF-8")
    return text


def friction(axial: float, lateral: float) -> tuple[dict[str, Any], str]:
    """The part `contact` of a scene with these coefficients along and across, and a remark where it can't have them."""
    if axial and lateral:
        return {"contact": {"friction": {"axial": axial, "lateral": lateral}}}, ""
    remark = f"friction of {axial:g} along and {lateral:g} across: neither may be 0 here"
    return {}, remark if axial or lateral else ""


def twisting_stiffness(EI: float, EA: float, diameter: float) -> float:
    """GJ [N m2] for a line of which a file has none, for three dimensions: as EI; 1e-4 EA D^2 without any.

    The line bears no torque, whatever GJ is, while one of its ends is free to spin.
    """
    return EI or _TWIST * EA * diameter**2
