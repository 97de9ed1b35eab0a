"""Extremes of bodies, joints and clearances over a stage."""

from __future__ import annotations

import numpy as np

from riser_soil.results.bodies_and_joints_figures import BodiesAndJointsExtremes

TIMES = np.array([0.0, 0.5, 1.0, 1.5])
ROWS = {
    "buoy/position": np.array([[0.0, 1.0, -2.0], [3.0, 1.0, -1.0], [1.0, 0.0, -4.0], [2.0, 2.0, -3.0]]),
    "joints/top/force": np.array([5.0, np.nan, 9.0, 7.0]),
}


def followed(*batches: slice) -> BodiesAndJointsExtremes:
    extremes = BodiesAndJointsExtremes()
    for each in batches:
        extremes.update(TIMES[each], {name: values[each] for name, values in ROWS.items()})
    return extremes


def test_extremes_and_the_end_are_nested_by_path_and_nan_does_not_count() -> None:
    nested = followed(slice(None)).nested
    position, force = nested["buoy"]["position"], nested["joints"]["top"]["force"]
    assert position["final"] == [2.0, 2.0, -3.0]
    assert (position["min"], position["t_min"]) == ([0.0, 0.0, -4.0], [0.0, 1.0, 1.0])
    assert (position["max"], position["t_max"]) == ([3.0, 2.0, -1.0], [0.5, 1.5, 0.5])
    assert force == {"final": 7.0, "min": 5.0, "t_min": 0.0, "max": 9.0, "t_max": 1.0}


def test_they_hang_neither_on_batches_nor_on_a_restart() -> None:
    begun, again = followed(slice(0, 1), slice(1, 3)), BodiesAndJointsExtremes()
    again.restore(begun.state())
    for each in (begun, again):
        each.update(TIMES[3:], {name: values[3:] for name, values in ROWS.items()})
        assert each.nested == followed(slice(None)).nested
