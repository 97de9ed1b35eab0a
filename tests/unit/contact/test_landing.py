"""First guess of a step in which nodes land: none deeper than now, or than half the law's rounded corner."""

from __future__ import annotations

import numpy as np

from riser_soil.contact.along_step import landing_predictor
from riser_soil.core.part import State


def test_a_node_is_lifted_to_its_present_depth_or_half_the_corner() -> None:
    """Start of the force 0.2 m above the ground. Nodes: aloft; landing; lying deep, pressed deeper; rising."""
    present, guessed = np.array([3.0, 1.0, -0.5, -0.5]), np.array([2.0, -0.7, -0.9, -0.3])
    guess, heights = State.at_rest(0.0, 8), np.array([1, 3, 5, 7])
    guess.u[:] = np.arange(8.0)
    landed = landing_predictor(guess, heights, present, guessed, 0.2)
    np.testing.assert_allclose((landed - guess.u)[heights], [0.0, 0.6, 0.4, 0.0], rtol=1e-14)
    np.testing.assert_array_equal(landed[::2], guess.u[::2])
    np.testing.assert_array_equal(guess.u, np.arange(8.0))
