"""Momentum of a riser in motion, as its time scheme knows the rates."""

from __future__ import annotations

import numpy as np

from riser_soil.assembly import World
from riser_soil.core.arrays import Array
from riser_soil.riser.directors import SpatialTurn
from riser_soil.riser.hermite import weigh
from riser_soil.riser.inertia import Inertia
from riser_soil.riser.midpoint_inertia import MidpointInertia, MidpointRotaryInertia
from riser_soil.riser.rotary_inertia import RotaryInertia
from riser_soil.riser.secants import directors
from riser_soil.solve.time_stepper import March


def momentum(world: World, march: March) -> tuple[Array, Array]:
    """Linear (3,) and angular (3,) momentum about the origin, the sections' own spin included; global axes."""
    line, trial = world.line, world.line.trial(march.now)
    x, t = line.to_global(trial.x), trial.turn.tangent @ line.basis.T
    q = np.stack([x[:-1], t[:, 0], x[1:], t[:, 1]], axis=1)
    linear, angular = np.zeros(3), np.zeros(3)
    for part in march.system.model.parts:
        if isinstance(part, Inertia | MidpointInertia):
            M = part.M if isinstance(part, Inertia) else part.instant.M
            rate = trial.q_rate if isinstance(part, Inertia) else part.q_rate(march.now)
            impulse = weigh(M, rate) @ line.basis.T
            linear += impulse[:, [0, 2]].sum(axis=(0, 1))
            angular += np.cross(q, impulse).sum(axis=(0, 1))
        if isinstance(part, RotaryInertia | MidpointRotaryInertia):
            angular += _of_sections(world, march, part)
    return linear, angular


def _of_sections(world: World, march: March, part: RotaryInertia | MidpointRotaryInertia) -> Array:
    """Angular momentum of the sections about their centres: their mass on their directors d, sum of d x m d'."""
    line, trial = world.line, world.line.trial(march.now)
    still = np.zeros((line.nodes, line.frames.dofs))
    on = (part if isinstance(part, RotaryInertia) else part.instant).on_directors()
    moving = [directors(line.frames, k) for k in on]
    W = line.nodal(march.now.v)[:, line.dimension :]
    rates = [d.rates(W) for d in moving] if isinstance(part, RotaryInertia) else part.rates(march.now)
    impulses = [mass[:, None, None] * rate @ line.basis.T for mass, rate in zip(on.values(), rates, strict=True)]
    assert isinstance(trial.turn, SpatialTurn) == (line.dimension == 3)
    pairs = zip(moving, impulses, strict=True)
    return np.asarray(sum(np.cross(d.secant(still).mean @ line.basis.T, p).sum(axis=(0, 1)) for d, p in pairs))
