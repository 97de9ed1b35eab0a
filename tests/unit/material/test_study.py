"""`riser-soil material`: curves and loops of one point against closed forms; what it refuses; what it leaves."""

from __future__ import annotations

import errno
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from riser_soil.__main__ import app
from riser_soil.core.arrays import Array
from riser_soil.material.memory import CYCLES
from riser_soil.material.path import shear_path
from riser_soil.material.point import MaterialPoint, drive
from riser_soil.material.study import closed_cycles, turns
from riser_soil.soil.law import SoilLaw
from riser_soil.soil.laws import LAWS
from tests.support.on_ranks import HANGS, ROOT, environment
from tests.support.said import line_with
from tests.support.scenes import touchdown

E, NU, SU = 1.2e6, 0.45, 4.0e3
G = E / (2.0 * (1.0 + NU))
CURVE = ((1e-4, 0.98), (1e-3, 0.8), (5e-3, 0.45), (2e-2, 0.2))
ELASTIC = {"kind": "linear-elastic", "E": E, "nu": NU}
IWAN = {"kind": "iwan", "su": SU, "E_over_su": E / SU, "nu": NU, "curve": [list(point) for point in CURVE]}
SAND = {
    "kind": "drucker-prager",
    "friction_angle_deg": 35.0,
    "dilation_angle_deg": 5.0,
    "cohesion": 200.0,
    "E": 2.0e7,
    "match": "triaxial-compression",
}
KINEMATIC = {"kind": "kinematic-hardening", "su": SU, "E_over_su": E / SU, "nu": NU, "elastic_share": 0.2}
FILES = {"material.csv", "material_cycles.csv", "material_memory.csv", "material.png"}
Call = Callable[..., Result]


def drawn(curve: Path, cycles: Path, png: Path) -> None:
    png.write_bytes(b"riser_soil material: ")


