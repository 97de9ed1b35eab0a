"""Natural frequencies and shapes of risers at rest, against closed forms."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import xarray
from ruamel.yaml import YAML
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.sparse import csr_array, diags, eye
from scipy.special import jn_zeros
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.errors import SceneError, SolveError
from riser_soil.modes.eigenpairs import FEW, lowest
from riser_soil.modes.modes import Modes, modes_of
from riser_soil.modes.report import table
from riser_soil.scene.reader import scene_from_mapping
from tests.support.line_scenes import NAMES, POINT, RIGID, mooring, with_line_named
from tests.support.said import line_with, telling
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static, touchdown

LENGTH, EA, EI, MASS, TENSION = 30.0, 1.0e9, 5.0e5, 80.0, 4.0e4
BEAM: Mapping = {"EA": EA, "EI": EI, "GJ": EI, "mass": MASS, "outer_diameter": 0.3}
WATER, CA = 1025.0, 0.8
G = 9.81


def lowest_modes(scene: Mapping, count: int, **more: Any) -> Modes:
    return modes_of(scene_from_mapping(scene), count, **more)


def of_direction(modes: Modes, direction: str) -> Any:
    """Frequencies of the modes in one direction [Hz]."""
    return modes.frequency[[each == direction for each in modes.direction]]


def stretched(elements: int = 20, dimension: int = 2, pipe: Mapping = BEAM, **more: Any) -> Mapping:
    """A riser between two hinges, stretched to its tension."""
    strain = TENSION / pipe["EA"]
    return riser_scene(
        static("stretch", move={"end": [LENGTH * (1.0 + strain), 0.0, 0.0]}),
        pipe=pipe,
        length=LENGTH,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(LENGTH, 0.0, 0.0),
        dimension=dimension,
        solver={"tolerance": 1e-9},
        **more,
    )


def tensioned_beam(n: Any, added: float = 0.0, EI: float = EI) -> Any:
    """Frequencies of the stretched, hinged beam [Hz]; added mass [kg/m of the stretched pipe]."""
    stretch = 1.0 + TENSION / EA
    k = np.asarray(n) * np.pi / (LENGTH * stretch)
    return np.sqrt((k**4 * EI + k**2 * TENSION) / (MASS / stretch + added)) / (2.0 * np.pi)


def test_beam_under_tension() -> None:
    modes = lowest_modes(stretched(), 4)
    assert modes.frequency == pytest.approx(tensioned_beam([1, 2, 3, 4]), rel=1e-4)
    assert modes.asymmetry < 1e-9
    assert modes.stage == "stretch"


def test_shapes_are_sines_of_height_one_across_the_pipe() -> None:
    modes = lowest_modes(stretched(), 3)
    for n, shape in enumerate(modes.line.shape, 1):
        sine = np.sin(n * np.pi * modes.line.arc / LENGTH)
        assert np.abs(shape[:, 2]) == pytest.approx(np.abs(sine), abs=1e-4)
        assert np.abs(shape[:, :2]).max() < 1e-9
    assert modes.share[:, 0] == pytest.approx(np.ones(3))
    assert modes.direction == ["in plane"] * 3


def test_error_falls_by_the_fourth_power_of_the_elements() -> None:
    errors = [lowest_modes(stretched(elements), 3).frequency[2] / tensioned_beam(3) - 1.0 for elements in (6, 12)]
    assert errors[0] > 0.0
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)


def test_taut_string_in_water_moves_its_added_mass() -> None:
    """In space, in pairs: in and out of the plane."""
    pipe = BEAM | {"EI": 1.0, "GJ": 1.0e6, "added_mass": {"normal": CA}}
    modes = lowest_modes(stretched(dimension=3, pipe=pipe, water={"density": WATER}), 4)
    added = CA * WATER * np.pi * 0.3**2 / 4.0
    assert modes.frequency == pytest.approx(np.repeat(tensioned_beam([1, 2], added, EI=1.0), 2), rel=1e-4)
    assert modes.share[:, :2].sum(axis=1) == pytest.approx(np.ones(4))


K_GROUND = 5.0e4
PRESSED = 0.15 - MASS * G / K_GROUND  # height of the axis where springs bear the weight


def lying(*stages: Mapping, pipe: Mapping = BEAM, **more: Any) -> Mapping:
    """A riser on springs, its ends brought to as deep as its weight presses it: straight and without tension."""
    down = {"start": [0.0, 0.0, PRESSED], "end": [LENGTH, 0.0, PRESSED]}
    return riser_scene(
        static("lie", move=down),
        *stages,
        pipe=pipe,
        length=LENGTH,
        elements=20,
        start=prescribed(0.0, 0.0, 0.15),
        end=prescribed(LENGTH, 0.0, 0.15),
        gravity=G,
        seabed={"kind": "spring", "stiffness": K_GROUND},
        solver={"tolerance": 1e-10},
        **more,
    )


def test_riser_on_springs_is_a_beam_on_an_elastic_foundation() -> None:
    modes = lowest_modes(lying(), 4)
    expected = np.sqrt((EI * (np.arange(1, 5) * np.pi / LENGTH) ** 4 + K_GROUND) / MASS) / (2.0 * np.pi)
    assert modes.frequency == pytest.approx(expected, rel=1e-4)


def test_friction_sticks() -> None:
    """Along the seabed a riser that has slid as it was laid moves on the stiffness of friction, mu w/mobilisation."""
    soft, mu, mobilisation = 4.0e4, 0.5, 0.1
    slid = static("slide", move={"start": [0.5, 0.0, PRESSED], "end": [LENGTH + 0.5, 0.0, PRESSED]})
    friction = {"axial": mu, "lateral": mu, "mobilisation": mobilisation}
    modes = lowest_modes(lying(slid, pipe=BEAM | {"EA": soft}, contact={"friction": friction}), 8)
    stiffness = soft * (np.arange(1, 4) * np.pi / LENGTH) ** 2 + mu * MASS * G / mobilisation
    assert of_direction(modes, "axial")[:3] == pytest.approx(np.sqrt(stiffness / MASS) / (2.0 * np.pi), rel=3e-3)


def test_chain_that_hangs_in_water_swings_as_bessels_function() -> None:
    """Out of plane and in plane alike: (j/2) sqrt(w/((m + m_a) L)), w its weight in water."""
    volume = np.pi * 0.3**2 / 4.0
    pipe = BEAM | {"EI": 1.0, "GJ": 1.0e6, "added_mass": {"normal": CA}}
    hanging = riser_scene(
        static("hang"),
        pipe=pipe,
        length=LENGTH,
        elements=40,
        start=prescribed(0.0, 0.0, LENGTH),
        end="free",
        gravity=G,
        water={"density": WATER / 2.0},
        riser={"initial": {"points": [[0.0, 0.0, LENGTH], [0.0, 0.0, 0.0]]}},
        dimension=3,
    )
    modes = lowest_modes(hanging, 4)
    w, m = (MASS - WATER / 2.0 * volume) * G, MASS + CA * WATER / 2.0 * volume
    expected = jn_zeros(0, 2) / (4.0 * np.pi) * np.sqrt(w / (m * LENGTH))
    assert modes.frequency == pytest.approx(np.repeat(expected, 2), rel=1e-3)


def cable(span: float, tension: float, EA: float) -> Mapping:
    """A shallow cable between two hinges of one height; its length is that of the elastic parabola."""
    w = MASS * G
    sag = w * span**2 / (8.0 * tension)
    length = span * (1.0 + 8.0 / 3.0 * (sag / span) ** 2)
    return riser_scene(
        static("hang"),
        pipe=BEAM | {"EA": EA, "EI": 1.0, "GJ": 1.0e6},
        length=length / (1.0 + tension / EA),
        elements=40,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(span, 0.0, 0.0),
        gravity=G,
        dimension=3,
        riser={"initial": "catenary"},
    )


def test_shallow_cable_has_irvines_frequencies() -> None:
    """Out of plane and antisymmetric in plane those of the taut string, symmetric ones by its parameter lambda2."""
    span, H, stiff = 100.0, 1.0e6, 1.0e9
    ratio = MASS * G * span / H
    parameter = ratio**2 * stiff / H / (1.0 + ratio**2 / 8.0)

    def balance(x: float) -> float:
        return float(np.tan(x) - x + 4.0 / parameter * x**3)

    string = np.sqrt(H / MASS) / (2.0 * span)
    symmetric = 2.0 / np.pi * brentq(balance, np.pi / 2.0 + 1e-6, 3.0 * np.pi / 2.0 - 1e-6)
    modes = lowest_modes(cable(span, H, stiff), 6)
    assert of_direction(modes, "out of plane")[:3] == pytest.approx(string * np.arange(1, 4), rel=1e-3)
    assert np.sort(of_direction(modes, "in plane"))[:2] == pytest.approx(
        np.sort([2.0 * string, symmetric * string]), rel=1e-3
    )


def test_what_is_not_symmetric_is_reported_by_the_frequencies() -> None:
    """Squares of [[2, a], [-a, 3]] are (5 +- sqrt(1 - 4 a2))/2; those of the symmetric part are 2 and 3."""
    a = 0.3
    K = csr_array([[2.0, a, 0.0], [-a, 3.0, 0.0], [0.0, 0.0, 1e6]])
    pairs = lowest(K, csr_array(np.eye(3)), 2, -1e-6)
    exact = (5.0 + np.array([-1.0, 1.0]) * np.sqrt(1.0 - 4.0 * a**2)) / 2.0
    assert pairs.squares == pytest.approx([2.0, 3.0])
    assert pairs.asymmetry == pytest.approx(np.abs(np.sqrt(exact / [2.0, 3.0]) - 1.0).max())


def test_what_has_no_mass_follows() -> None:
    """A mass on two springs in series, in whose middle there is none."""
    k = np.array([3.0, 6.0])
    K = csr_array([[k[1], -k[1], 0.0], [-k[1], k.sum(), 0.0], [0.0, 0.0, 50.0]])
    M = csr_array(np.diag([2.0, 0.0, 1.0]))
    pairs = lowest(K, M, 2, -1e-6)
    assert pairs.squares == pytest.approx([1.0 / (1.0 / k).sum() / 2.0, 50.0])


def test_sparse_and_dense_problems_have_the_same_modes() -> None:
    """A chain of masses on springs: 2 sin(pi k/(2 (n + 1))), as many masses as either way takes, and two more."""
    for n in (FEW - 1, FEW + 1):
        K = csr_array(diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)))
        pairs = lowest(K, csr_array(eye(n)), 5, -1e-9)
        assert np.sqrt(pairs.squares) == pytest.approx(2.0 * np.sin(np.pi * np.arange(1, 6) / (2.0 * (n + 1))))
        assert pairs.modes @ pairs.modes.T == pytest.approx(np.eye(5), abs=1e-9)
        assert np.abs(K @ pairs.modes[2] - pairs.squares[2] * pairs.modes[2]).max() < 1e-9


def test_more_modes_than_there_are_may_be_asked_for() -> None:
    n = FEW + 1
    K = csr_array(diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)))
    pairs = lowest(K, csr_array(eye(n)), 2 * n, -1e-9)
    assert np.sqrt(pairs.squares) == pytest.approx(2.0 * np.sin(np.pi * np.arange(1, n + 1) / (2.0 * (n + 1))))


def test_half_waves_as_short_as_elements_have_no_shape() -> None:
    """In the second mode of a hinged beam of two elements, and in all modes of one element, the nodes turn where they
    are.
    """
    modes = lowest_modes(stretched(2), 2)
    assert modes.direction == ["in plane", "at no node"]
    assert not modes.line.shape[1].any()
    assert np.isnan(modes.share[1]).all()
    assert modes.frequency == pytest.approx(tensioned_beam([1, 2]), rel=0.12)
    assert lowest_modes(stretched(1), 1).direction == ["at no node"]


def moment_at_the_tip(moment: float) -> Mapping:
    """A cantilever in space, whose tip is turned about an axis that stays: its tangent is not symmetric."""
    return riser_scene(
        static("twist", loads=[{"at": "end", "moment": [moment, 0.0, 0.0]}]),
        pipe=BEAM | {"GJ": 1.0e9},
        length=LENGTH,
        elements=6,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        dimension=3,
    )


def test_a_tangent_far_from_symmetric_is_refused() -> None:
    assert 0.0 < lowest_modes(moment_at_the_tip(1.0e2), 2).asymmetry < 1e-3
    with pytest.raises(SolveError, match=telling("tangent at rest", "not symmetric", "more than 0.01", "leave out")):
        lowest_modes(moment_at_the_tip(1.0e4), 2)


def test_command_leaves_shapes_and_a_picture(tmp_path: Path) -> None:
    folder = tmp_path / "modes"
    with (tmp_path / "beam.yaml").open("w", encoding="utf-8") as file:
        YAML(typ="safe").dump(stretched(6), file)
    call = ["modes", str(tmp_path / "beam.yaml"), "--count", "3", "--plot", "-o", str(folder)]
    done = CliRunner().invoke(app, call)
    assert done.exit_code == 0, done.output
    assert f"{tensioned_beam(1):.3f}" in done.output
    with xarray.open_dataset(folder / "modes.nc", engine="h5netcdf") as stored:
        assert stored["frequency"].attrs["units"] == "Hz"
        assert stored["shape"].sel(mode=2, component="z").values[3] == pytest.approx(0.0, abs=1e-9)
        assert float(abs(stored["shape"].sel(component="z")).max()) == pytest.approx(1.0)
    assert (folder / "modes.png").read_bytes().startswith(b"\x89PNG")
    again = CliRunner().invoke(app, call)
    assert again.exit_code == 2
    assert again.output == line_with(again.output, f"{folder}/modes.nc:", "there already", "-o", "--force") + "\n"


@pytest.mark.parametrize(
    ("stages", "name", "message"),
    [
        ([dynamic(1.0, 0.1)], None, "stages: modes are those of a riser at rest; begin with a static stage"),
        ([static("lay")], "hang", '--stage "hang": the scene has no such stage; it has lay'),
        (
            [static("lay"), dynamic(1.0, 0.1), static("rest")],
            "rest",
            '--stage "rest": a riser at rest is that after static stages alone; name one of the first',
        ),
    ],
)
def test_only_static_stages_have_modes(stages: list[Mapping], name: str | None, message: str) -> None:
    with pytest.raises(SceneError) as refused:
        lowest_modes(stretched(6) | {"stages": stages}, 2, stage=name)
    assert str(refused.value) == message


def test_first_static_stage_may_be_asked_for() -> None:
    """Before it is stretched the beam has no tension."""
    scene = stretched()
    slack = scene | {"stages": [static("lie"), *scene["stages"]]}
    alone = (np.pi / LENGTH) ** 2 * np.sqrt(EI / MASS) / (2.0 * np.pi)
    assert lowest_modes(slack, 1, stage="lie").frequency[0] == pytest.approx(alone, rel=1e-4)
    assert lowest_modes(slack, 1).frequency[0] == pytest.approx(tensioned_beam(1), rel=1e-4)


@pytest.mark.verify
def test_whole_and_condensed_soil_hold_a_riser_alike() -> None:
    """Soil without mass follows the riser; stiffer soil makes higher frequencies."""
    scene = touchdown()
    scene["soil"]["law"] = {"kind": "linear-elastic", "E": 2.0e5, "nu": 0.45}
    ways = ({"soil": way, "tolerance": 1e-9} for way in ("whole", "condensed"))
    whole, condensed = (lowest_modes(scene | {"solver": way}, 3) for way in ways)
    assert whole.frequency == pytest.approx(condensed.frequency, rel=1e-6)
    assert np.abs(whole.line.shape - condensed.line.shape).max() < 1e-4
    scene["soil"]["law"]["E"] = 2.0e7
    assert (lowest_modes(scene, 3).frequency > 1.0001 * condensed.frequency).all()


def tethered(body: Mapping, pipe: Mapping, elements: int) -> Mapping:
    """A buoy on a line from the sea's floor, by a joint that is 1 m below the origin of its axes if it is rigid."""
    arm = 1.0 if body["kind"] == "rigid" else 0.0
    line = {
        "segments": [{"line_type": "rope", "length": LENGTH, "elements": elements}],
        "start": {"position": [0.0, 0.0, 0.0]},
        "end": "free",
        "initial": "straight",
    }
    between = [{"line": "tether", "at": "end"}, {"body": "buoy", "offset": [0.0, 0.0, -arm]}]
    return {
        "water": {"density": WATER},
        "line_types": {"rope": pipe},
        "lines": {"tether": line},
        "bodies": {"buoy": body | {"position": [0.0, 0.0, 1.0004 * LENGTH + arm]}},
        "joints": {"top": {"kind": "pinned", "between": between}},
        "stages": [static("rest")],
        "solver": {"tolerance": 1e-9},
    }


