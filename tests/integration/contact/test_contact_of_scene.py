"""Contact as a scene has it: the width that touches, stiffness, corner, friction and suction, as its language says."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.assembly.assembly import Assembly
from riser_soil.assembly.contact_laws import contact_width, smoothing, stiffnesses
from riser_soil.assembly.scales import Scales
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.errors import SceneError
from riser_soil.results.settlement_trough import offsets_of
from riser_soil.scene.contact import Contact
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.seabed.law import NormalLaw
from tests.support.driven_stage import built, soil_under
from tests.support.said import telling
from tests.support.scenes import Mapping, touchdown
from tests.support.soil_loops import after, at

WEIGHT, D, E = 700.0, 0.3, 1.2e6
PIPE = Scales(WEIGHT, D, 0.0)
CAP, REACH = 300.0, 0.02
HELD = {"suction": {"cap": CAP, "reach": REACH}}


def with_contact(**contact: object) -> Assembly:
    """A pipe of 0.3 m on elastic soil and on a seabed of springs beside it."""
    scene: Mapping = touchdown()
    scene["soil"]["law"] = {"kind": "linear-elastic", "E": E, "nu": 0.49}
    return built(scene | {"contact": contact})


def test_the_width_that_touches_is_hertzs() -> None:
    """Pressure p0 sqrt(1 - (x/b)^2) with p0 = E* b/(2 R), which bears the weight; E* = E/(1 - nu^2), nu = 1/2."""
    half = 0.5 * contact_width(PIPE, E)
    assert 0.5 * np.pi * half * E / 0.75 * half / D == pytest.approx(WEIGHT)
    assert contact_width(PIPE, 1.0) == D


def test_stiffness_follows_from_the_soil_and_from_the_weight() -> None:
    """Ten times the soil's modulus at nodes, twenty times all over the surface, or more: no more than D/1000 is to
    be sunk in.
    """
    scene = scene_from_mapping(touchdown() | {"seabed": {"kind": "rigid"}})
    soil = 300.0 * 600.0
    heavy, light = Scales(5.0e5, D, 0.0), Scales(1.0, D, 0.0)
    for method, over_soil in (("node", 10.0), ("surface", 20.0)):
        contact = Contact.model_validate({"method": method})
        assert stiffnesses(scene, contact, light)["soil"] == pytest.approx(over_soil * soil)
        assert stiffnesses(scene, contact, heavy)["soil"] == pytest.approx(5.0e5 / (1e-3 * D))
    assert stiffnesses(scene, Contact(), PIPE)["seabed"] == pytest.approx(WEIGHT / (1e-3 * D))


def test_the_corner_is_rounded_over_what_the_pipe_sinks_in() -> None:
    for stiffness, width in ((1.0, D / 300.0), (WEIGHT / 4e-4, 4e-4), (1e12, D / 3000.0)):
        assert smoothing(Contact(), PIPE, "seabed", stiffness) == pytest.approx(width)
    assert smoothing(Contact(), PIPE, "soil", 1e6) == 0.0
    assert smoothing(Contact(method="node"), PIPE, "soil", 1e6) == pytest.approx(D / 300.0)


def torn_off(law: NormalLaw, touched: float) -> tuple[float, float]:
    """Greatest tension of ground that was touched, and the opening from which on there is none."""
    w = np.linspace(0.0, 2.0 * REACH, 40001)
    tension = -at(law, -w, after(law, np.array([touched])))[0]
    return float(tension.max()), float(w[tension > 0.0][-1])


def test_suction_has_its_cap_per_length_on_the_seabed_and_over_the_diameter_on_soil() -> None:
    assembly = with_contact(**HELD)
    assert isinstance(assembly.riser.seabed, SeabedContact)
    assert assembly.soil is not None
    assert torn_off(assembly.riser.seabed.law, 0.01) == pytest.approx((CAP, REACH), rel=1e-3)
    assert torn_off(assembly.soil.contact.law, 0.01) == pytest.approx((CAP / D, REACH), rel=1e-3)


def test_suction_that_ends_before_its_cap_is_refused() -> None:
    """On soil its cap lies at an opening of CAP/D over the stiffness per area."""
    width = contact_width(Scales(float(with_contact().scales.weight), D, 0.0), E)
    peak = CAP / D * width / (20.0 * E)
    with pytest.raises(SceneError, match=telling("contact.suction.reach", "cap of 300 N/m", f"{peak:g} m on the soil")):
        with_contact(suction={"cap": CAP, "reach": 0.99 * peak}, stiffness=20.0 * E)


def test_friction_is_mobilised_by_a_thirtieth_of_the_diameter() -> None:
    """Under the pipe's weight, by the larger coefficient; on soil that weight lies on the width that touches."""
    assembly = with_contact(friction={"axial": 0.3, "lateral": 0.6})
    weight = assembly.scales.weight
    assert assembly.riser.friction is not None
    friction = soil_under(assembly).friction
    assert friction is not None
    np.testing.assert_allclose(assembly.riser.friction._stiffness, 0.6 * weight / (D / 30.0))
    width = contact_width(assembly.scales, E)
    assert friction._resistance.stiffness == pytest.approx(0.6 * weight / width / (D / 30.0))


def test_the_riser_bounces_on_the_stiffest_of_its_grounds() -> None:
    """A metre of it on springs of 1e5 N/m2; on soil with a penalty of 20 E, which gives way by a strip's 1/E, too."""
    soil, alone = with_contact(), touchdown()
    del alone["soil"]
    springs = built(alone)
    mass = float(springs.riser.elements.mass.min())
    assert mass * (2.0 * np.pi / springs.contact_period) ** 2 == pytest.approx(1.0e5)
    series = 1.0 / (1.0 / (20.0 * E) + 1.0 / E)
    assert mass * (2.0 * np.pi / soil.contact_period) ** 2 == pytest.approx(series)


def test_sections_across_the_riser_reach_three_diameters_to_either_side() -> None:
    offsets = offsets_of(with_contact().riser)
    assert (len(offsets), offsets[0], offsets[30], offsets[-1]) == pytest.approx((61, -3.0 * D, 0.0, 3.0 * D))
