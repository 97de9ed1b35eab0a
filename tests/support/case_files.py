"""Case files around a small riser that hangs: a run of a second or two."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from riser_soil.cases.expansion import read_cases
from riser_soil.errors import SceneError

SMALL = """\
title: A small riser
line_types: {pipe: {EA: 1.0e6, EI: 200.0, mass: 20.0, submerged_weight: 150.0, outer_diameter: 0.1}}
riser:
  segments: [{line_type: pipe, length: 12.0, elements: 8}]
  start: {position: [0.0, 0.0, 0.0]}
  end: {position: [9.0, 0.0, 4.0]}
stages: [{name: hang, kind: static}]
"""


def case_file(folder: Path, text: str) -> Path:
    """A case file whose base is the small riser."""
    (folder / "small.yaml").write_text(SMALL, encoding="utf-8")
    file = folder / "sweep.yaml"
    file.write_text(f"base: small.yaml\n{dedent(text)}", encoding="utf-8")
    return file


def require_refusal(file: Path, says: str) -> None:
    """That a case file is refused in one line, which begins with its name and says this."""
    with pytest.raises(SceneError) as refused:
        read_cases(file)
    (line,) = str(refused.value).splitlines()
    assert line.startswith(f"{file}:")
    assert says in line
