"""Ends on vessels: closed forms of their response to waves, and the scenes and tables that are refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import Assembly, build
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.errors import SceneError
from riser_soil.motion.vessel import RaoTable
from riser_soil.riser import rotations
from riser_soil.riser.line_ends import SupportRotation
from riser_soil.riser.spatial_directors import SpatialFrames
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.said import lines_with, telling
from tests.support.scenes import AIRY, JONSWAP, VESSEL_END, Mapping, below_vessel, dynamic, static
from tests.support.seas import EVERYWHERE, MODES, REFERENCE, components_of, surface, table
from tests.support.stage_histories import distance, stage_histories


def aboard(duration: float = 20.0, name: str = "sail", **vessel: Any) -> Mapping:
    vessel = {"rao": "rao.csv", "reference": REFERENCE} | vessel
    return dynamic(duration, 0.2, name, motion={"end": {"vessel": vessel}})


def scene(folder: Path, text: str, *stages: Mapping, **more: Any) -> Scene:
    (folder / "rao.csv").write_text(text, encoding="utf-8")
    return scene_from_mapping(below_vessel(*(stages or (aboard(),)), **more), folder)


def begun(scene: Scene, stage: int = 0) -> Assembly:
    assembly = build(scene, MPI.COMM_SELF)
    assembly.begin(scene.stages[stage])
    return assembly


def displaced(assembly: Assembly, t: float) -> Array:
    assert assembly.riser.line.end.motion is not None
    return assembly.riser.line.end.motion(t)[0] - VESSEL_END


def turned(assembly: Assembly, t: float) -> SupportRotation:
    assert assembly.riser.line.end.turning is not None
    return assembly.riser.line.end.turning(t)


@pytest.mark.parametrize(("surge", "count"), [(6.0, 0), (14.0, 1)])
def test_a_vessel_that_drives_too_far_is_reported(surge: float, count: int, tmp_path: Path) -> None:
    """The ends are 40 m and 33 m apart at rest, the waves 1.5 m high: a surge of 6.7 m/m uses up the 60 m."""
    text = table(*EVERYWHERE, surge=(surge, 0.0))
    assembly = begun(scene(tmp_path, text, aboard(duration=40.0)))
    warnings = [warning for warning in physical_warnings(assembly) if "m apart" in warning]
    assert len(warnings) == count
    for warning in warnings:
        assert warning.startswith("stages.0.motion: ")
        farthest = float(np.hypot(40.0 + 1.5 * surge, 33.0))
        assert float(warning.split(" m apart")[0].split()[-1]) == pytest.approx(farthest, abs=0.1)


@pytest.mark.parametrize("waves", [AIRY, JONSWAP])
def test_a_buoy_follows_the_surface_at_its_reference(waves: Mapping, tmp_path: Path) -> None:
    """The buoy follows from the first moment on, as it grows with the waves unless told otherwise."""
    floating = scene(tmp_path, table(*EVERYWHERE, heave=(1.0, 0.0)), waves=waves)
    assembly = begun(floating)
    for t in (0.3, 4.0, 9.1, 17.3):
        assert displaced(assembly, t) == pytest.approx([0.0, 0.0, surface(floating, t)], abs=1e-12)
    assert abs(surface(floating, 17.3)) > 0.1


def test_a_phase_is_a_lag(tmp_path: Path) -> None:
    """A heave that lags by 90 degrees is where the surface was a quarter of a period before."""
    late = begun(floating := scene(tmp_path, table(*EVERYWHERE, heave=(0.5, 90.0))))
    assert displaced(late, 17.3)[2] == pytest.approx(0.5 * surface(floating, 17.3 - 9.0 / 4.0))


@pytest.mark.parametrize(
    ("mode", "axis", "sign"),
    [("roll", 0, 1.0), ("pitch", 1, 1.0), ("yaw", 2, 1.0), ("surge", 0, 0.0), ("sway", 1, 0.0)],
)
def test_modes_move_along_and_about_the_vessels_axes(mode: str, axis: int, sign: float, tmp_path: Path) -> None:
    """x along the heading, y to port, z up; the end moves with its arm, its direction turns along."""
    text = table(*EVERYWHERE, **{mode: (0.02, 0.0)})
    assembly = begun(floating := scene(tmp_path, text, aboard(heading_deg=30.0), rotation="fixed"))
    heading = np.array(rotations.exp((0.0, 0.0, np.radians(30.0))))
    t, along = 17.3, heading[:, axis] * 0.02
    size = surface(floating, t)
    expected = np.cross(along, np.array(VESSEL_END) - REFERENCE) if sign else along
    assert displaced(assembly, t) == pytest.approx(size * expected, abs=1e-13)
    assert turned(assembly, t).rotation == pytest.approx(sign * size * along, abs=1e-14)
    state = State.at_rest(t, assembly.riser.line.size)
    assembly.riser.line.prescribe(t, state.u, state.v, state.a)
    assert isinstance(assembly.riser.line.frames, SpatialFrames)
    spin = assembly.riser.line.frames.R[-1] @ assembly.riser.line.nodal(state.u)[-1, 3:]
    assert spin == pytest.approx(sign * size * along, abs=1e-13)


def test_response_to_a_sea_is_the_rao_times_its_components(tmp_path: Path) -> None:
    """The response's energy by components is that of the waves times |RAO|^2, linear between the table's rows."""

    def rao(w: float, direction: float) -> tuple[float, float]:
        return 2.0 / (1.0 + w**2), 40.0 * w

    w = np.linspace(0.3, 4.0, 100)
    floating = scene(tmp_path, table(w, [180.0], surge=rao), waves=JONSWAP)
    vessels, waves = begun(floating).riser.vessels, components_of(floating)
    assert vessels is not None
    assert waves is not None
    response = vessels.motion(floating.stages[0], "end", np.array(VESSEL_END)).response
    energy = np.abs(response.amplitude[:, 0]) ** 2
    assert energy == pytest.approx((2.0 / (1.0 + waves.frequency**2)) ** 2 * waves.amplitude**2, rel=2e-3)
    lag = waves.wave_number * -REFERENCE[0] + waves.phase + np.radians(40.0 * waves.frequency)
    assert np.exp(-1j * lag) == pytest.approx(response.amplitude[:, 0] / np.sqrt(energy), abs=1e-3)
    assert not np.any(response.amplitude[:, 1:])


def test_rates_are_derivatives_and_it_starts_at_rest(tmp_path: Path) -> None:
    modes = {mode: (0.3 if n < 3 else 0.02, 50.0 * n) for n, mode in enumerate(MODES)}
    assembly = begun(scene(tmp_path, table(*EVERYWHERE, **modes), waves=JONSWAP, rotation="fixed"))
    motion, turning, h = assembly.riser.line.end.motion, assembly.riser.line.end.turning, 1e-3
    assert motion is not None
    assert turning is not None
    for values, first in zip(motion(0.0), (VESSEL_END, [0.0] * 3, [0.0] * 3), strict=True):
        assert values == pytest.approx(first, abs=1e-12)
    for t in (0.5, 5.0, 8.99, 9.01, 31.0):
        for k in (0, 1):
            slope = (motion(t + h)[k] - motion(t - h)[k]) / (2.0 * h)
            assert slope == pytest.approx(motion(t)[k + 1], abs=2e-6)
        slope = (turning(t + h).angular_velocity - turning(t - h).angular_velocity) / (2.0 * h)
        assert slope == pytest.approx(turning(t).angular_acceleration, abs=2e-7)
        frames = [np.array(rotations.exp(tuple(turning(s).rotation))) for s in (t - h, t, t + h)]
        spin = (frames[2] - frames[0]) / (2.0 * h) @ frames[1].T
        assert spin == pytest.approx(np.cross(np.eye(3), turning(t).angular_velocity), abs=2e-7)


def test_a_vessel_sails_on_through_stages(tmp_path: Path) -> None:
    """Two stages are one, in positions, rates and directions of the end."""
    modes = {mode: (0.3 if n < 3 else 0.02, 50.0 * n) for n, mode in enumerate(MODES)}
    more: Mapping = {"waves": JONSWAP, "rotation": {"stiffness": 1e5}, "solver": {"newton": "snes"}}  # compiles sooner
    text = table(*EVERYWHERE, **modes)
    long = stage_histories(scene(tmp_path, text, static(), aboard(8.0), **more))[-1]
    _, first, second = stage_histories(scene(tmp_path, text, static(), aboard(5.0), aboard(3.0, "sail on"), **more))
    whole = np.array(long.position)
    assert distance(np.array([*first.position, *second.position])[:, -1], whole[:, -1]) < 1e-10
    assert distance(second.position[-1], whole[-1]) < 2e-3 * np.abs(whole[-1] - whole[0]).max()
    assert second.end.end_moment == pytest.approx(long.end.end_moment, rel=2e-2, abs=1.0)


def ends(floating: Scene) -> tuple[Assembly, list[tuple[Array, Array]]]:
    """Where each stage's motion puts the end as it begins and as it ends."""
    assembly, positions = build(floating, MPI.COMM_SELF), []
    line, state = assembly.riser.line, State.at_rest(0.0, assembly.riser.line.size)
    for stage in floating.stages:
        assembly.begin(stage)
        times = (0.0, 1.0 if stage.kind == "static" else stage.duration)
        motion, here = line.end.motion, line.to_global(line.x[-1])
        positions.append((motion(times[0])[0], motion(times[1])[0]) if motion else (here, here))
        line.prescribe(times[1], state.u, state.v, state.a)
        line.commit(state)
        state = State.at_rest(0.0, line.size)
    return assembly, positions


