"""A law is one file and one entry: laws that only this test knows, from the scene to the energy that they dissipate."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.checks.check import describe
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.errors import SceneError
from riser_soil.scene.dump import dump_scene, schema_text
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.seabed import HystereticSeabed
from riser_soil.seabed.laws import LAWS as SEABED_LAWS
from riser_soil.soil.laws import LAWS as SOIL_LAWS
from riser_soil.soil.soil import Soil
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built, soil_under
from tests.support.said import telling
from tests.support.scenes import LAY, Mapping, prescribed, riser_scene, static, touchdown
from tests.support.soil_bench import assemble, force
from tests.support.soil_cases import KINDS, distorted, moved, sheared, small_block
from tests.support.soil_loops import after, at, forces, through, work
from tests.support.toy_laws import Hardening, OtherElastic, PlasticSpring, entered

SOIL_WORDS = ", ".join(SOIL_LAWS)  # without toys
ELASTIC: Mapping = {"kind": "linear-elastic", "E": 3.0e5, "nu": 0.3}
HARDENING = Hardening(kind="toy", E=1.2e6, nu=0.3, limit=4.0e3, H=3.0e5)
G = 1.2e6 / 2.6
W, D = 700.0, 0.3


@pytest.fixture
def other_elastic() -> Iterator[None]:
    with entered(SOIL_LAWS, OtherElastic):
        yield


@pytest.fixture
def hardening() -> Iterator[None]:
    with entered(SOIL_LAWS, Hardening):
        yield


@pytest.fixture
def plastic_spring() -> Iterator[None]:
    with entered(SEABED_LAWS, PlasticSpring):
        yield


def on_soil(law: Mapping, solved: str = "auto") -> Mapping:
    scene = touchdown(LAY)
    scene["solver"]["soil"] = solved
    scene["soil"] |= {"law": dict(law), "strain": "small"}
    return scene


def at_rest(scene: Mapping) -> Assembly:
    """After its only stage."""
    assembly = built(scene)
    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), Watcher(), Timer.new())
    return assembly


def shape(assembly: Assembly) -> Array:
    return assembly.riser.line.positions3(State.at_rest(0.0, assembly.size))


def test_without_its_entry_a_law_is_no_part_of_the_language() -> None:
    with pytest.raises(SceneError, match=telling("soil.law.kind:", f"one of {SOIL_WORDS};")):
        scene_from_mapping(on_soil(ELASTIC | {"kind": "toy"}))
    assert "OtherElastic" not in schema_text()


@pytest.mark.usefixtures("other_elastic")
def test_scene_with_a_new_soil_law() -> None:
    """Read, explained, written down and read again, checked, in the schema."""
    scene = scene_from_mapping(on_soil(ELASTIC | {"kind": "toy"}))
    assert isinstance(scene.soil and scene.soil.law, OtherElastic)
    assert "kind: toy" in dump_scene(scene)
    definitions = json.loads(schema_text())["$defs"]
    assert {"$ref": "#/$defs/OtherElastic"} in definitions["SoilScene"]["properties"]["law"]["anyOf"][0]["oneOf"]
    assert "soil" in describe(scene)
    for wrong, message in {
        "toys": ("soil.law.kind:", 'value "toys":', f"one of {SOIL_WORDS}, toy;", 'did you mean "toy"'),
        "von-mises": ("soil.law.su:", "missing:", "required"),
    }.items():
        with pytest.raises(SceneError, match=telling(*message)):
            scene_from_mapping(on_soil(ELASTIC | {"kind": wrong}))
    with pytest.raises(SceneError, match=telling("soil.law.stiff:", "no such key", "kind, E, nu")):
        scene_from_mapping(on_soil(ELASTIC | {"kind": "toy", "stiff": 1.0}))


@pytest.mark.usefixtures("other_elastic")
def test_run_on_a_new_soil_law() -> None:
    """A run is the same as on the law whose formula it has. Elastic soil is never computed by half."""
    toy = on_soil(ELASTIC | {"kind": "toy"})
    toy["soil"]["symmetry"] = "whole"
    known, new = at_rest(on_soil(ELASTIC, "whole")), at_rest(toy)
    np.testing.assert_array_equal(shape(new), shape(known))
    assert new.riser.contact_stiffness == known.riser.contact_stiffness


@pytest.mark.usefixtures("hardening")
def test_run_on_hardening_soil() -> None:
    """Soil yields below the riser, the less the more it hardens; without, it is the clay of the library."""
    law = {"E": 1.8e5, "nu": 0.49, "limit": np.sqrt(3.0) * 600.0}
    clay = {"kind": "von-mises", "su": 600.0, "E_over_su": 300.0, "nu": 0.49}
    soft, hard = (at_rest(on_soil({"kind": "toy", **law, "H": H})) for H in (1.0e-3, 1.0e5))
    np.testing.assert_allclose(shape(soft), shape(at_rest(on_soil(clay))), atol=1e-6)
    plastic = [float(soil_under(each).whole.output_fields().plastic_strain.max()) for each in (hard, soft)]
    assert 1e-4 < plastic[0] < 0.9 * plastic[1]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("unit_weight", [0.0, 5.0e3])
def test_hardening_soil_dissipates_what_it_does_not_store(kind: str, unit_weight: float) -> None:
    """In simple shear kappa = (sqrt(3) G gamma - limit)/(3 G + H), and limit kappa is dissipated, H kappa^2/2 stored.

    A step adds the scheme's share, half the product of the changes of its forces and elastic ways.
    """
    soil = Soil(small_block(kind), HARDENING.at_points, level=0.0, unit_weight=unit_weight)
    gamma, volume = np.linspace(0.0, 0.03, 13), 3.0
    kappa = np.maximum(np.sqrt(3.0) * G * gamma - 4.0e3, 0.0) / (3.0 * G + 3.0e5)
    tau = G * (gamma - np.sqrt(3.0) * kappa)
    scheme = np.diff(tau) ** 2 / (2.0 * G) + 3.0e5 * np.diff(kappa) ** 2 / 2.0
    flow = 4.0e3 * np.diff(kappa)
    for step in range(12):
        state = sheared(soil, gamma[step + 1] - gamma[step])
        work = soil.work(State.at_rest(1.0, soil.field.size), state)
        assert work.dissipated == pytest.approx(volume * (flow + scheme)[step], rel=1e-9)
        assert work.by_scheme == pytest.approx(volume * np.diff(tau)[step] ** 2 / (2.0 * G), rel=1e-9)
        soil.commit(state)
        soil.field.commit(state)
    stored = soil.energy(State.at_rest(1.0, soil.field.size))
    assert stored.strain == pytest.approx(volume * (tau[-1] ** 2 / (2.0 * G) + 1.5e5 * kappa[-1] ** 2), rel=1e-9)
    assert stored.potential == pytest.approx(0.0, abs=1e-9 * stored.strain)
    assert soil.output_fields().plastic_strain == pytest.approx(kappa[-1], rel=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_tangent_of_hardening_soil(kind: str) -> None:
    """The tangent beyond the law's limit, after a step."""
    soil = Soil(distorted(small_block(kind)), HARDENING.at_points, level=0.0, unit_weight=5.0e3)
    soil.commit(moved(soil, 2e-3, seed=1))
    state, direction = moved(soil, 5e-3, seed=2), moved(soil, 1.0, seed=3).u
    ahead, behind = (force(soil, State(1.0, state.u + s * direction, state.v, state.a)) for s in (1e-7, -1e-7))
    numeric = (ahead - behind) / 2e-7
    assert np.linalg.norm(assemble(soil, state) @ direction - numeric) < 1e-7 * np.linalg.norm(numeric)


