"""A kind that the scene's language gains and a part does not know is refused, never taken for one that is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from pydantic import BaseModel

from riser_soil.assembly import build
from riser_soil.assembly.contact_laws import seabed_law, stiffnesses
from riser_soil.assembly.motions import set_motion
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.scales import Scales
from riser_soil.assembly.shape import initial_shape, unstressed_shape
from riser_soil.assembly.stage import scheme_of
from riser_soil.errors import SceneError
from riser_soil.riser.line_ends import End
from riser_soil.riser.shapes import straight
from riser_soil.scene.contact import Contact
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import HystereticSeabed
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin
from riser_soil.soil.block import BlockSpec, make_block
from riser_soil.soil.laws import LAWS
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.von_mises import VonMises
from tests.support.said import telling
from tests.support.scenes import LAY, heave, touchdown

CLAY: dict[str, Any] = {"su": 4.0e3, "su_gradient": 1.5e3, "E_over_su": 300.0, "nu": 0.49}


def scene() -> Scene:
    return scene_from_mapping(touchdown(LAY, heave(1.0)))


def another(like: BaseModel | None = None, **values: Any) -> Any:
    """A new kind with all the keys of a known one: nothing but its type tells them apart."""

    class Another(BaseModel):
        model_config = {"extra": "allow"}

    return Another(**(dict(like) if like is not None else {}), **values)


def with_parts(whole: Any, **parts: Any) -> Any:
    """The model with parts that its language does not have."""
    return whole.model_copy(update=parts)


def test_each_soil_law_has_its_formula() -> None:
    depth, shear = np.array([0.0, 2.0]), np.sqrt(2.0) * 4.0e3
    clay = VonMises(kind="von-mises", **CLAY).at_points(depth, np.zeros((2, 6)))
    stress = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, shear], (2, 1))  # in simple shear, at the strength of the surface
    np.testing.assert_allclose(clay.overstress(stress), [1.0, 4.0 / 7.0])
    rock = LinearElastic(kind="linear-elastic", E=1.0e6, nu=0.3).at_points(depth, np.zeros((2, 6)))
    assert not rock.overstress(stress).any()


def test_a_third_soil_law_is_refused() -> None:
    given = touchdown(LAY, heave(1.0))
    given["soil"]["law"]["kind"] = "cam-clay"
    with pytest.raises(SceneError, match=telling("soil.law.kind:", 'value "cam-clay":', f"one of {', '.join(LAWS)};")):
        scene_from_mapping(given)
    third = another(VonMises(kind="von-mises", **CLAY), surface_modulus=lambda width: 1.0e6)
    whole = scene()
    with pytest.raises(AttributeError, match="linear"):
        build(with_parts(whole, soil=with_parts(whole.soil, law=third)), MPI.COMM_SELF)


def test_a_soil_law_tells_the_modulus_that_contact_goes_by() -> None:
    whole, settings = scene(), Contact()
    third = with_parts(whole, soil=with_parts(whole.soil, law=another(VonMises(kind="von-mises", **CLAY))))
    with pytest.raises(AttributeError, match="surface_modulus"):
        stiffnesses(third, settings, Scales(weight=700.0, diameter=0.3, force_floor=0.0))


def test_another_hysteretic_law_is_refused() -> None:
    given = touchdown(LAY, heave(1.0))
    given["seabed"] = {"kind": "hysteretic", "law": {"kind": "bridge", "su": 2.0e3}}
    allowed = "must be one of randolph-quiggin, aubeny-biscontin;"
    with pytest.raises(SceneError, match=rf'seabed.law.kind: value "bridge": {allowed}'):
        scene_from_mapping(given)
    law = another(RandolphQuiggin(kind="randolph-quiggin", su=2.0e3))
    with pytest.raises(AttributeError, match="of_pipe"):
        seabed_law(HystereticSeabed.model_construct(law=law), Contact(), Scales(700.0, 0.3, 0.0), 0.3, {})


def test_another_seabed_is_refused() -> None:
    whole = scene()
    other = with_parts(whole, seabed=another(whole.seabed))
    with pytest.raises(AssertionError, match="Another"):
        stiffnesses(other, Contact(), Scales(weight=700.0, diameter=0.3, force_floor=0.0))


def test_another_scheme_is_refused() -> None:
    stage = scene().stages[1]
    with pytest.raises(AssertionError, match="Another"):
        scheme_of(with_parts(stage, scheme=another(generalized_alpha=another(rho_inf=0.8))))


def test_another_motion_is_refused() -> None:
    stage = scene().stages[1]
    motion = with_parts(stage, motion=another(by_end={"end": another(ways={"circle": another(period=3.0)})}))
    with pytest.raises(AssertionError, match="Another"):
        set_motion(End(prescribed=True), "end", np.zeros(3), motion, None)


def test_another_shape_is_refused() -> None:
    whole = scene()
    elements = elements_of(whole)
    unstressed = straight(elements.arc, np.zeros(3))
    with pytest.raises(AssertionError, match="Another"):
        unstressed_shape(with_parts(whole.riser, unstressed=another()), elements.arc)
    with pytest.raises(AssertionError, match="spiral"):
        initial_shape(with_parts(whole, riser=with_parts(whole.riser, initial="spiral")), elements, (), unstressed)


def test_another_kind_of_cells_is_refused() -> None:
    kind: Any = "wedge"
    with pytest.raises(AssertionError, match="wedge"):
        make_block(BlockSpec((0.0, 1.0), (0.0, 1.0), 1.0, 0.5, 0.5, kind=kind))
