"""Which load effects are functional, environmental and accidental, stage by stage."""

import numpy as np
import pytest

from riser_soil.code_checks.load_effects import LoadEffects, SectionEffects
from riser_soil.code_checks.reference import Reference

STAGES = [("hang", "static"), ("current", "static"), ("broken", "quasi-static"), ("storm", "dynamic")]
NODES = 3


def at(*values: float) -> SectionEffects:
    """Effects that are the same at all nodes, at instants in turn; moments are twice and thrice the tension."""
    tension = np.outer(values, np.ones(NODES))
    return SectionEffects(tension, 2.0 * tension, 3.0 * tension)


def tensions(effects: LoadEffects) -> list[list[float]]:
    """Tensions by kind, at instants; the moments follow."""
    for each in effects:
        assert np.array_equal(each.moment_y, 2.0 * each.tension)
        assert np.array_equal(each.moment_z, 3.0 * each.tension)
        assert each.tension.shape == effects.functional.tension.shape
    return [each.tension[:, 0].tolist() for each in effects]


def followed(reference: Reference, *stages: tuple[str, SectionEffects]) -> list[list[list[float]]]:
    states = []
    for name, effects in stages:
        reference.begin_stage(name)
        states.append(tensions(reference.split(effects)))
    return states


RUN = (("hang", at(8.0, 10.0)), ("current", at(13.0)), ("broken", at(14.0, 20.0)), ("storm", at(25.0, 12.0)))


def test_by_default_the_last_static_stage_is_functional() -> None:
    split = followed(Reference(None, None, STAGES), *RUN)
    assert split[0] == [[8.0, 10.0], [0.0, 0.0], [0.0, 0.0]]
    assert split[1] == [[13.0], [0.0], [0.0]]
    assert split[2] == [[13.0, 13.0], [1.0, 7.0], [0.0, 0.0]]
    assert split[3] == [[13.0, 13.0], [12.0, -1.0], [0.0, 0.0]]


def test_of_a_stage_that_is_named_the_end_is_functional() -> None:
    split = followed(Reference("hang", None, STAGES), *RUN)
    assert split[1] == [[10.0], [3.0], [0.0]]
    assert split[3] == [[10.0, 10.0], [15.0, 2.0], [0.0, 0.0]]


def test_what_an_accident_adds_stays_accidental() -> None:
    split = followed(Reference("current", "broken", STAGES), *RUN)
    assert split[2] == [[13.0, 13.0], [0.0, 0.0], [1.0, 7.0]]
    assert split[3] == [[13.0, 13.0], [5.0, -8.0], [7.0, 7.0]]


def test_a_run_that_begins_in_motion_has_the_functional_effects_of_its_first_instant() -> None:
    reference = Reference(None, None, [("storm", "dynamic")])
    assert followed(reference, ("storm", at(5.0, 7.0)), ("storm", at(4.0))) == [
        [[5.0, 5.0], [0.0, 2.0], [0.0, 0.0]],
        [[5.0], [-1.0], [0.0]],
    ]


@pytest.mark.parametrize("stages", [(None, None), ("hang", None), ("current", "broken")])
def test_another_goes_on_from_what_was_saved(stages: tuple[str | None, str | None]) -> None:
    whole, first, second = (Reference(*stages, STAGES) for _ in range(3))
    expected = followed(whole, *RUN)[3]
    followed(first, *RUN[:3])
    second.begin_stage("storm")
    second.restore(first.state())
    assert tensions(second.split(RUN[3][1])) == expected