def test_a_buoy_on_a_heavy_tether() -> None:
    """A string, and a bar, with a mass at its end: x tan x = m L / M, x = ω L / c; m of the line, M of the buoy."""
    size = 0.1
    rope = {"EA": 1.0e6, "EI": 1.0, "GJ": 1.0e4, "mass": WATER * np.pi / 4.0 * size**2, "outer_diameter": size}
    modes = lowest_modes(tethered(POINT, rope, 40), 5)
    M, T = POINT["mass"] + POINT["added_mass"] * WATER * POINT["volume"], (POINT["volume"] * WATER - POINT["mass"]) * G
    m, strain = rope["mass"], T / rope["EA"]
    x = [brentq(lambda x: x * np.tan(x) - m * LENGTH / M, n * np.pi, (n + 0.5) * np.pi - 1e-9) for n in (0, 1)]
    swaying = np.array(x) * np.sqrt(T / (m * (1.0 + strain))) / LENGTH
    heaving = x[0] * np.sqrt(rope["EA"] / m) / LENGTH
    expected = np.sort([*np.repeat(swaying, 2), heaving]) / (2.0 * np.pi)
    assert modes.frequency == pytest.approx(expected, rel=2e-4)
    assert modes.moving_most == ["buoy"] * 3 + ["tether"] * 2
    top, buoy = modes.lines["tether"].shape[:3, -1], modes.bodies["buoy"].shape[:3]
    assert top == pytest.approx(buoy, abs=1e-3), "where the joint holds them together"
    assert not modes.bodies["buoy"].rotation.any()


