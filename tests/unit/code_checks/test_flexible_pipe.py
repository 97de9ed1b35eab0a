"""Limits of flexible pipe: bend radius, tension, compression, crushing."""

import numpy as np
import pytest

from riser_soil.code_checks import flexible_pipe


def test_limits_of_flexible_pipe() -> None:
    assert flexible_pipe.bend_radius(0.1, 5.0) == pytest.approx(0.5)
    assert flexible_pipe.tension(np.array([200.0, -50.0]), 400.0) == pytest.approx([0.5, 0.0])
    assert flexible_pipe.compression(np.array([200.0, -50.0]), 100.0) == pytest.approx([0.0, 0.5])
    assert flexible_pipe.crushing(np.array([30.0, -5.0]), 60.0) == pytest.approx([0.5, 0.0])
