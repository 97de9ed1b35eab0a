"""Whether linear elastic soil is condensed to the part of its top that the riser reaches.

What condensation costs are the solves for the columns of the compliance, some 3e-9 n^(4/3) s for each of the r dofs
that are reached, of n in all, and the dense block in each factorisation, some 5e-11 r^3 s. What it saves are
factorisations of the whole, some 2e-9 n^2 s each. With r = 2 n^(2/3) the former is paid for by three of the latter,
and the dense block is a fifth of one: below that condensation pays, as any scene on soil has tens of iterations.
"""

from __future__ import annotations

import numpy as np

from riser_soil.contact.ground import touching_boxes
from riser_soil.errors import SceneError
from riser_soil.riser.line import Line
from riser_soil.scene.scene import Scene
from riser_soil.soil.soil import Soil
from riser_soil.soil.surface import SoilTop

MOST_REACHED = 2.0  # dofs that the riser reaches, over n^(2/3) of n in all


def why_whole(scene: Scene, soil: Soil, line: Line, diameter: float) -> str:
    """Why the soil is solved for as a whole; empty where it is condensed. diameter: of the riser [m].

    SceneError where condensing is asked for and impossible.
    """
    reason = _reason(scene, soil, line, diameter)
    if reason and scene.solver.soil == "condensed":
        raise SceneError(f"solver.soil: the soil can't be condensed: {reason}; write auto")
    return reason


def _reason(scene: Scene, soil: Soil, line: Line, diameter: float) -> str:
    assert scene.soil is not None
    ranks = soil.grid.nodes.comm.size
    if not scene.soil.is_linear:
        return f"it is not linear, its law is {' and '.join(sorted({law.kind for law in scene.soil.laws}))}"
    if scene.soil.inertia:
        return "it has inertia"
    if scene.soil.forms is not None:
        return "terms of soil.forms are added to it"
    if scene.soil.model == "sections":
        return "it is made of sections"
    if ranks > 1:
        return f"the run is on {ranks} ranks"
    if scene.solver.soil != "auto":
        return "solver.soil is whole" if scene.solver.soil == "whole" else ""
    reached, most = 3 * _under(line, soil.surface, diameter), MOST_REACHED * soil.field.size ** (2.0 / 3.0)
    if reached > most:
        return f"{reached} unknowns of its surface lie under the riser; with more than {most:.0f} condensing costs more"
    return ""


def _under(line: Line, surface: SoilTop, diameter: float) -> int:
    """How many points of the top belong to facets under the riser's width in plan, where it begins."""
    axis = line.to_global(line.x)
    axis[:, 2] = 0.0
    wide = np.array([0.5 * diameter, 0.5 * diameter, np.inf])
    low, high = np.minimum(axis[:-1], axis[1:]) - wide, np.maximum(axis[:-1], axis[1:]) + wide
    _, facets = touching_boxes(low, high, surface.points, surface.facets)
    return len(np.unique(surface.facets[facets]))