BREAKS: dict[str, tuple[Mapping, dict[str, Any]]] = {
    "static": (static("rest"), {}),
    "without motion": (dynamic(7.0, 0.2, "rest"), {}),
    "another heading": (aboard(7.0, "rest", heading_deg=20.0), {}),
    "none, but another reference": (aboard(7.0, "rest"), {"reference": [50.0, 1.0, 2.0]}),
}


@pytest.mark.parametrize("name", BREAKS)
def test_after_a_break_it_swings_about_the_same_mean(name: str, tmp_path: Path) -> None:
    """The end comes back from where it rested, without a jump and from rest."""
    modes = {mode: (0.3 if n < 3 else 0.02, 50.0 * n) for n, mode in enumerate(MODES)}
    between, change = BREAKS[name]
    stages = static(), aboard(12.6), between, aboard(30.0, "again", **change, ramp=2.0)
    assembly, positions = ends(scene(tmp_path, table(*EVERYWHERE, **modes), *stages))
    motion, turning = assembly.riser.line.end.motion, assembly.riser.line.end.turning
    assert motion is not None
    assert turning is not None
    assert np.abs(positions[2][1] - VESSEL_END).max() > 0.1
    assert motion(0.0)[0] == pytest.approx(positions[2][1], abs=1e-12)
    for values in (*motion(0.0)[1:], *turning(0.0)):
        assert values == pytest.approx(np.zeros(3), abs=1e-12)
    period = map(float, np.arange(9.0, 18.0, 0.25))
    assert np.mean([motion(t)[0] for t in period], axis=0) == pytest.approx(VESSEL_END, abs=1e-9)
    if "reference" not in change:
        late = displaced(assembly, 12.0)
        whole = begun(scene(tmp_path, table(*EVERYWHERE, **modes), static(), aboard(60.0)), 1)
        clock = 12.6 + (7.0 if between["kind"] == "dynamic" else 0.0)
        assert late == pytest.approx(displaced(whole, clock + 12.0), abs=1e-12)


