"""Where free nodes that lines share come to rest, by the catenaries of all lines at them.

A deck guesses these places, and MoorDyn lets the lines swing from there to rest in time. Here they are found first: the
energy of cables is a convex function of the places of their ends, so that Newton's method with steps that do not pass
its lowest point along their way comes to rest from any guess.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.quantities import Vector
from riser_soil.errors import SceneError
from riser_soil.moordyn.chains import Chain
from riser_soil.moordyn.deck import Deck
from riser_soil.moordyn.nodes import properties_at
from riser_soil.moordyn.properties import net_weight, type_of
from riser_soil.moordyn.riser_of import length_of
from riser_soil.riser.catenary import Catenary, catenary

BARS = 60  # bars of each cable
STEP = 1e-5  # of a line's length: between forces of which a difference is the stiffness
ENOUGH = 1e-4  # of the largest force of a line: what is at rest
MOST = 30  # steps of Newton's method
FARTHEST = 0.3  # of a line's length: how far a step may move a node
HALVINGS = 20
FLIP = np.array([1.0, 1.0, -1.0])


@dataclass(frozen=True, eq=False)
class Cable:
    """A chain as a cable. arc (nn,) m; weight (nn - 1,) N/m; EA (nn - 1,) N; points (np, 2): arc lengths [m] of weights
    [N]; ends: names of its nodes. level: height of the seabed [m].
    """

    arc: Array
    weight: Array
    EA: Array
    points: Array
    ends: tuple[str, str]
    level: float
    near: list[Catenary] = field(default_factory=list)  # the last one

    @cached_property
    def turned(self) -> Cable:
        """The cable upside down, as one that floats is."""
        return Cable(self.arc, -self.weight, self.EA, self.points * [1.0, -1.0], self.ends, -np.inf)

    @property
    def load(self) -> float:
        """Its weight in water [N], negative where it floats."""
        return float(self.weight @ np.diff(self.arc) + self.points[:, 1].sum())

    def pulls(self, start: Array, end: Array) -> Array:
        """Forces (2, 3) [N] on the nodes at its two places (3,) [m]; what floats hangs upwards, without a surface."""
        if self.load < 0.0:
            return self.turned.pulls(FLIP * start, FLIP * end) * FLIP
        ends = np.array([start, end])
        ends[:, 2] = np.maximum(ends[:, 2], self.level)
        cable = catenary(
            self.arc, ends[0], ends[1], self.weight, self.EA, self.level, points=self.points, bars=BARS,
            near=self.near[0] if self.near else None,
        )  # fmt: skip
        self.near[:] = [cable]
        return np.array([cable.tension[0] * cable.curve.tangent[0, 0], -cable.tension[-1] * cable.curve.tangent[-1, 1]])


def cable_of(deck: Deck, chain: Chain, rho: float, g: float, level: float | None) -> Cable:
    """The cable of a chain, with what sits at nodes within it. rho: density of the water [kg/m3]; g: gravity [m/s2]."""
    lengths = [length_of(deck, piece) for piece in chain.pieces]
    arc = np.append(0.0, np.cumsum(lengths))
    rows = [type_of(deck, piece.row) for piece in chain.pieces]
    EA = [deck.parsed(row, row["EA"].split("|")[0], "EA") if "EA" in row else np.inf for row in rows]
    stiffest = max((value for value in EA if np.isfinite(value)), default=1e9)
    within = [(arc[n], properties_at(deck, chain.nodes[n])) for n in range(1, len(chain.pieces))]
    points = [(s, g * (carried.get("mass", 0.0) - rho * carried.get("volume", 0.0))) for s, carried in within]
    return Cable(
        arc,
        g * np.array([net_weight(deck, piece, rho) for piece in chain.pieces]),
        np.minimum(EA, 10.0 * stiffest),
        np.array(points, dtype=float).reshape(-1, 2),
        (chain.ends[0].name, chain.ends[1].name),
        -np.inf if level is None else level,
    )


def at_rest(cables: Sequence[Cable], places: dict[str, Vector], loads: dict[str, Array]) -> dict[str, Vector] | None:
    """Places of the nodes that bear loads [N], where they are at rest; None where that can't be found.

    places: guesses, and the places of all others. loads (3,): on each node that is free.
    """
    at = {name: np.array(place) for name, place in places.items()}
    free = [*loads]
    try:
        force, stiffness = _balance(cables, at, loads, free)
        for _ in range(MOST):
            largest = max(np.abs(cable.pulls(at[cable.ends[0]], at[cable.ends[1]])).max() for cable in cables)
            if np.abs(force).max() <= ENOUGH * largest:
                return {name: (float(at[name][0]), float(at[name][1]), float(at[name][2])) for name in free}
            at = _after_step(cables, at, loads, free, force, stiffness)
            force, stiffness = _balance(cables, at, loads, free)
    except (SceneError, np.linalg.LinAlgError):
        return None
    return None


def _forces(cables: Iterable[Cable], at: dict[str, Array], loads: dict[str, Array], free: list[str]) -> Array:
    """Forces (3 n,) on the free nodes."""
    forces = {name: loads[name].astype(float) for name in free}
    for cable in cables:
        for name, pull in zip(cable.ends, cable.pulls(at[cable.ends[0]], at[cable.ends[1]]), strict=True):
            if name in forces:
                forces[name] = forces[name] + pull
    return np.concatenate([forces[name] for name in free])


def _balance(
    cables: Sequence[Cable], at: dict[str, Array], loads: dict[str, Array], free: list[str]
) -> tuple[Array, Array]:
    """Forces (3 n,) and their stiffness (3 n, 3 n), symmetric, by differences."""
    first = {name: 3 * n for n, name in enumerate(free)}
    force, K = np.concatenate([loads[name].astype(float) for name in free]), np.zeros((3 * len(free), 3 * len(free)))
    for cable in cables:
        places = np.array([at[name] for name in cable.ends])
        pulls, h = cable.pulls(*places), STEP * cable.arc[-1]
        rows = [(end, first[name]) for end, name in enumerate(cable.ends) if name in first]
        for end, row in rows:
            force[row : row + 3] += pulls[end]
            for axis in range(3):
                moved = places.copy()
                moved[end, axis] += h
                softer = (pulls - cable.pulls(*moved)) / h
                for other, at_row in rows:
                    K[at_row : at_row + 3, row + axis] += softer[other]
    return force, 0.5 * (K + K.T)


def _after_step(
    cables: Sequence[Cable], at: dict[str, Array], loads: dict[str, Array], free: list[str], force: Array, K: Array
) -> dict[str, Array]:
    """A step of Newton's method, no farther than to where the forces along it have turned."""
    shift = 1e-6 * np.abs(K).max()
    step = np.linalg.solve(K + shift * np.eye(len(K)), force)
    if step @ force <= 0.0:
        step = force / np.abs(K).max()
    farthest = FARTHEST * min(cable.arc[-1] for cable in cables)
    step *= min(1.0, farthest / np.abs(step).max())
    for _ in range(HALVINGS):
        moved = at | {name: at[name] + step[3 * n : 3 * n + 3] for n, name in enumerate(free)}
        try:
            if step @ _forces(cables, moved, loads, free) >= -0.5 * (step @ force):
                return moved
        except SceneError:
            pass
        step *= 0.5
    return moved