def test_a_rigid_buoy_on_a_light_tether() -> None:
    """A pendulum of two links upside down, about either axis; nothing holds it from turning about the line."""
    rope = {"EA": 1.0e8, "EI": 1.0e-2, "GJ": 1.0e4, "mass": 0.2, "outer_diameter": 0.02}
    modes = lowest_modes(tethered(RIGID, rope, 4), 5)
    m, W, B = RIGID["mass"], RIGID["mass"] * G, RIGID["volume"] * WATER * G
    low, high = 1.0 + RIGID["centre_of_gravity"][2], 1.0 + RIGID["centre_of_buoyancy"][2]
    K, expected = np.diag([(B - W) * LENGTH, B * high - W * low]), [0.0]
    for along, about in ((0, 1), (1, 0)):  # sways along x as it turns about y
        added, J = RIGID["added_mass"][along] * WATER * RIGID["volume"], RIGID["inertia"][about]
        arms = np.array([[LENGTH, low], [LENGTH, high]])
        M = arms.T @ np.diag([m, added]) @ arms
        M += np.diag([rope["mass"] * LENGTH**3 / 3.0, J + RIGID["added_inertia"][about]])
        expected += np.sqrt(eigh(K, M, eigvals_only=True)).tolist()
    assert modes.frequency == pytest.approx(np.sort(expected) / (2.0 * np.pi), rel=1e-3, abs=1e-4)
    assert (modes.direction[0], modes.moving_most[0]) == ("of a body", "buoy")
    assert [line.split().count("-") for line in table(modes, 5)[2:]] == [4, 0, 0, 0, 0]
    assert line_with(table(modes, 5), "of a body").endswith("  buoy")
    turn = modes.bodies["buoy"].rotation
    assert np.abs(turn[0]).argmax() == 2
    assert np.abs(turn[3:, :2]).max() > 0.3
    assert turn[3:, 2] == pytest.approx([0.0, 0.0], abs=1e-6)