def test_a_return_goes_on_in_the_next_stage(tmp_path: Path) -> None:
    text = table(*EVERYWHERE, surge=(1.0, 0.0), pitch=(0.02, 30.0))
    first = static(), aboard(12.6), static("rest")
    long, _ = ends(scene(tmp_path, text, *first, aboard(20.0, "again")))
    short, positions = ends(scene(tmp_path, text, *first, aboard(4.0, "again"), aboard(16.0, "and on")))
    assert positions[3][1] == pytest.approx(positions[4][0], abs=1e-12)
    for t in (4.0, 6.0, 8.0, 19.0):
        assert displaced(short, t - 4.0) == pytest.approx(displaced(long, t), abs=1e-12)


def test_a_move_in_a_static_stage_takes_the_berth_along(tmp_path: Path) -> None:
    text, by = table(*EVERYWHERE, surge=(1.0, 0.0)), np.array([-2.0, 0.5, 1.0])
    _, positions = ends(scene(tmp_path, text, static(), aboard(12.6), static("rest"), aboard(30.0, "again")))
    target = [float(value) for value in positions[1][1] + by]
    moved = static(), aboard(12.6), static("rest", move={"end": target}), aboard(30.0, "again")
    assembly, positions = ends(scene(tmp_path, text, *moved))
    assert displaced(assembly, 0.0) == pytest.approx(np.array(target) - VESSEL_END, abs=1e-12)
    mean = np.mean([displaced(assembly, t) for t in map(float, np.arange(9.0, 18.0, 0.25))], axis=0)
    assert mean == pytest.approx(by, abs=1e-9)


