"""How outputs are evaluated."""

from itertools import pairwise

import numpy as np

from riser_soil.core.output import angle_deg

NEAR = 512  # bytes: of an array over more numpy makes copies one after the other, until one lies beside it


def test_an_angle_hangs_on_no_place_in_memory() -> None:
    """numpy takes another arctan2 where its result lies between the numbers of its argument."""
    blocks, room_between = zip(*((np.empty(3), np.empty(2)) for _ in range(1000)), strict=True)
    del room_between
    samples = np.random.default_rng(1).normal(size=(100, 2, 3))
    for low, high in pairwise(sorted(blocks, key=lambda block: block.ctypes.data)):
        if (apart := high.ctypes.data - low.ctypes.data) > NEAR:
            continue
        rows = np.lib.stride_tricks.as_strided(low, (2, 3), (apart, 8))
        for tangents in samples:
            rows[:] = tangents
            assert np.array_equal(angle_deg(rows), angle_deg(tangents.copy(order="F")))