TOY_BED: Mapping = {"kind": "toy", "k": 1.0e5, "limit": 400.0, "h": 2.0e4}


def test_without_its_entry_a_seabed_law_is_no_part_of_the_language() -> None:
    with pytest.raises(SceneError, match=telling("seabed.law.kind:", "one of randolph-quiggin, aubeny-biscontin;")):
        scene_from_mapping(lying())


def lying() -> Mapping:
    """A straight pipe, its ends prescribed as deep as it comes to rest: limit + h z_p = W, z = z_p + W/k."""
    plastic = (W - 400.0) / 2.0e4
    height = 0.5 * D - plastic - W / 1.0e5
    return riser_scene(
        static(),
        pipe={"EA": 3e8, "EI": 5e4, "outer_diameter": D, "submerged_weight": W},
        length=20.0,
        elements=10,
        start=prescribed(0.0, 0.0, height),
        end=prescribed(20.0, 0.0, height),
        gravity=9.81,
        dimension=2,
        seabed={"kind": "hysteretic", "law": dict(TOY_BED)},
        riser={"initial": "unstressed"},
    )


@pytest.mark.usefixtures("plastic_spring")
def test_run_on_a_new_seabed_law() -> None:
    """The riser lies level, the bed keeps what has given way, and stores W^2/(2 k) + h z_p^2/2 per length."""
    assert isinstance(scene_from_mapping(lying()).seabed, HystereticSeabed)
    assembly = at_rest(lying())
    np.testing.assert_allclose(shape(assembly)[:, 2], shape(assembly)[0, 2], atol=1e-7)
    assert assembly.riser.seabed is not None
    plastic = (W - 400.0) / 2.0e4
    np.testing.assert_allclose(assembly.riser.seabed.memory[..., 0], plastic, rtol=1e-5)
    stored = assembly.riser.seabed.energy(State.at_rest(0.0, assembly.size)).potential
    assert stored == pytest.approx(20.0 * (W**2 / 2.0e5 + 1.0e4 * plastic**2), rel=1e-5)


def test_new_seabed_law_dissipates_what_it_does_not_store() -> None:
    """Down beyond its limit and back: limit z_p in all, in the limit of small steps."""
    law = PlasticSpring(**TOY_BED).of_pipe(D)
    path = through(0.0, 0.02, 0.0, steps=2000)
    plastic = (1.0e5 * 0.02 - 400.0) / 1.2e5
    history = after(law, path)
    assert history[0, 0] == pytest.approx(plastic)
    stored = law.update(np.zeros(1), history).stored[0]
    assert stored == pytest.approx(0.5 * 2.0e4 * plastic**2)
    assert work(path, forces(law, path))[-1] - stored == pytest.approx(400.0 * plastic, rel=2e-3)
    assert not at(law, np.array([-0.1, 0.0, plastic]), history)[0].any()