def test_interpolation_is_linear_and_periodic_in_direction() -> None:
    response: Array = np.arange(6.0).reshape(3, 2, 1).astype(complex)
    grid = RaoTable(np.array([1.0, 2.0]), np.radians([0.0, 90.0, 300.0]), response)
    w = np.array([1.5, 1.0, 1.0, 1.0, 3.0, 0.5, 1.25, 1.0])
    direction = np.radians([0.0, 30.0, 330.0, -30.0, 300.0, 90.0, 195.0, 360.0])
    expected = [0.5, 2.0 / 3.0, 2.0, 2.0, 5.0, 2.0, 3.25, 0.0]
    assert grid.at(w, direction)[:, 0] == pytest.approx(np.array(expected, dtype=complex))
    below, above = grid.beyond(w)
    assert np.flatnonzero(below).tolist() == [5]
    assert np.flatnonzero(above).tolist() == [4]


def test_periods_degrees_and_a_full_circle(tmp_path: Path) -> None:
    """Directions of 0 and 360 degrees are one."""
    head = "period [s]; direction [deg]; pitch [deg/m]; pitch phase [rad]\n"
    rows = "".join(f"{T}; {direction}; 2.0; 0.3\n" for T in (5.0, 9.0, 20.0) for direction in range(0, 361, 45))
    known = begun(scene(tmp_path, head + rows, rotation="fixed"))
    other = begun(scene(tmp_path, table(*EVERYWHERE, pitch=(np.radians(2.0), np.degrees(0.3))), rotation="fixed"))
    assert displaced(known, 17.3) == pytest.approx(displaced(other, 17.3), rel=1e-9)


@pytest.mark.parametrize(("decay", "warnings"), [(8.0, 1), (20.0, 0)])
def test_waves_beyond_the_table(decay: float, warnings: int, tmp_path: Path) -> None:
    """Short waves that by the table's last row matter little don't move the vessel; they are told, once, unless they
    matter nothing at all.
    """

    def rao(w: float, direction: float) -> tuple[float, float]:
        return np.exp(-decay * max(0.0, w - 0.8)), 0.0

    text = table(np.linspace(0.3, 1.1, 27), [180.0], heave=rao)
    floating = scene(tmp_path, text, aboard(), aboard(name="sail on"), waves=JONSWAP)
    assembly = begun(floating)
    assert assembly.riser.vessels is not None
    response = assembly.riser.vessels.motion(floating.stages[0], "end", np.array(VESSEL_END)).response
    above = response.frequency > 1.1
    assert np.count_nonzero(above) == 5  # of 40 waves of equal energy
    assert not np.any(response.amplitude[above])
    assert np.all(response.amplitude[~above, 2])
    messages = [warning for warning in physical_warnings(assembly) if "vessel" in warning]
    assert len(messages) == warnings
    path, energy = "stages.0.motion.end.vessel.rao:", "waves' energy"
    assert lines_with(messages, path, "0 %", energy, "12.5 % above", "1.1 rad/s") == messages


def test_a_table_that_misses_waves_that_matter_is_refused(tmp_path: Path) -> None:
    floating = scene(tmp_path, table(np.linspace(0.3, 1.1, 27), [180.0], surge=(1.0, 0.0)), waves=JONSWAP)
    says = r"^stages\.0\.motion\.end\.vessel\.rao: .*covers 0\.3 to 1\.1 rad/s.* 12\.5 % of the energy of surge; add"
    with pytest.raises(SceneError, match=says):
        build(floating, MPI.COMM_SELF)
    with pytest.raises(SceneError, match=telling("100 %", "energy of heave")):
        build(scene(tmp_path, table([0.2, 0.5], range(0, 360, 45), heave=(1.0, 0.0))), MPI.COMM_SELF)


@pytest.mark.parametrize(
    ("modes", "vessel", "dimension"),
    [
        ({"heave": (1.0, 0.0), "surge": (0.5, 90.0), "pitch": (0.01, 0.0)}, {}, 2),
        ({"heave": (1.0, 0.0), "surge": (0.5, 90.0)}, {"heading_deg": 180.0}, 2),
        ({"heave": (1.0, 0.0), "sway": (0.5, 90.0), "roll": (0.01, 0.0)}, {"heading_deg": 90.0}, 2),
        ({"sway": (0.5, 90.0)}, {}, 3),
        ({"roll": (0.5, 90.0)}, {}, 3),
        ({"yaw": (0.5, 90.0)}, {}, 3),
        ({"sway": (0.0, 90.0), "heave": (1.0, 0.0)}, {}, 2),
        ({"heave": (1.0, 0.0)}, {"heading_deg": 30.0}, 2),
        ({"surge": (1.0, 0.0)}, {"heading_deg": 30.0}, 3),
        ({"sway": lambda w, direction: (abs(np.sin(np.radians(direction))) > 1e-9, 0.0), "surge": (1.0, 0.0)}, {}, 2),
    ],
)
def test_only_modes_that_leave_the_plane_make_three_dimensions(
    modes: Mapping, vessel: Mapping, dimension: int, tmp_path: Path
) -> None:
    """In waves along the riser's plane; sway in waves from the side is none in waves from ahead."""
    w, directions = EVERYWHERE
    floating = scene(tmp_path, table(w, [*directions, 150.0], **modes), aboard(**vessel), waves=JONSWAP)
    assert resolved_dimension(floating) == dimension


