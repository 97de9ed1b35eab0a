"""Momentum of lines and bodies in motion, as their time scheme knows the rates."""

from __future__ import annotations

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.bodies.body import MovingBody
from riser_soil.bodies.inertia import BodyInertia
from riser_soil.core.arrays import Array
from riser_soil.riser.hermite import weigh
from riser_soil.riser.inertia import Inertia, RotaryInertia
from riser_soil.riser.line import Line
from riser_soil.riser.midpoint_directors import directors
from riser_soil.riser.midpoint_inertia import MidpointInertia, MidpointRotaryInertia
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.solve.time_stepper import TimeStepper


def momentum(assembly: Assembly, stepper: TimeStepper) -> tuple[Array, Array]:
    """Linear (3,) and angular (3,) momentum about the origin, the sections' own spin included; global axes."""
    momenta = [_of_line(own.line, stepper) for own in assembly.lines.values()]
    for body in {} if assembly.bodies_and_joints is None else assembly.bodies_and_joints.bodies.values():
        (part,) = (p for p in stepper.system.model.parts if isinstance(p, BodyInertia) and p.line is body)
        momenta.append(of_body(body, part.M, body.nodal(stepper.now.v)[0]))
    linear, angular = (np.sum(each, axis=0) for each in zip(*momenta, strict=True))
    return linear, angular


def of_body(body: MovingBody, M: Array, v: Array) -> tuple[Array, Array]:
    """Momentum of a body with the mass matrix M (6, 6) and rates v (6,)."""
    R = body.frames.R[0]
    linear, angular = (M @ np.concatenate([R.T @ v[:3], v[3:]])).reshape(2, 3) @ R.T
    return linear, angular + np.cross(body.x[0], linear)


def _of_line(line: Line, stepper: TimeStepper) -> tuple[Array, Array]:
    trial = line.trial(stepper.now)
    x, t = line.to_global(trial.x), trial.turn.tangent @ line.basis.T
    q = np.stack([x[:-1], t[:, 0], x[1:], t[:, 1]], axis=1)
    linear, angular = np.zeros(3), np.zeros(3)
    for part in stepper.system.model.parts:
        if getattr(part, "line", None) is not line:
            continue
        if isinstance(part, Inertia | MidpointInertia):
            M = part.M if isinstance(part, Inertia) else part.instant.M
            rate = trial.q_rate if isinstance(part, Inertia) else part.q_rate(stepper.now)
            impulse = weigh(M, rate) @ line.basis.T
            linear += impulse[:, [0, 2]].sum(axis=(0, 1))
            angular += np.cross(q, impulse).sum(axis=(0, 1))
        if isinstance(part, RotaryInertia | MidpointRotaryInertia):
            angular += _of_sections(line, stepper, part)
    return linear, angular


def _of_sections(line: Line, stepper: TimeStepper, part: RotaryInertia | MidpointRotaryInertia) -> Array:
    """Angular momentum of the sections about their centres: their mass on their directors d, sum of d x m d'."""
    trial = line.trial(stepper.now)
    still = np.zeros((line.nodes, line.frames.dofs))
    on = (part if isinstance(part, RotaryInertia) else part.instant).on_directors()
    moving = [directors(line.frames, k) for k in on]
    W = line.nodal(stepper.now.v)[:, line.dimension :]
    rates = [d.rates(W) for d in moving] if isinstance(part, RotaryInertia) else part.rates(stepper.now)
    impulses = [mass[:, None, None] * rate @ line.basis.T for mass, rate in zip(on.values(), rates, strict=True)]
    assert isinstance(trial.turn, SpatialOrientation) == (line.dimension == 3)
    pairs = zip(moving, impulses, strict=True)
    return np.asarray(sum(np.cross(d.secant(still).mean @ line.basis.T, p).sum(axis=(0, 1)) for d, p in pairs))
