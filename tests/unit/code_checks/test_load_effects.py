"""Design load effects: factors of what adds and of what relieves, moments of both planes, limit states."""

import numpy as np
import pytest

from riser_soil.code_checks import dnv_st_f201
from riser_soil.code_checks.load_effects import LoadEffects, LoadFactors, SectionEffects, design_effects


def one(tension: float = 0.0, moment_y: float = 0.0, moment_z: float = 0.0) -> SectionEffects:
    return SectionEffects(*(np.array([value]) for value in (tension, moment_y, moment_z)))


@pytest.mark.parametrize(
    ("functional", "environmental", "design"),
    [
        (100.0, 50.0, 1.1 * 100.0 + 1.3 * 50.0),
        (100.0, -50.0, 1.1 * 100.0 - 50.0 / 1.3),  # the environment relieves
        (100.0, -300.0, 1.3 * 300.0 - 100.0 / 1.1),  # what acts at rest relieves
        (-100.0, -50.0, 1.1 * 100.0 + 1.3 * 50.0),
    ],
)
def test_what_relieves_counts_with_one_over_its_factor(
    functional: float, environmental: float, design: float
) -> None:
    effects = LoadEffects(one(functional, functional), one(environmental, environmental), one())
    moment, tension = design_effects(effects, dnv_st_f201.LOAD_FACTORS["ULS"])
    assert [moment[0], tension[0]] == pytest.approx([design, design])


def test_moments_of_both_planes_add_as_vectors() -> None:
    effects = LoadEffects(one(moment_y=30.0), one(moment_z=40.0), one())
    moment, _ = design_effects(effects, LoadFactors(1.0, 1.0, 1.0))
    assert moment[0] == pytest.approx(50.0)


@pytest.mark.parametrize(("state", "factor"), [("ALS", 1.0), ("SLS", 1.0), ("ULS", 0.0), ("FLS", 0.0)])
def test_accidental_effects_count_in_some_limit_states_alone(state: str, factor: float) -> None:
    moment, _ = design_effects(LoadEffects(one(), one(), one(moment_y=9.0)), dnv_st_f201.LOAD_FACTORS[state])
    assert moment[0] == pytest.approx(9.0 * factor)
