"""Touchdown points from clearances and forces alone."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.contact.touchdown import ContactInterval, contact_intervals, touchdown_arc
from riser_soil.core.arrays import Array
from riser_soil.riser import stations

LENGTH, W, R = 40.0, 150.0, 280.0
UNEVEN = np.append(0.0, np.cumsum(np.random.default_rng(4).uniform(0.5, 1.5, size=400)))
NODES = LENGTH * UNEVEN / UNEVEN[-1]
RULES = {"line": stations.gauss(5), "node": stations.ENDS}
both_rules = pytest.mark.parametrize("rule", RULES)


def points(rule: str, nodes: Array = NODES) -> tuple[Array, Array]:
    """Arc and share of stations."""
    size, made = np.diff(nodes)[:, None], RULES[rule]
    return (nodes[:-1, None] + size * made.points).ravel(), (size * made.weights).ravel()


def landed(arc: Array, end: float, layer: float) -> tuple[Array, Array]:
    """Clearance and force on a bed of springs that a force R presses down at an end, one layer before it."""
    t = (end - arc) / layer
    force = np.where(t >= 0.0, W + 2.0 * R / layer * np.exp(-np.maximum(t, 0.0)) * np.sin(t), 0.0)
    return np.where(t >= 0.0, -1e-9 * force, 1e-6 * t**2), force


def exact(end: float, layer: float) -> float:
    """Sum R, moment R layer about the end."""
    return end - (np.sqrt(R**2 + 2.0 * W * R * layer) - R) / W


def intervals(arc: Array, share: Array, clearance: Array, force: Array) -> list[ContactInterval]:
    """Intervals of contact in one state."""
    (interval,) = contact_intervals(arc, share, clearance[None], force[None])
    return interval


def touchdown(arc: Array, share: Array, clearance: Array, force: Array) -> float:
    """Of one state."""
    return touchdown_arc(intervals(arc, share, clearance, force))


@both_rules
@pytest.mark.parametrize(("layer", "tolerance"), [(1.0, 5e-3), (0.4, 1e-4)])
def test_rigid_contact_with_the_same_resultant(rule: str, layer: float, tolerance: float) -> None:
    """Up to what is left of the layer where the force at rest is read, or to what quadrature by nodes leaves."""
    arc, share = points(rule)
    end = float(NODES[220])
    clearance, force = landed(arc, end, layer)
    place = touchdown(arc, share, clearance, force)
    assert place == pytest.approx(exact(end, layer), abs=tolerance if rule == "line" else 0.05)


@pytest.mark.parametrize("before", [0.9, 2.5, 6.0])
def test_contact_that_ends_close_to_the_riser_s_end(before: float) -> None:
    """So close that the riser at rest beyond it would weigh less than the force that is concentrated there, or more."""
    arc, share = points("line", np.linspace(0.0, LENGTH, 3201))
    end = LENGTH - before
    assert touchdown(arc, share, *landed(arc, end, 0.2)) == pytest.approx(exact(end, 0.2), abs=1e-3)


def test_softness_of_the_bed_cancels() -> None:
    """The force ends 0.45 m apart; the touchdown points differ by second-order terms in the layer's length."""
    arc, share = points("line", np.linspace(0.0, LENGTH, 3201))
    places = [touchdown(arc, share, *landed(arc, 22.0 + layer, layer)) for layer in (0.05, 0.5)]
    assert exact(22.05, 0.05) - exact(22.5, 0.5) == pytest.approx(places[0] - places[1], abs=2e-3)
    assert abs(places[0] - places[1]) < 0.1


@both_rules
@pytest.mark.parametrize("level", [1.0, 7.0])
def test_even_force_ends_at_the_touchdown_point(rule: str, level: float) -> None:
    """However large: a riser that slaps the ground evenly touches down at the end of it."""
    arc, share = points(rule)
    force = np.where(arc < NODES[200], level * W, 0.0)
    place = touchdown(arc, share, np.where(force > 0.0, -1e-3, 1e-3), force)
    assert place == pytest.approx(NODES[200], abs=0.15)


def test_what_lies_far_behind_does_not_matter() -> None:
    arc, share = points("line")
    end = float(NODES[220])
    clearance, force = landed(arc, end, 0.3)
    clump = force + np.where(np.abs(arc - 10.0) < 0.2, 3000.0, 0.0)
    heavy = force + np.where(arc < 5.0, 200.0, 0.0)
    expected = touchdown(arc, share, clearance, force)
    assert touchdown(arc, share, clearance, clump) == pytest.approx(expected, abs=1e-9)
    assert touchdown(arc, share, clearance, heavy) == pytest.approx(expected, abs=1e-9)


@both_rules
def test_from_either_side(rule: str) -> None:
    """A riser that lies at its end comes down from the start."""
    arc, share = points(rule)
    clearance, force = landed(arc, float(NODES[220]), 0.5)
    mirrored = LENGTH - arc[::-1], share[::-1], clearance[::-1], force[::-1]
    assert touchdown(*mirrored) == pytest.approx(LENGTH - touchdown(arc, share, clearance, force), abs=1e-12)


