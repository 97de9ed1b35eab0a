"""How outputs are evaluated."""

import numpy as np

from riser_soil.core.output import angle_deg


def test_an_angle_hangs_on_no_place_in_memory() -> None:
    """numpy takes another arctan2 where its result lies between the numbers of its argument."""
    blocks, room_between = zip(*((np.empty(3), np.empty(2)) for _ in range(1000)), strict=True)
    del room_between
    low, *_, high = sorted(blocks, key=lambda block: block.ctypes.data)
    rows = np.lib.stride_tricks.as_strided(low, (2, 3), (high.ctypes.data - low.ctypes.data, 8))
    for tangents in np.random.default_rng(1).normal(size=(100, 2, 3)):
        rows[:] = tangents
        assert np.array_equal(angle_deg(rows), angle_deg(tangents.copy(order="F")))
