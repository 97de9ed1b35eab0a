"""Element lengths by curvature: of known curves, and of the stretches that they are told in."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from riser_soil.accuracy.element_sizes import CurveEnvelope
from riser_soil.assembly.graded_segments import graded
from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import Record
from riser_soil.scene.riser import Segment
from tests.support.recorded_run import Catenary, changed

LENGTH, SHARE = 100.0, 0.01
ARC = np.linspace(0.0, LENGTH, 201)
MISSED = 5.0  # N m: half of the share of the largest moment, 1e3 N m; the other half is the elements' own
LIMP = {"curvature": np.zeros(ARC.size)}  # no EI that tension acts against


def record(moment: Array, tension: Array, **more: Array) -> Record:
    """A riser with such a moment about y and tension along it."""
    line = Catenary(32.0, 30.0)
    vector = np.zeros((ARC.size, 3))
    vector[:, 1] = moment
    given: dict[str, Any] = {"moment_vector": vector, "bending_moment": np.abs(moment), "effective_tension": tension}
    return changed(line.record(ARC), **(given | LIMP | more))


def envelope(*instants: Record) -> CurveEnvelope:
    made = CurveEnvelope()
    for instant in instants:
        made.add(instant)
    return made


def asked(made: CurveEnvelope, place: float) -> float:
    """Length [m] at an arc, as asked."""
    return float(np.interp(place, ARC, made.lengths(SHARE)))


BULGE = 1e3 * (1.0 - (2.0 * ARC / LENGTH - 1.0) ** 2)  # M'' = 0.8 N/m everywhere
EVEN = np.full(ARC.size, 5e4)


def test_a_straight_line_misses_a_parabola_by_the_share() -> None:
    middle = asked(envelope(record(BULGE, EVEN)), 50.0)
    assert middle**2 * 0.8 / 8.0 == pytest.approx(MISSED, rel=1e-6)


def test_a_smaller_moment_may_be_missed_by_more() -> None:
    """A moment may be missed by a fifth of the 250 N m that it is below the largest."""
    aside = asked(envelope(record(BULGE, EVEN)), 25.0)
    assert aside**2 * 0.8 / 8.0 == pytest.approx(MISSED + 50.0, rel=1e-3)


def test_tension_of_round_off_asks_for_nothing() -> None:
    noise = 1e-6 * (-1.0) ** np.arange(ARC.size)
    assert asked(envelope(record(BULGE, noise)), 50.0) == pytest.approx(asked(envelope(record(BULGE, EVEN)), 50.0))


def test_tension_asks_by_its_scale() -> None:
    """A tenth of the largest tension, as key results have it."""
    tension = 4e4 + 4.0 * (ARC - 50.0) ** 2
    middle = asked(envelope(record(0.0 * BULGE, tension)), 50.0)
    assert middle**2 * 8.0 / 8.0 == pytest.approx(0.5 * SHARE * 0.1 * tension.max(), rel=1e-6)


def test_tension_over_stiffness_keeps_elements_to_what_a_cubic_follows() -> None:
    EI = 1e2
    middle = asked(envelope(record(BULGE, EVEN, curvature=BULGE / EI)), 50.0)
    assert 5e4 * middle**4 * 0.8 / EI / 384.0 == pytest.approx(MISSED, rel=1e-6)


def test_straight_risers_ask_for_nothing() -> None:
    assert np.isinf(envelope(record(0.0 * BULGE, EVEN)).lengths(SHARE)).all()


def test_the_worst_instant_counts() -> None:
    """Also where the direction of the moment turns, which its size does not show."""
    calm, bent = record(BULGE, EVEN), record(4.0 * BULGE, EVEN)
    both = envelope(calm, bent, calm)
    assert both.lengths(SHARE) == pytest.approx(envelope(bent).lengths(SHARE))
    turned = record(1e3 * (ARC / LENGTH - 0.5), EVEN)  # straight through zero: nothing to miss
    assert asked(envelope(turned), 50.0) == np.inf


def test_what_is_not_resolved_shrinks_step_by_step() -> None:
    """Elements shrink to a sixth from one run to the next."""
    spike = np.where(ARC == 50.0, 1e3, 0.0)
    assert asked(envelope(record(spike, EVEN)), 50.0) == pytest.approx(0.5 / 6.0)


def test_excess_is_the_worst_length_over_the_length_asked_for() -> None:
    made = envelope(record(BULGE, EVEN))
    assert made.length_ratio(SHARE) == pytest.approx(0.5 / made.lengths(SHARE).min(), rel=1e-6)


def layered() -> CurveEnvelope:
    """Moment that falls off within a layer of 2 m from the start."""
    return envelope(record(1e3 * np.exp(-ARC / 2.0), EVEN))


def test_stretches_follow_the_curve_and_keep_the_segments_whole() -> None:
    segments = (Segment(line_type="a", length=60.0, elements=6), Segment(line_type="b", length=40.0, elements=4))
    made = graded(segments, ARC, layered().lengths(SHARE))
    assert [math.fsum(s.length for s in made if s.line_type == name) for name in "ab"] == pytest.approx([60.0, 40.0])
    lengths = np.array([x for segment in made for x in segment.element_lengths])
    assert lengths[0] == pytest.approx(math.sqrt(8.0 * MISSED / 250.0), rel=0.25)
    assert lengths.max() <= LENGTH / 12 * 1.001
    steepest = 1.15 / 0.85  # of lengths that grow by 0.3 of the way, from the middle of an element to that of the next
    assert max(b / a for a, b in pairwise(lengths)) == pytest.approx(steepest, rel=0.05)
    finer = graded(segments, ARC, layered().lengths(SHARE / 100.0))
    fine = np.array([x for segment in finer for x in segment.element_lengths])
    assert fine[0] < 0.2 * lengths[0]


def test_a_short_segment_has_two_elements_at_least() -> None:
    segments = (Segment(line_type="a", length=99.0, elements=6), Segment(line_type="b", length=1.0, elements=4))
    assert graded(segments, ARC, envelope(record(0.0 * BULGE, EVEN)).lengths(SHARE))[-1].element_count == 2
