"""RAOs as capytaine writes them, against the motion of the water itself."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from pydantic_core import PydanticCustomError

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.rao import Rao, read_capytaine
from riser_soil.scene.reader import scene_from_mapping
from tests.support.netcdf_files import Variables, write_netcdf
from tests.support.scenes import AIRY, VESSEL_END, below_vessel, dynamic

DOFS = np.array(["Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw"])
OMEGA = np.array([0.1, 0.5, 1.0, 3.0])
BETA = np.radians(np.arange(0.0, 360.0, 45.0))
G = 9.81


def following(omega: Array = OMEGA) -> Array:
    """(8, n, 6) of what is as small as a particle at the surface of deep water, and lies flat on it.

    Capytaine's potential is -i g/w exp(kz + ik(x cos b + y sin b)), all amplitudes Re(X exp(-iwt)). So velocity is its
    gradient, displacement that over -iw, and the surface exp(ik(...)) has the slope ik(cos b, sin b).
    """
    k, response = omega**2 / G, np.zeros((BETA.size, omega.size, 6), dtype=complex)
    for n, beta in enumerate(BETA):
        gradient = -1j * G / omega * k * np.array([1j * np.cos(beta) + 0 * k, 1j * np.sin(beta) + 0 * k, 1.0 + 0 * k])
        response[n, :, :3] = (gradient / (-1j * omega)).T
        slope = 1j * k
        response[n, :, 3], response[n, :, 4] = slope * np.sin(beta), -slope * np.cos(beta)
    return response


def variables(values: Array, omega: Array = OMEGA) -> Variables:
    """Variables with complex numbers in two parts, and dimensions in another order than ours."""
    dims = ("complex", "omega", "radiating_dof", "wave_direction")
    return {
        "complex": (("complex",), np.array(["re", "im"])), "omega": (("omega",), omega),
        "wave_direction": (("wave_direction",), BETA), "radiating_dof": (("radiating_dof",), DOFS),
        "RAO": (dims, np.stack([values.real, values.imag]).transpose(0, 2, 3, 1)),
    }  # fmt: skip


def written(folder: Path, dataset: Any) -> Rao:
    write_netcdf(folder / "rao.nc", dataset)
    return read_capytaine(folder / "rao.nc")


def test_lags_of_a_particle_at_the_surface(tmp_path: Path) -> None:
    """The water goes forward at the crest, so it is farthest a quarter of a period later; before the crest comes, its
    bow is up: pitch lags by 270 degrees.
    """
    rao = written(tmp_path, variables(following()))
    lag = {mode: math.degrees(-np.angle(rao.response[mode][0][1])) % 360.0 for mode in ("surge", "heave", "pitch")}
    assert lag == pytest.approx({"surge": 90.0, "heave": 0.0, "pitch": 270.0})
    assert rao.frequency == pytest.approx(OMEGA)
    assert rao.direction == pytest.approx(BETA)
    assert abs(rao.response["pitch"][0][1]) == pytest.approx(OMEGA[1] ** 2 / G)


def test_an_end_moves_as_the_water_does(tmp_path: Path) -> None:
    """In the scene's own wave, a cos(k n.x - w t + p) of deep water, which goes by -a sin(...) along n; the vessel
    heads askew, and its reference is away from the origin.
    """
    height, period, toward, phase = (AIRY["airy"][key] for key in ("height", "period", "direction_deg", "phase_deg"))
    w = 2.0 * math.pi / period
    omega = np.array([0.5 * w, w, 2.0 * w])
    write_netcdf(tmp_path / "rao.nc", variables(following(omega), omega))
    for heading in (toward - 90.0, toward + 135.0):
        vessel = {"rao": "rao.nc", "reference": VESSEL_END, "heading_deg": heading}
        stage = dynamic(20.0, 0.2, "sail", motion={"end": {"vessel": vessel}})
        scene = scene_from_mapping(below_vessel(stage, waves=AIRY, rotation="fixed"), tmp_path)
        assembly = build(scene, MPI.COMM_SELF)
        assembly.begin(scene.stages[0])
        motion, turning = assembly.riser.line.end.motion, assembly.riser.line.end.turning
        assert motion is not None
        assert turning is not None
        n, t, k = np.array([math.cos(math.radians(toward)), math.sin(math.radians(toward)), 0.0]), 17.3, w**2 / G
        angle = k * float(n @ VESSEL_END) - w * t + math.radians(phase)
        moved = 0.5 * height * (math.cos(angle) * np.array([0.0, 0.0, 1.0]) - math.sin(angle) * n)
        assert motion(t)[0] - VESSEL_END == pytest.approx(moved, abs=1e-6)
        steepest = 0.5 * height * k * math.sin(angle) * np.cross([0.0, 0.0, 1.0], n)
        assert turning(t).rotation == pytest.approx(steepest, abs=1e-6)


def changed(**other: Any) -> Variables:
    return {name: each for name, each in {**variables(following()), **other}.items() if each is not None}


def test_other_forms(tmp_path: Path) -> None:
    """Tables by periods, from high to low frequency; names with a body's; complex numbers of the file's own."""
    first = written(tmp_path, variables(following()))
    values = following()[:, ::-1].transpose(1, 0, 2)
    other = {
        "period": (("period",), 2.0 * math.pi / OMEGA[::-1]), "wave_direction": (("wave_direction",), BETA),
        "influenced_dof": (("influenced_dof",), np.array([f"hull__{name}" for name in DOFS])),
        "complex": (("complex",), np.array(["im", "re"])),
        "RAO": (
            ("period", "wave_direction", "influenced_dof", "complex"), np.stack([values.imag, values.real], axis=3)
        ),
    }  # fmt: skip
    second = written(tmp_path, other)
    assert second.frequency == pytest.approx(first.frequency)
    for mode, table in first.response.items():
        assert np.array(second.response[mode]) == pytest.approx(np.array(table), abs=1e-15)


def by_capytaine(version: int, along: str = "omega") -> Variables:
    """RAOs as Capytaine's export_dataset writes them: scalars, waves by all their measures along one of them, other
    matrices; in version 3 the body's centre of rotation, too.
    """
    k, shape = OMEGA**2 / G, (OMEGA.size, 6, 6)
    measures = {"omega": OMEGA, "freq": OMEGA / (2.0 * math.pi), "period": 2.0 * math.pi / OMEGA,
                "wavenumber": k, "wavelength": 2.0 * math.pi / k}  # fmt: skip
    values = following().transpose(1, 0, 2)
    scalars = {"g": G, "rho": 1000.0, "water_depth": np.inf, "forward_speed": 0.0}
    of_3 = {"space_coordinate": (("space_coordinate",), np.array(["x", "y", "z"])),
            "rotation_center": (("space_coordinate",), np.array([0.0, 0.0, -2.0]))}  # fmt: skip
    return {
        **{name: ((along,), each) for name, each in measures.items()},
        **{name: ((), np.array(each)) for name, each in scalars.items()},
        **(of_3 if version == 3 else {}), "body" if version == 3 else "body_name": ((), np.array("barge")),
        "wave_direction": (("wave_direction",), BETA), "complex": (("complex",), np.array(["re", "im"])),
        **{dof: ((dof,), DOFS) for dof in ("influenced_dof", "radiating_dof")},
        "added_mass": ((along, "influenced_dof", "radiating_dof"), np.ones(shape)),
        "RAO": (("complex", along, "wave_direction", "radiating_dof"), np.stack([values.real, values.imag])),
    }  # fmt: skip


@pytest.mark.parametrize("along", ["omega", "freq", "period", "wavenumber", "wavelength"])
@pytest.mark.parametrize("version", [2, 3])
def test_files_of_capytaine(version: int, along: str, tmp_path: Path) -> None:
    first, second = written(tmp_path, variables(following())), written(tmp_path, by_capytaine(version, along))
    assert second.frequency == pytest.approx(first.frequency)
    for mode, table in first.response.items():
        assert np.array(second.response[mode]) == pytest.approx(np.array(table), abs=1e-15)


def test_names_by_their_letters(tmp_path: Path) -> None:
    """Names as rows of letters, as netCDF's classic model has them."""
    letters = np.array([name.ljust(5) for name in DOFS], dtype="S5").view("S1").reshape(6, 5)
    rao = written(tmp_path, changed(radiating_dof=(("radiating_dof", "string5"), letters)))
    assert [*rao.response] == [name.lower() for name in DOFS]


