"""Predicted settlement: closed forms of its parts, and what `check` says of a riser on clay."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.assembly.scales import Scales
from riser_soil.checks.settlement import chord_depth, predicted_settlement, secant_share, settlement
from riser_soil.riser.touchdown_bend import TouchdownBend
from riser_soil.scene.soil import SoilScene
from riser_soil.soil.kinematic_hardening import KinematicHardening
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.von_mises import VonMises
from tests.support.driven_stage import built
from tests.support.scenes import LAY, Mapping, touchdown

D, DEPTH = 0.3, 2.0
ELASTIC: Mapping = {"kind": "linear-elastic", "E": 1.0e6, "nu": 0.3}
CLAY: Mapping = {"kind": "von-mises", "su": 5.0e3, "E_over_su": 300.0, "nu": 0.49}


def soil(**given: Any) -> SoilScene:
    block = {"x": [0.0, 1.0], "y": [-2.0, 2.0], "depth": DEPTH}
    return SoilScene.model_validate({"block": block, "mesh": "auto"} | given)


def pipe(weight: float) -> Scales:
    return Scales(weight, D, 1.0)


@pytest.mark.parametrize("across", [0.02, 0.1])
def test_wide_cells_bear_a_strip_on_elastic_soil(across: float) -> None:
    """q/(pi E*) (2 ln(4 z/width) - 1), width 1.75 cells."""
    strip = 500.0 / (np.pi * 1.0e6 / (1.0 - 0.3**2)) * (2.0 * np.log(4.0 * DEPTH / (1.75 * across)) - 1.0)
    assert settlement(soil(law=ELASTIC), pipe(500.0), DEPTH, across) == pytest.approx(strip, rel=1e-9)


def test_clay_bears_on_the_chord() -> None:
    """At 2 su D the chord is 2 D/(2 + pi) wide; soil a thousand times as stiff adds next to nothing."""
    width = 2.0 * D / (2.0 + np.pi)
    depth = 0.5 * (D - np.sqrt(D**2 - width**2))
    assert chord_depth(width, D) == pytest.approx(depth)
    stiff = soil(law=CLAY | {"E_over_su": 3.0e5})
    assert settlement(stiff, pipe(2.0 * 5.0e3 * D), DEPTH) == pytest.approx(depth, rel=1e-2)
    assert settlement(stiff, pipe(2.0 * 5.0e3 * D), DEPTH, 0.5 * D) < 1e-2 * depth


def test_a_firm_layer_stops_a_pipe_that_sinks() -> None:
    """Through 30 mm that bear a third of it, and into the firm clay by the chord that bears it there; soil a thousand
    times as stiff adds next to nothing.
    """
    weight, firm, stiff = 5.0e2, 5.0e3, {"E_over_su": 3.0e5}
    layers = [{"to": 0.03, "law": CLAY | stiff | {"su": 100.0}}, {"law": CLAY | stiff | {"su": firm}}]
    chord = chord_depth(weight / ((2.0 + np.pi) * firm), D)
    assert settlement(soil(layers=layers), pipe(weight), DEPTH) == pytest.approx(0.03 + chord, rel=2e-2)


def test_secant_at_half_of_the_strength() -> None:
    """Where clay is elastic up to that, its own modulus; of kinematic hardening that of fine increments."""
    assert secant_share(LinearElastic(**ELASTIC)) == 1.0
    assert secant_share(VonMises(**CLAY)) == pytest.approx(1.0, rel=1e-9)
    law = KinematicHardening(kind="kinematic-hardening", su=5.0e3, E_over_su=300.0, elastic_share=0.1)
    formula = law.at_points(np.array([1.0]), np.zeros((1, 6)))
    history, stress, strain, step = formula.start(), 0.0, 0.0, 1e-6
    while stress < 2.5e3:
        update = formula.update(np.array([[0.0, 0.0, 0.0, step / np.sqrt(2.0), 0.0, 0.0]]), history)
        history, stress, strain = update.history, float(update.stress[0, 3]) / np.sqrt(2.0), strain + step
    assert secant_share(law) == pytest.approx(stress / strain / float(formula.shear[0]), rel=0.01)


def test_layers_and_strength_that_grows_stiffen_the_soil() -> None:
    layers = [{"to": 0.5, "law": ELASTIC}, {"law": ELASTIC | {"E": 1.0e9}}]
    width = 500.0 / (np.pi * 1.0e6 / (1.0 - 0.3**2)) * (2.0 * np.log(4.0 * 0.5 / (1.75 * 0.1)) - 1.0)
    assert settlement(soil(layers=layers), pipe(500.0), DEPTH, 0.1) == pytest.approx(width, rel=0.02)
    light = pipe(1000.0)
    grows = settlement(soil(law=CLAY | {"su_gradient": 5.0e3}), light, DEPTH)
    assert grows < 0.95 * settlement(soil(law=CLAY), light, DEPTH)


@pytest.mark.parametrize("depth", [1e-3, 1e-2, 1e-1])
def test_overshoot_of_the_touchdown_is_the_deepest_place(depth: float) -> None:
    bend = TouchdownBend(728.0, 2.5e4, 5.0e4, depth)
    height, _ = bend.beyond_cable(-np.linspace(0.0, 20.0, 200001))
    assert bend.overshoot == pytest.approx(max(-(height + bend.rise).min() / depth, 1.0), rel=1e-6)


def test_a_riser_settles_most_where_it_touches_down() -> None:
    settled = predicted_settlement(built(touchdown(LAY, su=6000.0) | {"contact": {"method": "surface"}}).riser)
    assert settled is not None
    assert settled.overshoot > 1.05
    assert settled.deepest > settled.by_weight
