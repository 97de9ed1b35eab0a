"""The compiled loop over a riser in space and on a floor: kernels are those of the parts, steps are those of SNES."""

from __future__ import annotations

import pytest

from tests.support.riser_loop import CASES, IN_WATER, require_kernels, require_kernels_of_parts, require_steps_of_snes
from tests.support.sample_line import sample

pytestmark = pytest.mark.verify


def test_kernels_in_space_are_those_of_the_parts() -> None:
    require_kernels_of_parts(3)


@pytest.mark.parametrize("dimension", [2, 3])
def test_kernels_in_water_are_those_of_the_parts(dimension: int) -> None:
    at = sample(dimension)
    require_kernels(at, [make(at) for make in IN_WATER])


@pytest.mark.parametrize("case", CASES)
def test_steps_are_those_of_snes(case: str) -> None:
    require_steps_of_snes(case)