@pytest.fixture
def material(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Call:
    """Runs the command in an empty folder, on the small scene's soil with a law, along the text of a CSV file; draws
    where no path is given. cycles: of a mean stress and a mean strain, of which a law keeps what it remembers.
    """
    monkeypatch.chdir(tmp_path)

    def call(law: dict[str, Any], path: str | None = None, *options: str, cycles: int = 2, **soil: float) -> Result:
        monkeypatch.setattr("riser_soil.material.memory.CYCLES", cycles)
        scene = touchdown()
        scene["soil"] |= {"law": law, **soil}
        Path("scene.yaml").write_text(json.dumps(scene))
        if path is not None:
            Path("path.csv").write_text(path)
            options = ("--path", "path.csv", *options)
            monkeypatch.setattr("riser_soil.plots.soil_curves.draw", drawn)
        return CliRunner().invoke(app, ["material", "scene.yaml", *options])

    return call


def table(name: str, folder: str = "scene_material") -> dict[str, Array]:
    lines = (Path(folder) / name).read_text().splitlines()
    names = [word.split(" [")[0] for word in lines[1].split(", ")]
    return dict(zip(names, np.array([row.split(", ") for row in lines[2:]], dtype=float).T, strict=True))


def rows(header: str, *columns: Array) -> str:
    return "\n".join([header, *(", ".join(f"{x:.17g}" for x in row) for row in zip(*columns, strict=True))])


def test_elastic_shear_has_modulus_g_and_no_damping(material: Call) -> None:
    done = material(ELASTIC)
    assert done.exit_code == 0, done.output
    cycles = table("material_cycles.csv")
    assert len(cycles["strain_amplitude"]) == 16
    np.testing.assert_allclose(cycles["secant_modulus"], G, rtol=1e-9)
    np.testing.assert_allclose(cycles["damping_ratio"], 0.0, atol=1e-12)
    assert {file.name for file in Path("scene_material").iterdir()} == FILES
    assert (Path("scene_material") / "material.png").read_bytes().startswith(b"\x89PNG")


def test_elastic_compression_between_free_sides_has_youngs_modulus(material: Call) -> None:
    strain = np.array([-1e-3, 0.0, 1e-3, -1e-3, 1e-3])
    still = np.zeros(5)
    done = material(ELASTIC, rows("eps_zz [-], sigma_xx [kPa], sigma_yy [kPa]", strain, still, still), "--depth", "0.5")
    assert done.exit_code == 0, done.output
    curve = table("material.csv")
    np.testing.assert_allclose(curve["sigma_zz"][1:] + 2500.0, E * strain, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(curve["eps_xx"][1:], -NU * strain, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(table("material_cycles.csv")["secant_modulus"], E, rtol=1e-9)


def backbone(gamma: Array) -> Array:
    strain = np.array([0.0, *(g for g, _ in CURVE)])
    stress = G * strain * np.array([1.0, *(ratio for _, ratio in CURVE)])
    slope = (stress[-1] - stress[-2]) / (strain[-1] - strain[-2])
    return np.interp(gamma, [*strain, strain[-1] + (SU - stress[-1]) / slope], [*stress, SU])


@pytest.mark.parametrize("amplitude", [3e-4, 3e-3, 1.5e-2])
def test_loops_of_the_overlay_have_masings_damping(material: Call, amplitude: float) -> None:
    """(8 ∫f dγ - 4 τa γa)/(2π τa γa), with rows at the loop's corners."""
    corners = np.array([g for g, _ in CURVE if g < amplitude])
    way = np.append(2.0 * corners, 2.0 * amplitude)
    down, up = amplitude - way, way - amplitude
    gamma = np.concatenate([corners, [amplitude], down, up, down, up])
    done = material(IWAN, rows("gamma_xz [%]", 100.0 * gamma))
    assert done.exit_code == 0, done.output
    points = np.concatenate([[0.0], corners, [amplitude]])
    integral = np.sum(0.5 * (backbone(points[1:]) + backbone(points[:-1])) * np.diff(points))
    tau = float(backbone(np.array([amplitude]))[0])
    damping = (8.0 * integral - 4.0 * tau * amplitude) / (2.0 * np.pi * tau * amplitude)
    cycles = table("material_cycles.csv")
    assert damping > 0.003
    assert len(cycles["damping_ratio"]) == 3
    np.testing.assert_allclose(cycles["damping_ratio"], damping, rtol=1e-6)
    np.testing.assert_allclose(cycles["secant_modulus"], tau / amplitude, rtol=1e-9)
    np.testing.assert_allclose(cycles["strain_amplitude"], amplitude, rtol=1e-9)


def test_dissipation_is_the_area_of_the_loops(material: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("riser_soil.plots.soil_curves.draw", drawn)
    assert material(IWAN).exit_code == 0
    curve = table("material.csv")
    cycles = table("material_cycles.csv")
    lost = np.diff(curve["dissipated"][np.stack([cycles["first_row"], cycles["last_row"]]).astype(int)], axis=0)[0]
    area = 2.0 * np.pi * cycles["damping_ratio"] * cycles["secant_modulus"] * cycles["strain_amplitude"] ** 2
    np.testing.assert_allclose(lost, area, rtol=1e-6, atol=1e-9)
    assert area[-1] > 1.0
    np.testing.assert_allclose(curve["sigma_zz"], curve["sigma_zz"][0], rtol=1e-9)


def law_of(given: dict[str, Any]) -> SoilLaw:
    return LAWS[given["kind"]].model_validate(given)


def test_a_fading_backstress_lets_go_of_a_mean_stress() -> None:
    """Half of it in each cycle of the amplitude that the law tells: of a little that a longer way has left."""
    law = law_of(KINEMATIC)
    amplitude = law.forgets_at
    assert amplitude is not None
    point = MaterialPoint(law.at_points(np.array([1.0]), np.zeros((1, 6))), np.zeros((1, 6)))
    rows = 200
    path = shear_path([0.0, *(amplitude, -amplitude) * 6, 1.02 * amplitude, *(-amplitude, amplitude) * 4], rows)
    stress = drive(point, path).stress[13 * rows :: rows, 4]
    mean = stress[1::2] + stress[2::2]
    np.testing.assert_allclose(mean[1:] / mean[:-1], 0.5, rtol=0.02)


def test_a_fading_backstress_strains_on_under_a_mean_stress(material: Call) -> None:
    """(1/k) ln[(a² - αmin²)/(a² - αmax²)] in each cycle, see riser_soil/soil/kinematic_hardening.py."""
    done = material(KINEMATIC, "gamma_xz [-]\n1e-4\n", cycles=CYCLES)
    assert done.exit_code == 0, done.output
    memory = table("material_memory.csv")
    largest, a, q0 = memory["stress_at_0.001"][0], 0.8 * SU, 0.2 * SU
    low, high = 0.1 * largest + q0, 0.7 * largest - q0
    added = np.diff(memory["strain_of_stress_cycles"])
    np.testing.assert_allclose(added, 3.0 * a / E * np.log((a**2 - low**2) / (a**2 - high**2)), rtol=0.03)
    assert f"{added[-1]:.5f} more by the last" in done.output


@pytest.mark.parametrize("law", [IWAN, ELASTIC], ids=["iwan", "linear elastic"])
def test_closed_loops_keep_mean_stress_and_strain(material: Call, law: dict[str, Any]) -> None:
    done = material(law, "gamma_xz [-]\n1e-4\n", cycles=5)
    assert done.exit_code == 0, done.output
    memory = table("material_memory.csv")
    del memory["cycle"]
    for name, values in memory.items():
        np.testing.assert_allclose(values, values[0], rtol=1e-6, err_msg=name)
    assert law_of(law).forgets_at is None


@pytest.mark.verify
def test_drained_triaxial_compression_of_sand_fails_as_coulomb_says(material: Call) -> None:
    strain, still = np.linspace(0.0, -0.01, 101)[1:], np.zeros(100)
    done = material(SAND, rows("eps_zz [-], sigma_xx [Pa], sigma_yy [Pa]", strain, still, still), K0=0.5)
    assert done.exit_code == 0, done.output
    passive = (1.0 + np.sin(np.radians(35.0))) / (1.0 - np.sin(np.radians(35.0)))
    curve = table("material.csv")
    side = -curve["sigma_xx"][-1]
    assert side == pytest.approx(0.5 * 5.0e3 * 0.5, rel=1e-9)
    assert -curve["sigma_zz"][-1] == pytest.approx(passive * side + 2.0 * 200.0 * np.sqrt(passive), rel=1e-8)


def test_more_stress_than_the_soil_bears_is_reported_and_leaves_nothing(material: Call) -> None:
    done = material(IWAN, "tau_xz [kPa]\n1.0\n5.0\n")
    assert done.exit_code == 3
    assert done.output == line_with(done.output, "path.csv, row 2:", "no strain", "tau_xz") + "\n"
    assert not Path("scene_material").exists()


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("", "path.csv: the file is empty"),
        ("gamma_xz [-]\n", "path.csv:1: there are no rows below the header"),
        ("gamma_xz\n0.1", "path.csv:1:"),
        ("gamma_xw [-]\n0.1", "no such column"),
        ("gamma_xz [Pa]\n0.1", "gamma_xz can't be in [Pa]"),
        ("gamma_xz [-]\nnan", "path.csv:2: gamma_xz"),
        ("gamma_xz [-], tau_xz [Pa]\n0.1, 2", "exclude each other"),
        ("gamma_xz [-]\n0.1, 2", "path.csv:2: the row has 2 values"),
        ("time [s]\n1.0", "no strain and no stress beside time"),
    ],
)
def test_a_bad_path_is_reported_in_one_line(material: Call, path: str, message: str) -> None:
    done = material(ELASTIC, path)
    assert done.exit_code == 2
    assert message in done.output
    assert done.output.count("\n") == 1
    assert not Path("scene_material").exists()


@pytest.mark.parametrize(
    ("options", "soil", "message"),
    [
        (("--depth", "1.5"), {}, "--depth 1.5: must lie in the soil, from 0 to 1 m"),
        (("--path", "no.csv"), {}, "no.csv: "),
        ((), {"K0": 0.01, "submerged_unit_weight": 5.0e4}, "times what the soil bears"),
        (("-o", "scene.yaml"), {}, "is a file, not a folder"),
    ],
)
def test_what_makes_no_sense_is_reported(
    material: Call, options: tuple[str, ...], soil: dict[str, float], message: str
) -> None:
    done = material(IWAN, None, *options, **soil)
    assert done.exit_code == 2
    assert message in done.output
    assert done.output.count("\n") == 1


def test_a_scene_without_soil_is_refused(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["material", str(ROOT / "demos/first_scene.yaml"), "-o", str(tmp_path / "out")])
    assert done.exit_code == 2
    line_with(done.output, "soil:", "scene has none")
    assert not (tmp_path / "out").exists()


def test_files_are_replaced_by_force_only_and_foreign_ones_never(material: Call) -> None:
    path = "gamma_xz [-]\n1e-4\n"
    assert material(ELASTIC, path).exit_code == 0
    again = material(ELASTIC, path)
    assert again.exit_code == 2
    assert "add --force" in again.output
    assert material(ELASTIC, None, "--force").exit_code == 0
    assert material(ELASTIC, path, "--force").exit_code == 0
    foreign = Path("scene_material/material_cycles.csv")
    foreign.write_text("my own table\n")
    refused = material(ELASTIC, path, "--force")
    assert refused.exit_code == 2
    line_with(refused.output, f"{foreign}:", "not written by riser_soil")
    assert foreign.read_text() == "my own table\n"


def test_a_full_disk_leaves_the_old_files_whole(material: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    assert material(ELASTIC, "gamma_xz [-]\n1e-4\n").exit_code == 0
    before = {file: (Path("scene_material") / file).read_bytes() for file in FILES}

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("riser_soil.material.study._cycle_columns", full)  # the curve is written by then
    done = material(ELASTIC, "gamma_xz [-]\n2e-4\n", "--force")
    assert done.exit_code == 4
    assert {file.name: file.read_bytes() for file in Path("scene_material").iterdir()} == before


def test_turns_and_closed_cycles_are_found() -> None:
    x = np.array([0.0, 1.0, 2.0, 2.0, 0.0, -2.0, -1.0, 2.0, 3.0])
    assert turns(x).tolist() == [0, 3, 5, 8]
    assert closed_cycles(x, x, x) == []
    whole = np.array([0.0, 2.0, 0.0, -2.0, 0.0, 2.0])
    (cycle,) = closed_cycles(whole, whole, 3.0 * whole)
    assert (cycle.first, cycle.last, cycle.amplitude, cycle.secant_modulus) == (1, 5, 2.0, 3.0)


def test_nothing_that_solves_is_imported(tmp_path: Path) -> None:
    scene = touchdown()
    (tmp_path / "scene.yaml").write_text(json.dumps(scene))
    (tmp_path / "path.csv").write_text("gamma_xz [%]\n1.0\n-1.0\n")
    code = (
        "import sys; from riser_soil.__main__ import app\n"
        "try: app(['material', 'scene.yaml', '--path', 'path.csv'])\n"
        "except SystemExit as end: assert not end.code\n"
        "print({'dolfinx', 'petsc4py', 'mpi4py', 'gmsh', 'pyvista', 'numba'} & sys.modules.keys())"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=HANGS
    )
    assert done.stdout.splitlines()[-1:] == ["set()"], done.stdout + done.stderr


VISCOUS = {"kind": "von-mises", "su": SU, "E_over_su": E / SU, "nu": NU, "rate": {"mu": 0.1, "reference": 1e-5}}


@pytest.mark.parametrize(("times", "gain"), [(1.0, 0.0), (10.0, 0.1), (100.0, 0.2)])
def test_shear_in_time_finds_the_strength_of_its_rate(material: Call, times: float, gain: float) -> None:
    gamma = np.linspace(0.0, 0.1, 201)[1:]
    done = material(VISCOUS, rows("time [min], gamma_xz [%]", gamma / (times * 1e-5) / 60.0, 100.0 * gamma))
    assert done.exit_code == 0, done.output
    assert table("material.csv")["tau_xz"][-1] == pytest.approx(SU * (1.0 + gain), rel=1e-6)


def test_stress_beyond_slow_strength_is_borne_by_creep(material: Call) -> None:
    """At 1.15 su a strain rate of 10^1.5 times the reference, for as long as it is held."""
    times, tau = np.arange(1.0, 41.0) * 60.0, np.full(40, 1.15 * SU)
    done = material(VISCOUS, rows("time [s], tau_xz [Pa]", times, tau))
    assert done.exit_code == 0, done.output
    creep = np.diff(table("material.csv")["gamma_xz"][1:]) / 60.0
    np.testing.assert_allclose(creep, 1e-5 * 10.0**1.5, rtol=1e-6)


@pytest.mark.parametrize("times", ["0.0", "-1.0", "1.0, 0\n1.0"])
def test_time_that_does_not_grow_is_reported(material: Call, times: str) -> None:
    done = material(VISCOUS, f"time [s], gamma_xz [-]\n{times}, 0.1\n")
    assert done.exit_code == 2
    assert done.output == line_with(done.output, f"path.csv:{2 + times.count(chr(10))}:", "time must grow") + "\n"
