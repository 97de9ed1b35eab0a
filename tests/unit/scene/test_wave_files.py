"""Seas with spectra by direction from netCDF files: moments and directions against closed forms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.wave_kinds import GivenSpectrum
from riser_soil.sea import spectra
from riser_soil.sea.components import Components
from tests.support.netcdf_files import Variables, write_netcdf
from tests.support.said import telling
from tests.support.scenes import ON_SEABED
from tests.support.seas import components_of

FREQ = np.arange(0.04, 0.5, 0.005)
DIR = np.arange(0.0, 360.0, 15.0)
HS, TP, FROM, S = 3.0, 9.0, 247.0, 8.0


def density(turn: float = 0.0) -> Array:
    """JONSWAP's [m2/Hz/deg], its mean direction turning by so many degrees from the lowest frequency to the highest."""
    each = 2.0 * math.pi * spectra.spectrum(2.0 * math.pi * FREQ, HS, TP, 3.3)
    mean = FROM + turn * np.linspace(0.0, 1.0, FREQ.size)
    spread = np.cos(np.radians(DIR[None] - mean[:, None]) / 2.0) ** (2.0 * S)
    values: Array = each[:, None] * spread / (15.0 * spread.sum(axis=1, keepdims=True))
    return values


def variables(efth: Array) -> Variables:
    return {"freq": (("freq",), FREQ), "dir": (("dir",), DIR), "efth": (("freq", "dir"), efth)}


def scene(given: dict[str, Any], folder: Path, **more: Any) -> Scene:
    water = {"surface_level": 100.0, "waves": {"spectrum": {"file": "sea.nc"} | given}}
    return scene_from_mapping(ON_SEABED | {"water": water} | more, folder)


def drawn(given: dict[str, Any], folder: Path) -> Components:
    components = components_of(scene(given, folder))
    assert components is not None
    return components


@pytest.mark.parametrize("turn", [0.0, 90.0])
def test_moments_of_a_sea_are_those_of_its_file(turn: float, tmp_path: Path) -> None:
    """m-1 to m2 of all directions, and m0 of both parts of the direction, of long waves, of short ones and of all."""
    efth = density(turn)
    write_netcdf(tmp_path / "sea.nc", variables(efth))
    waves = drawn({"components": 2000}, tmp_path)
    f, energy = waves.frequency / (2.0 * math.pi), 0.5 * waves.amplitude**2
    fine = np.linspace(FREQ[0], FREQ[-1], 40001)
    toward = np.radians(270.0 - DIR)  # x is east, and waves come from where a compass tells

    def asked(of: Array) -> Array:
        """The file's density on fine steps of frequency, its directions weighed."""
        return np.interp(fine, FREQ, efth @ of * 15.0) * (fine[1] - fine[0])

    for n in (-1, 0, 1, 2):
        assert np.sum(energy * f**n) == pytest.approx(np.sum(asked(np.ones(DIR.size)) * fine**n), rel=1e-3)
    for low, high, most in ((0.0, 1.0, 1e-3), (0.0, 0.12, 2e-3), (0.12, 1.0, 2e-3)):
        band, within = (f >= low) & (f < high), (fine >= low) & (fine < high)
        for part in (np.cos, np.sin):
            moment = np.sum((energy * part(waves.direction))[band])
            assert moment == pytest.approx(np.sum(asked(part(toward))[within]), abs=most * energy.sum())


def test_height_and_peak(tmp_path: Path) -> None:
    write_netcdf(tmp_path / "sea.nc", variables(density()))
    water = scene({}, tmp_path).water
    assert water is not None
    assert water.waves is not None
    ((_, kind),) = water.waves.each
    assert isinstance(kind, GivenSpectrum)
    assert kind.height == pytest.approx(HS, rel=2e-3)  # what lies above 0.5 Hz is not in the file
    assert kind.period == pytest.approx(TP, rel=0.03)
    mean = np.sum(np.exp(1j * np.array(kind.toward)) * np.array(kind.table.parts))
    assert math.degrees(np.angle(mean)) % 360.0 == pytest.approx((270.0 - FROM) % 360.0, abs=0.01)