def test_modes_of_several_lines_have_groups_and_a_picture(tmp_path: Path) -> None:
    file, folder = tmp_path / "mooring.yaml", tmp_path / "modes"
    file.write_text(json.dumps(mooring(elements=8, body=RIGID)), encoding="utf-8")
    done = CliRunner().invoke(app, ["modes", str(file), "--count", "4", "--plot", "-o", str(folder)])
    assert done.exit_code == 0, done.output
    assert all(line.rsplit("  ", 1)[1] in (*NAMES, "buoy") for line in done.output.splitlines()[2:6])
    shapes = []
    for group in (*NAMES, "bodies/buoy"):
        with xarray.open_dataset(folder / "modes.nc", engine="h5netcdf", group=group) as stored:
            assert stored["shape"].attrs["units"] == "1"
            shapes.append(np.linalg.norm(stored["shape"].values, axis=-1).reshape(4, -1).max(axis=1))
    assert np.max(shapes, axis=0) == pytest.approx(np.ones(4), abs=0.3)
    with xarray.open_dataset(folder / "modes.nc", engine="h5netcdf") as stored:
        assert stored["frequency"].shape == (4,)
    with h5py.File(folder / "modes.nc") as file:
        for name in {*file} - {*NAMES}:
            with pytest.raises(SceneError, match=telling(f"lines.{name}", "rename")):
                scene_from_mapping(with_line_named(name))
    assert (folder / "modes.png").read_bytes().startswith(b"\x89PNG")
