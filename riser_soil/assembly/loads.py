"""Assembly of the loads on a line and on a body in a stage."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.riser.line import Line
from riser_soil.riser.loads import AppliedLoad, PointLoads
from riser_soil.scene.stages import Load, Stage, StaticStage, VaryingLoad

if TYPE_CHECKING:
    from riser_soil.bodies.body import MovingBody


def loads_of_line(line: Line, given: Sequence[Load], stage: Stage) -> PointLoads:
    """The part of some loads on a line."""
    places = {"start": 0.0, "end": float(line.arc[-1]), None: 0.0}
    arcs = (places[load.at] if isinstance(load.at, str | None) else load.at for load in given)
    return PointLoads(line, [_applied(load, stage, arc) for load, arc in zip(given, arcs, strict=True)])


def loads_of_body(body: MovingBody, given: Sequence[VaryingLoad], stage: Stage) -> PointLoads:
    """The part of some loads on a body."""
    return PointLoads(body, [_applied(load, stage, 0.0) for load in given])


def _applied(given: VaryingLoad, stage: Stage, arc: float) -> AppliedLoad:
    vectors = {k: getattr(given, k, None) for k in ("force", "moment", "distributed")}
    static = isinstance(stage, StaticStage)
    return AppliedLoad(_factor(given, static), arc, **{k: np.asarray(v) for k, v in vectors.items() if v is not None})


def _factor(given: VaryingLoad, static: bool) -> Callable[[float], float]:
    if given.history is None:
        return (lambda t: t) if static else (lambda t: 1.0)
    times, factors = np.array(given.history).T
    return lambda t: float(np.interp(t, times, factors))
