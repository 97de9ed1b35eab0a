"""Peaks between nodes and between steps: of known curves, sampled beside their tops."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import as_list
from riser_soil.core.snapshot import Record
from riser_soil.results.figures import pack, places_of
from riser_soil.results.peaks import WINDOWS, RunPeaks, least_between_nodes, vertex, with_least_between_nodes
from tests.support.recorded_run import Catenary, changed, stacked

ARC = np.linspace(0.0, 150.0, 31)


def test_vertex_of_a_parabola_is_exact_at_any_spacing() -> None:
    t = np.array([0.0, 0.3, 1.1])
    values = np.stack([2.0 - 3.0 * (t - 0.4) ** 2, 5.0 + (t - 0.35) ** 2, t], axis=1)
    assert vertex(t, values) == pytest.approx([2.0, 5.0, 0.3])  # the third has no extreme in the middle


def test_peak_between_nodes_is_of_higher_order() -> None:
    """A cosine's bottom, sampled at uneven places: the miss falls by 16 as the spacing halves, at the nodes by 4."""
    missed, at_nodes = [], []
    for h in (0.2, 0.1):
        arc = np.arange(-8, 9) * h + 0.31 * h
        missed.append(1.0 + least_between_nodes(arc, -np.cos(arc)))
        at_nodes.append(1.0 - np.cos(arc).max())
    assert missed[0] / missed[1] == pytest.approx(16.0, rel=0.05)
    assert at_nodes[0] / at_nodes[1] == pytest.approx(4.0, rel=0.05)


def test_peak_at_an_end_stays_there() -> None:
    assert least_between_nodes(np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 3.0])) == 0.0


def record_at(t: float) -> Record:
    """Catenary whose largest moment grows and falls with time."""
    record = Catenary(32.0, 30.0).record(ARC)
    return changed(record, largest_moment=record.largest_moment * np.cos(t))


def test_only_what_sits_between_nodes_is_replaced() -> None:
    """The least tension is the only figure at nodes."""
    tension = (ARC - 67.0) ** 2
    at_node = {"least_tension": tension.min(), "least_tension_arc": ARC[tension.argmin()]}
    least = changed(record_at(0.0), effective_tension=tension, **at_node)
    many = stacked([least])
    plain, (peaked,) = pack(least), with_least_between_nodes(many, pack(many))
    replaced = np.flatnonzero(~np.isclose(plain, peaked, equal_nan=True))
    assert set(replaced) == {places_of("min_effective_tension").start}
    assert plain[replaced] == pytest.approx([4.0])
    assert peaked[replaced] == pytest.approx([0.0], abs=1e-9)


def test_extremes_of_a_stage_three_ways() -> None:
    """The largest moment passes between two steps of 0.3; a static stage's end is no extreme in time."""
    peaks = RunPeaks()
    peaks.begin_stage("motion", "dynamic")
    for t in np.arange(-1.0, 1.0, 0.3).tolist():
        peaks.record([t], {"": stacked([record_at(t)])})
    largest = {
        which: peaks.as_summary(which)["stages"][0]["extremes"]["max_bending_moment"]["max"]
        for which in ("sampled", "of_nodes", "peaks")
    }
    top = pack(record_at(0.0))[places_of("max_bending_moment")].item()
    assert largest["sampled"] == pytest.approx(record_at(0.1).largest_moment)
    assert largest["of_nodes"] == pytest.approx(top * np.cos(0.1))
    assert largest["peaks"] == pytest.approx(top, rel=3e-4)


@pytest.mark.parametrize("kind", ["static", "quasi-static", "dynamic"])
def test_a_stage_along_t_begins_with_the_end_of_the_stage_before(kind: str) -> None:
    """The largest moment is that of the static stage's end, but in another static stage."""
    peaks = RunPeaks()
    for name, stage, t in (("lay", "static", 0.0), ("on", kind, 1.0)):
        peaks.begin_stage(name, stage)
        peaks.record([t], {"": stacked([record_at(t)])})
    for which in ("sampled", "of_nodes", "peaks"):
        extremes = peaks.as_summary(which)["stages"][1]["extremes"]["max_bending_moment"]
        first = 1.0 if kind == "static" else 0.0
        assert extremes["max"] == pytest.approx(record_at(first).largest_moment)


@pytest.mark.parametrize("steps", [40, 60, 160])
def test_a_motion_has_extremes_in_windows_of_its_time(steps: int) -> None:
    """Sixteen of 2 s, between steps too, to second order at their edges; a figure that is none has none."""
    t = np.linspace(0.0, 2.0, steps + 1)
    (stage,) = followed(t, 5.0 * np.cos(np.pi * t), duration=2.0).stages[0].values()
    edges = 5.0 * np.cos(np.pi * np.arange(WINDOWS + 1) / 8.0)
    missed = 5.0 / 8.0 * (np.pi * 2.0 / steps) ** 2
    for which, extreme in (("max", np.maximum), ("min", np.minimum)):
        windows = stage.in_windows("max_bending_moment", which)
        assert windows == pytest.approx(extreme(edges[1:], edges[:-1]), abs=missed)
    assert stage.in_windows("no figure", "max").size == 0


def test_equilibria_have_no_windows_of_time() -> None:
    t = np.linspace(0.0, 2.0, 21)
    (still,) = followed(t, t, duration=2.0, kind="quasi-static").stages[0].values()
    assert still.in_windows("max_bending_moment", "max").size == 0


def test_a_window_knows_what_passes_between_steps() -> None:
    """A parabola's top, 100 between two steps of 0.3, and 99.8 at the nearest of them."""
    t = np.arange(7) * 0.3
    (stage,) = followed(t, 100.0 - 20.0 * (t - 1.0) ** 2, duration=2.0).stages[0].values()
    assert stage.in_windows("max_bending_moment", "max")[7] == pytest.approx(100.0)


def followed(t: np.ndarray, moment: np.ndarray, duration: float = 1.0, kind: str = "dynamic") -> RunPeaks:
    """Peaks of a stage of a catenary whose largest moment is given at steps t."""
    peaks = RunPeaks()
    peaks.begin_stage("motion", kind, duration)
    line = Catenary(32.0, 30.0).record(ARC)
    of_steps = [changed(line, largest_moment=size, largest_moment_arc=ARC[0]) for size in moment]
    peaks.record(as_list(t), {"": stacked(of_steps)})
    return peaks


def of_five(t: np.ndarray, moment: np.ndarray) -> float:
    """The largest moment of a stage without what rings; moment: at steps t."""
    summary = followed(t, moment).as_summary("smooth")
    largest: float = summary["stages"][0]["extremes"]["max_bending_moment"]["max"]
    return largest


RINGS = np.where(np.arange(21) % 2, -3.0, 3.0)


@pytest.mark.parametrize("top", [1.0, 1.9, 2.0])
def test_what_rings_from_step_to_step_is_taken_away(top: float) -> None:
    """Also where the largest is among the last two steps; what a cubic follows stays."""
    t = np.linspace(0.0, 2.0, 21)
    cubic = 100.0 - 5.0 * (t - top) ** 2 - (t - top) ** 3
    assert of_five(t, cubic) == pytest.approx(cubic.max())
    rings = np.where(t < 0.45, 0.0, RINGS)
    assert (cubic + rings).max() > cubic.max() + 2.0
    assert of_five(t, cubic + rings) == pytest.approx(cubic.max(), abs=1e-9)


def test_steps_of_different_lengths_tell_no_ringing() -> None:
    t = np.linspace(0.0, 2.0, 21) ** 2
    assert of_five(t, 100.0 + RINGS) == pytest.approx(103.0)