def test_stretches_part_at_spans_and_not_at_a_layers_small_gaps() -> None:
    arc, share = points("line")
    clearance = np.where((arc < 5.0) | ((arc > 10.0) & (arc < 30.0)), -1e-3, 0.2)
    force = np.where(clearance < 0.0, W, 0.0)
    clearance[(arc > 18.0) & (arc < 19.0)] = 0.9e-3
    first, second = intervals(arc, share, clearance, force)
    assert (first.start, first.end) == pytest.approx((0.0, 5.0), abs=0.1)
    assert (second.start, second.end) == pytest.approx((10.0, 30.0), abs=0.1)
    assert touchdown(arc, share, clearance, force) == second.end
    span = (arc > 18.0) & (arc < 19.0)
    clearance[span] = 1.1e-3
    assert len(intervals(arc, share, clearance, np.where(span, 0.0, force))) == 3
    assert len(intervals(arc, share, clearance, np.where(span, -W, force))) == 2, "held by suction"


def test_a_trench_in_which_the_riser_hangs_is_no_place_where_it_lies() -> None:
    arc, share = points("line")
    clearance = np.where((arc < 20.0) | ((arc > 25.0) & (arc < 30.0)), -0.1, 0.2)
    lying = intervals(arc, share, clearance, np.where(arc < 18.0, W, 0.0))
    assert [s.end for s in lying] == pytest.approx([18.0], abs=0.1)


def test_ripples_where_the_force_ends_do_not_matter() -> None:
    """Clay that has been lifted may still press or pull a little ahead of the layer."""
    arc, share = points("line")
    end = float(NODES[220])
    clearance, force = landed(arc, end, 0.5)
    expected = touchdown(arc, share, clearance, force)
    ahead = np.where((arc > end) & (arc < end + 0.6), 1e-3 * W * np.sin(10.0 * (arc - end)), 0.0)
    place = touchdown(arc, share, np.where(ahead != 0.0, -1e-9, clearance), force + ahead)
    assert place == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("layer", [0.2, 0.5, 1.5])
def test_moves_as_smoothly_as_the_forces(layer: float) -> None:
    """The end moves by a fiftieth of an element at a time: where the peak, the end and what is deep pass from station
    to station.
    """
    arc, share = points("line", np.linspace(0.0, LENGTH, 161))
    moved = 0.005
    ends = 22.0 + moved * np.arange(60)
    places = np.array([touchdown(arc, share, *settled(arc, end, layer)) for end in ends])
    assert np.abs(np.diff(places) - moved).max() < 0.05 * moved


def settled(arc: Array, end: float, layer: float) -> tuple[Array, Array]:
    """A landed riser like that of `landed`, but the force sets in smoothly."""
    t = np.maximum((end - arc) / layer, 0.0)
    force = W * (1.0 - np.exp(-2.0 * t**3)) + 2.0 * R / layer * np.exp(-t) * np.sin(t) ** 3
    return np.where(t > 0.0, -1e-9 * force, 1e-6 * (end - arc) ** 2), force


def test_nothing_and_all_of_it() -> None:
    arc, share = points("line")
    none, all_of_it = np.zeros_like(arc), np.full_like(arc, W)
    assert np.isnan(touchdown(arc, share, none + 1.0, none))
    assert intervals(arc, share, none + 1.0, none) == []
    assert touchdown(arc, share, none - 1.0, all_of_it) == pytest.approx(LENGTH)


def test_unknown_clearance_beyond_and_no_force() -> None:
    """Points that nothing is known of have an infinite clearance; touching need not press."""
    arc, share = points("node")
    clearance = np.where(arc < 20.0, -1e-3, np.inf)
    last = float(arc[arc < 20.0].max())
    assert touchdown(arc, share, clearance, np.zeros_like(arc)) == last


def test_intervals_of_many_states_are_those_of_each() -> None:
    """Intervals are the same to the last bit: stretches that begin and end anywhere, held here and there, with gaps low
    and high.
    """
    rng = np.random.default_rng(8)
    arc, share = points("line", NODES[:60])
    wave = sum(rng.normal(size=(40, 1)) * np.sin(k * arc + rng.uniform(0.0, 6.0, (40, 1))) for k in (0.1, 0.4, 4.0))
    clearance = np.asarray(wave) + rng.uniform(-1.0, 1.0, (40, 1))
    force = np.where(clearance < 0.0, -1e3 * clearance * rng.choice([0.0, 1.0, -0.2], (40, arc.size)), 0.0)
    together = contact_intervals(arc, share, clearance, force)
    assert together == [intervals(arc, share, *each) for each in zip(clearance, force, strict=True)]
    assert {len(each) for each in together} >= {0, 1, 2, 3}
