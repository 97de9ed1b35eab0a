"""Elements of a pipe without a scene."""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.riser.sections import Elements, Surroundings, elements

IN_AIR = Surroundings()
WEIGHTLESS = Surroundings(gravity=0.0)


def pipe(length: float, count: int, around: Surroundings = IN_AIR, **properties: Any) -> Elements:
    """So many equal elements of one kind of pipe; properties as in `sections.elements`, EI about both axes."""
    EI = properties.pop("EI", None)
    bending = {} if EI is None else {"EI_y": EI, "EI_z": EI}
    return elements(np.full(count, length / count), around, **bending, **properties)