@pytest.mark.parametrize(
    ("given", "standard_name", "toward"),
    [({}, "sea_surface_wave_from_direction", 200.0), ({}, "sea_surface_wave_to_direction", 20.0),
     ({"north_deg": 0.0}, "", 110.0)],
)  # fmt: skip
def test_directions(given: dict[str, Any], standard_name: str, toward: float, tmp_path: Path) -> None:
    """Waves come from 70 degrees, clockwise from north, which is along y unless the scene says else."""
    efth = np.zeros((FREQ.size, 36))
    efth[:, 7] = density().sum(axis=1)
    directions = {"dir": (("dir",), np.arange(0.0, 360.0, 10.0)), "efth": (("freq", "dir"), efth)}
    write_netcdf(tmp_path / "sea.nc", {**variables(density()), **directions}, {"dir": {"standard_name": standard_name}})
    assert np.unique(np.degrees(drawn(given, tmp_path).direction)) % 360.0 == pytest.approx(toward)


def test_one_sea_of_several_as_packed_numbers(tmp_path: Path) -> None:
    """Numbers are packed as wavespectra writes them, in whole numbers of 1e-5, with other dimensions before."""
    packed = np.round(np.stack([density(), 4.0 * density()])[:, None] * 1e5).astype("i4")
    attributes = {"efth": {"scale_factor": 1e-5, "_FillValue": np.int32(-32768)}}
    several = {**variables(density()), "efth": (("time", "site", "freq", "dir"), packed)}
    write_netcdf(tmp_path / "sea.nc", several, attributes)
    low, high = (np.sum(drawn({"at": {"time": n}}, tmp_path).amplitude ** 2) for n in (0, 1))
    assert high == pytest.approx(4.0 * low, rel=1e-4)
    assert 4.0 * math.sqrt(low / 2.0) == pytest.approx(HS, rel=2e-3)
    with pytest.raises(SceneError, match=telling("2 seas along time", "by at:")):
        scene({}, tmp_path)


def test_radians_and_no_directions(tmp_path: Path) -> None:
    write_netcdf(
        tmp_path / "sea.nc", variables(density() * 180.0 / math.pi), {"efth": {"units": "m2 s rad-1"}}
    )  # fmt: skip
    by_radians = np.sum(drawn({}, tmp_path).amplitude ** 2)
    one = {"freq": (("freq",), FREQ), "efth": (("freq",), density().sum(axis=1) * 15.0)}
    write_netcdf(tmp_path / "sea.nc", one, {"efth": {"units": "m2 s degree-1"}})
    waves = drawn({"direction_deg": 30.0}, tmp_path)
    assert np.sum(waves.amplitude**2) == pytest.approx(by_radians, rel=1e-9)
    assert np.degrees(waves.direction) == pytest.approx(30.0)
    assert resolved_dimension(scene({}, tmp_path)) == 2


def test_a_sea_of_several_directions_is_no_plane_problem(tmp_path: Path) -> None:
    write_netcdf(tmp_path / "sea.nc", variables(density()))
    sea = scene({}, tmp_path)
    assert resolved_dimension(sea) == 3
    with pytest.raises(SceneError, match=r"water\.waves\.spectrum\.file"):
        scene({}, tmp_path, dimension=2)
    (tmp_path / "scene.yaml").write_text(dump_scene(sea))
    assert read_scene(tmp_path / "scene.yaml") == sea


@pytest.mark.parametrize(
    ("changed", "given", "message"),
    [
        ({}, {"at": {"time": 0}}, "efth has no dimension time"),
        ({}, {"direction_deg": 10.0}, "direction_deg: .*the file has directions of its own"),
        ({}, {"spreading": {"s": 5.0}}, "spreading: .*the file has directions of its own"),
        ({"freq": (("freq",), FREQ[::-1])}, {}, "freq must be greater than 0 and increase"),
        ({"efth": (("freq", "dir"), density() * np.nan)}, {}, "negative or missing"),
        ({"efth": (("freq", "dir"), density() * 0.0)}, {}, "all densities are 0"),
        ({"dir": (("dir",), DIR**1.1)}, {}, "directions at even steps"),
        ({"efth": None}, {}, "has no variable efth"),
        ({"efth": (("dir",), DIR)}, {}, "efth has no dimension freq"),
    ],
)  # fmt: skip
def test_files_that_are_no_sea(changed: Any, given: dict[str, Any], message: str, tmp_path: Path) -> None:
    arrays = {name: each for name, each in {**variables(density()), **changed}.items() if each is not None}
    write_netcdf(tmp_path / "sea.nc", arrays)
    with pytest.raises(SceneError, match=message) as error:
        scene(given, tmp_path)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("content", "message"), [(b"CDF\x01" + b"\0" * 40, "netCDF-3"), (b"no numbers", "can't be read")]
)
def test_other_files(content: bytes, message: str, tmp_path: Path) -> None:
    (tmp_path / "sea.nc").write_bytes(content)
    with pytest.raises(SceneError, match=message):
        scene({}, tmp_path)