def test_echo_finds_the_table_from_elsewhere(tmp_path: Path) -> None:
    floating = scene(tmp_path, table(*EVERYWHERE, heave=(1.0, 0.0)))
    (tmp_path / "results").mkdir()
    echo = tmp_path / "results/scene.yaml"
    echo.write_text(dump_scene(floating), encoding="utf-8")
    assert read_scene(echo) == floating


HEAD = "frequency [rad/s], direction [deg], heave [m/m], heave phase [deg]\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "rao.csv: the file is empty"),
        ("frequency [rad/s], heave [m/m], heave phase [deg]\n", "rao.csv:1: there is no column direction"),
        ("frequency [rad/s], direction [deg]\n1, 0\n", "rao.csv:1: no column is a response; give surge [m/m]"),
        ("direction [deg], heave [m/m], heave phase [deg]\n", "rao.csv:1: waves have a frequency or a"),
        ("period [s], " + HEAD + "1, 2, 0, 1, 0\n", "rao.csv:1: waves have a frequency or a period"),
        ("frequency [rad/s], direction [deg], heave [m/m]\n1, 0, 1\n", "there is no column heave phase [deg]"),
        (HEAD.replace("m/m", "deg/m"), "rao.csv:1: heave can't be in [deg/m], accepted are m/m"),
        (HEAD.replace("rad/s", "1/s"), "rao.csv:1: frequency can't be in [1/s], accepted are rad/s, Hz"),
        (HEAD, "rao.csv:1: the table has no rows"),
        (HEAD + "0, 0, 1, 0\n", "rao.csv:2: frequency must be greater than 0"),
        (HEAD + "1, 0, 1, 0\n2, 0, -1, 0\n", "rao.csv:3: heave must not be negative; write its size and add 180 deg"),
        (HEAD + "1_0, 0, 1, 0\n", 'rao.csv:2: frequency: "1_0" is not a finite number'),
        (HEAD + "1, 0, 1, x\n", 'rao.csv:2: heave phase: "x" is not a finite number'),
        (HEAD + "1, 0, 1, 0\n1, 360, 2, 0\n", "rao.csv:3: the wave of 1 rad/s (6.28319 s) and 0 deg was given"),
        (HEAD + "1, 0, 1, 0\n2, 45, 2, 0\n", "rao.csv: there is no row for the wave of 2 rad/s (3.14159 s) and 0 deg"),
        (table([0.5, 1.0], [0, 90], heave=(1.0, 0.0)), "run at 35 deg to the heading, but the table"),
        (table([0.5, 1.0], [0], heave=(1.0, 0.0)), "nearest directions are 0 and 0 deg; add rows"),
    ],
)
def test_refused_tables(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        scene(tmp_path, text)
    assert len(str(caught.value).splitlines()) == 1
    assert str(caught.value).startswith("scene: stages.0.motion.end.vessel")
    assert says in str(caught.value)
    assert "; " in str(caught.value)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"waves": None}, "stages.0.motion.end.vessel: value"),
        ({"waves": AIRY | {"ramp": 0.0}}, "stages.0.motion.end.vessel.ramp: missing: without a ramp"),
    ],
)
def test_refused_scenes(change: Mapping, says: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        scene(tmp_path, table(*EVERYWHERE, heave=(1.0, 0.0)), **change)
    assert len(str(caught.value).splitlines()) == 1
    assert says in str(caught.value)


def test_the_command_names_the_file_and_line_of_a_table_that_is_too_short(tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from riser_soil.__main__ import app

    floating = scene(tmp_path, table([0.2, 0.5], range(0, 360, 45), heave=(1.0, 0.0)))
    file = tmp_path / "scene.yaml"
    file.write_text(dump_scene(floating), encoding="utf-8")
    result = CliRunner().invoke(app, ["check", str(file)])
    assert result.exit_code == 2
    line = next(n for n, row in enumerate(file.read_text().splitlines(), start=1) if "rao:" in row)
    assert result.stderr.startswith(f"{file}:{line}: stages.0.motion.end.vessel.rao: ")