def test_a_body_that_turns_about_another_place_than_its_phases_count_from_is_refused(tmp_path: Path) -> None:
    centre = {"rotation_center": (("space_coordinate",), np.array([3.0, 0.0, -2.0]))}
    with pytest.raises(PydanticCustomError, match=r"turns about x, y = 3, 0 m, .* count from 0, 0"):
        written(tmp_path, {**by_capytaine(3), **centre})


@pytest.mark.parametrize(
    ("other", "message"),
    [
        ({"RAO": None}, "has no variable RAO"),
        ({"radiating_dof": (("radiating_dof",), np.array([*DOFS[:5], "Bending"]))}, "Bending is no motion of a rigid"),
        ({"radiating_dof": (("radiating_dof",), np.array([*DOFS[:5], "other__Heave"]))}, "has several bodies"),
        ({"omega": (("omega",), np.array([0.0, 0.5, 1.0, 3.0]))}, "a frequency of 0"),
        ({"omega": (("omega",), np.array([0.1, 0.1, 1.0, 3.0]))}, "a frequency is given twice"),
        ({"wave_direction": (("wave_direction",), BETA * 2.0)}, "a wave_direction is given twice"),
        ({"omega": None}, "a dimension omega without values"),
        ({"complex": None, "RAO": (("omega", "wave_direction", "radiating_dof"), np.ones((4, 8, 6)))}, "RAO is real"),
    ],
)
def test_files_without_raos(other: dict[str, Any], message: str, tmp_path: Path) -> None:
    write_netcdf(tmp_path / "rao.nc", changed(**other))
    stage = dynamic(20.0, 0.2, "sail", motion={"end": {"vessel": {"rao": "rao.nc", "reference": VESSEL_END}}})
    with pytest.raises(SceneError, match=message) as error:
        scene_from_mapping(below_vessel(stage, waves=AIRY), tmp_path)
    assert "\n" not in str(error.value)
