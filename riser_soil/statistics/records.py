"""Records of an output in time, from the files of runs, without the transient, evenly spaced."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.results.cycles import SLACK, beginning, dynamic_stage
from riser_soil.results.read import Run

FEWEST = 20  # records that statistics take
COMPONENTS = {"x": 0, "y": 1, "z": 2}
SIZE = "size"  # component name for a vector's size


class Records(NamedTuple):
    """An output of several runs, such as one for each seed of the waves.

    name: with its component. units. step: between values [s], the same in all runs: that between most records of the
    coarsest. begin: time of the first run's first values, from its stage's beginning on [s]. arc (m,): of the places
    along the riser [m]; one that is nan of an output of the riser as a whole. values: of each run (n, m).
    """

    name: str
    units: str
    step: float
    begin: float
    arc: Array
    values: list[Array]

    @property
    def duration(self) -> float:
        """Simulated time of all runs together [s]."""
        return self.step * sum(len(values) - 1 for values in self.values)


class _Sampled(NamedTuple):
    """Times (n,) [s] since the transient's end, and values there (n, m)."""

    time: Array
    values: Array


def records_of(
    runs: Sequence[Run], name: str, arcs: Sequence[float] | None, stage: str | None = None, since: float = 0.0
) -> Records:
    """An output of a dynamic stage, by default the last, linear between nodes and between records.

    name: a variable of results.nc, such as `end_force` or `joints/hinge/force`; of a vector `end_force.x` or
    `end_force.size`. arcs: places along the riser [m], None for all nodes. since: s of the stage that are left out, as
    the transient. Raises ResultsError.
    """
    variable, _, component = name.partition(".")
    output = _output(runs, variable)
    if output.vector != (component in (*COMPONENTS, SIZE)) or (not output.vector and component):
        remedy = f"write {variable}.x, .y, .z or .size" if output.vector else f"write {variable}"
        raise ResultsError(f"--of {name}: {variable} is {'a vector' if output.vector else 'a number'}; {remedy}")
    places = _places(runs, arcs) if output.along else np.array([np.nan])
    sampled = [_sampled(run, variable, component, places, stage, since) for run in runs]
    step = max(float(np.median(np.diff(each.time))) for each in sampled)
    evened = [_even(each, step) for each in sampled]
    for run, values in zip(runs, evened, strict=True):
        if len(values) < FEWEST:
            raise ResultsError(
                f"{run.place}: has {len(values)} values at the step of the coarsest run, {step:g} s, fewer than "
                f"{FEWEST}; take runs of like output.interval together"
            )
    return Records(name, output.units, step, float(sampled[0].time[0]), places, evened)


class _Output(NamedTuple):
    """units; whether it is a vector, and whether it is known along the riser."""

    units: str
    vector: bool
    along: bool


def _output(runs: Sequence[Run], name: str) -> _Output:
    """Unit and kind of an output of a riser or line, or, with a slash in its name, of bodies, joints and clearances
    that all runs have.
    """
    known = {
        output.name: _Output(output.units, output.vector, output.where == "nodes")
        for output in outputs.of_instant()
        if output.where in ("nodes", "model")
    }
    for run in runs if "/" in name else ():
        known |= {path: _Output(units, vector, False) for path, (units, vector) in run.bodies_and_joints.items()}
        if name not in known:
            there = ", ".join(run.bodies_and_joints) or "no body, joint or clearance"
            raise ResultsError(f"--of {name}: is not in {run.place}, which has {there}")
    if name not in known:
        raise ResultsError(f"--of {name}: is none of the outputs in time; they are {', '.join(known)}")
    return known[name]


def _places(runs: Sequence[Run], arcs: Sequence[float] | None) -> Array:
    for run in runs:
        if arcs is None and not np.array_equal(run.arc, runs[0].arc):
            raise ResultsError(f"{run.place}: has other nodes than {runs[0].place}; give places with --arc")
        beyond = [arc for arc in arcs or () if not run.arc[0] <= arc <= run.arc[-1]]
        if beyond:
            raise ResultsError(
                f"--arc {beyond[0]:g}: is not on the riser of {run.place}, which is {run.arc[-1]:g} m long"
            )
    return runs[0].arc if arcs is None else np.array(arcs, dtype=float)


def _sampled(run: Run, variable: str, component: str, places: Array, stage: str | None, since: float) -> _Sampled:
    number = dynamic_stage(run, stage)
    time = run.time - beginning(run, number)
    chosen = (run["stage"] == number) & (time >= since)
    if np.count_nonzero(chosen) < FEWEST:
        raise ResultsError(
            f'{run.place}: stage "{run.stage_names[number]}" has {np.count_nonzero(chosen)} records from {since:g} s '
            f"on, fewer than {FEWEST}; take a longer stage or a shorter --since"
        )
    values = _component(run[variable][chosen], component)
    if not np.isnan(places).any():
        values = np.array([np.interp(places, run.arc, row) for row in values])
    values = values.reshape(len(values), -1)
    if not np.isfinite(values).all():
        raise ResultsError(f"{run.place}: {variable} is not known at all times; choose another place or output")
    return _Sampled(time[chosen], values)


def _component(values: Array, component: str) -> Array:
    if component == SIZE:
        return np.asarray(np.linalg.norm(values, axis=-1))
    return values[..., COMPONENTS[component]] if component else values


def _even(sampled: _Sampled, step: float) -> Array:
    """Values (n, m) at multiples of the step, linear between records: these themselves where they are even."""
    time, values = sampled
    count = int(np.floor((time[-1] - time[0]) / step + SLACK)) + 1
    at = time[0] + step * np.arange(count)
    return np.stack([np.interp(at, time, column) for column in values.T], axis=1)
