"""The share of the elastic tangent that soil gets where Newton's increments lose all measure."""

from __future__ import annotations

from riser_soil.solve.elastic_share import ElasticShare

FIRST = 1e-4


class Flowing:
    """A part that keeps what share it was given."""

    def __init__(self) -> None:
        self.given = list[float]()

    def mix_elastic(self, share: float) -> None:
        self.given.append(share)


def test_it_grows_as_long_as_the_residual_does_and_ends_where_it_falls() -> None:
    part = Flowing()
    share = ElasticShare([part])
    for norm, before in ((2.0, 1.0), (3.0, 2.0), (1.5, 3.0), (0.1, 1.5), (0.01, 0.1), (0.001, 0.01)):
        share.adapt(norm, before)
    assert part.given == [FIRST, 10.0 * FIRST, FIRST, 0.0]


def test_a_short_part_of_a_step_counts_as_well() -> None:
    part = Flowing()
    share = ElasticShare([part])
    share.length = 0.01
    share.adapt(0.5, 1.0)
    assert part.given == [FIRST]
    share.reset()
    assert part.given == [FIRST, 0.0]
    share.adapt(0.5, 1.0)
    assert part.given == [FIRST, 0.0]


def test_what_crawls_under_the_elastic_tangent_is_in_vain() -> None:
    """Four times in a row; one that falls, or that the elastic tangent does not have alone, begins anew."""
    share = ElasticShare([Flowing()])
    for _ in range(3):
        share.adapt(0.95, 1.0)
    for n in range(6):
        share.adapt(n + 2.0, n + 1.0)  # up to all of it
    messages = []
    for norm in (0.95, 0.95, 0.95, 1.5, 0.95, 0.91, 0.95, 0.99):
        share.adapt(norm, 1.0)
        messages.append(share.in_vain)
    assert messages == 7 * [False] + [True]
    share.reset()
    assert not share.in_vain


def test_without_a_part_that_yields_nothing_is_in_vain() -> None:
    share = ElasticShare([])
    for n in range(10):
        share.adapt(n + 2.0, n + 1.0)
    for _ in range(10):
        share.adapt(0.95, 1.0)
    assert not share.in_vain


def test_it_is_never_more_than_the_elastic_tangent() -> None:
    part = Flowing()
    share = ElasticShare([part])
    for n in range(10):
        share.adapt(n + 2.0, n + 1.0)
    assert part.given[-1] == 1.0
    assert part.given == sorted(set(part.given))
