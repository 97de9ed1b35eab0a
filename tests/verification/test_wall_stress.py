"""Wall stress of pipes as the program solves them, against forms in closed form; utilisations with their warnings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from riser_soil.core.snapshot import Record
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from tests.support.runs import run_of
from tests.support.said import line_with, lines_with
from tests.support.scenes import Mapping, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

G, RHO, OIL, P, L = 9.81, 1025.0, 850.0, 20.0e6, 40.0
OUTER, INNER, COATED, MASS = 0.2731, 0.2319, 0.35, 160.0
A = 0.25 * np.pi * (OUTER**2 - INNER**2)
I = np.pi / 64.0 * (OUTER**4 - INNER**4)
STEEL: Mapping = {"EA": 3.0e9, "EI": 2.5e7, "GJ": 2.0e7, "mass": MASS}
STEEL |= {"outer_diameter": COATED, "inner_diameter": INNER, "wall": {"outer_diameter": OUTER}}


def hanging(pipe: Mapping = STEEL, **more: Any) -> Mapping:
    """A coated steel pipe, full of oil under pressure, that hangs closed from 10 m below the surface."""
    riser: Mapping = {"unstressed": {"points": [[0.0, 0.0, -10.0], [0.0, 0.0, -10.0 - L]]}}
    riser |= {"contents": {"density": OIL, "pressure": P}}
    return riser_scene(
        static(),
        riser=riser,
        pipe=pipe,
        length=L,
        elements=8,
        start=prescribed(0.0, 0.0, -10.0),
        end="free",
        gravity=G,
        water={"density": RHO, "surface_level": 0.0},
        **more,
    )


def bent(moment: list[float], dimension: int = 3, force: float = 1.0e5) -> Mapping:
    """A clamped pipe along x, so stiff that it stays where it is, under a moment and a pull at its end."""
    loads: Mapping = {"loads": [{"at": "end", "moment": moment, "force": [force, 0.0, 0.0]}]}
    stiff: Mapping = STEEL | {"EA": 1.0e16, "EI": 1.0e14, "GJ": 1.0e14, "wall": {"outer_diameter": OUTER}}
    clamped = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    sizes: dict[str, Any] = {"length": 10.0, "elements": 4, "dimension": dimension}
    return riser_scene(static(**loads), pipe=stiff, start=clamped, end="free", riser={"initial": "unstressed"}, **sizes)


def settled(scene: Mapping) -> Record:
    (stage,) = stage_histories(scene)
    return stage.end


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_full_pipe_that_hangs_in_water(dimension: int) -> None:
    """Weight below, end caps, Lame's stresses; the coat is buoyant, and bears the water's pressure on its own area."""
    riser = wall = settled(hanging(dimension=dimension))
    z = riser.position[:, 2]
    inside, outside = P + OIL * G * (-10.0 - z), -RHO * G * z
    assert wall.internal_pressure == pytest.approx(inside, rel=1e-12)
    assert wall.external_pressure == pytest.approx(outside, rel=1e-12)
    below = L - np.linspace(0.0, L, 9)
    A_i, A_o, A_coated = (0.25 * np.pi * d**2 for d in (INNER, OUTER, COATED))
    axial = ((MASS + OIL * A_i - RHO * A_coated) * G * below + inside * A_i - outside * A_o) / A
    assert wall.wall_axial_stress == pytest.approx(axial, rel=1e-6)
    assert riser.wall_tension / A == pytest.approx(wall.wall_axial_stress, rel=1e-12)
    hoop = (inside * (OUTER**2 + INNER**2) - 2.0 * outside * OUTER**2) / (OUTER**2 - INNER**2)
    assert wall.wall_hoop_stress == pytest.approx(hoop, rel=1e-6)
    von_mises = np.sqrt(0.5 * ((axial - hoop) ** 2 + (hoop + inside) ** 2 + (inside + axial) ** 2))
    assert wall.wall_von_mises_stress == pytest.approx(von_mises, rel=1e-6)
    assert np.abs(wall.wall_bending_stress).max() < 1e-6 * axial.max()


def test_bending_about_both_axes_with_torsion() -> None:
    """Exerted by what is beyond: about y it pulls the upper side, about z the right one; torsion shears."""
    Mx, My, Mz = 2.0e4, 4.0e4, -3.0e4
    wall = settled(bent([Mx, My, Mz]))
    for computed, given in ((wall.torque, Mx), (wall.bending_moment_y, My), (wall.bending_moment_z, Mz)):
        assert computed == pytest.approx(np.full(5, given), rel=1e-6)
    bending, axial, shear = 5.0e4 * 0.5 * OUTER / I, 1.0e5 / A, Mx * 0.5 * OUTER / (2.0 * I)
    assert wall.wall_bending_stress == pytest.approx(np.full(5, bending), rel=1e-6)
    assert wall.wall_axial_stress == pytest.approx(np.full(5, axial), rel=1e-6)
    von_mises = np.hypot(axial + bending, np.sqrt(3.0) * shear)
    assert wall.wall_von_mises_stress == pytest.approx(np.full(5, von_mises), rel=1e-6)
    assert np.abs(wall.wall_hoop_stress).max() == 0.0


def test_in_a_plane_the_moment_has_its_sign() -> None:
    for sign in (1.0, -1.0):
        flat, space = (settled(bent([0.0, sign * 4.0e4, 0.0], dimension)) for dimension in (2, 3))
        assert flat.bending_moment_y == pytest.approx(np.full(5, sign * 4.0e4), rel=1e-6)
        assert flat.bending_moment_y == pytest.approx(space.bending_moment_y, rel=1e-6)
        assert not flat.bending_moment_z.any()
        assert not flat.torque.any()


def test_components_make_up_the_moment_of_a_riser_in_current(tmp_path: Path) -> None:
    """A riser that sags and is swept sideways: both components, and what the files and the screen tell."""
    scene = hanging(STEEL | {"EI": 2.0e5, "GJ": 2.0e5, "drag": {"normal": 1.2}})
    scene["water"]["current"] = {"profile": [[-60.0, 0.4, 0.8], [0.0, 1.0, 1.8]]}
    del scene["riser"]["unstressed"]
    scene["riser"]["end"] = prescribed(25.0, 0.0, -20.0)
    done = run_of(scene, tmp_path)
    My, Mz, M = (done[f"bending_moment{name}"][-1] for name in ("_y", "_z", ""))
    assert min(np.abs(My).max(), np.abs(Mz).max()) > 0.1 * M.max()
    assert np.hypot(My, Mz) == pytest.approx(M, abs=1e-6 * M.max())
    assert done["wall_bending_stress"][-1] == pytest.approx(np.hypot(My, Mz) * 0.5 * OUTER / I, rel=1e-9)


def test_utilisations_and_their_warnings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Upper half of a steel that is stressed too much, lower half without wall that may be pulled by less."""
    weak = STEEL | {"wall": {"outer_diameter": OUTER, "yield_stress": 200.0e6, "design_factor": 0.5}}
    scene = hanging(weak | {"max_tension": 1.0e6})
    flexible = {key: value for key, value in STEEL.items() if key != "wall"} | {"max_tension": 1.0e3}
    scene["line_types"]["flexible"] = flexible
    half = {"length": 0.5 * L, "elements": 4}
    scene["riser"]["segments"] = [{"line_type": "pipe"} | half, {"line_type": "flexible"} | half]
    done = run_of(scene, tmp_path)
    (stage,) = done.summary["stages"]
    stress, used = done["wall_von_mises_stress"][-1], done["stress_utilisation"][-1]
    assert np.isnan(stress).tolist() == [False] * 5 + [True] * 4
    assert used[:5] == pytest.approx(stress[:5] / 100.0e6, rel=1e-12)
    top = int(np.nanargmax(stress))
    assert stage["final"]["max_wall_von_mises_stress"] == {"value": stress[top], "arc": done.arc[top]}
    assert stage["final"]["max_stress_utilisation"] == {"value": used[top], "arc": done.arc[top]}
    pulled, tension = done["tension_utilisation"][-1], done["effective_tension"][-1]
    assert pulled == pytest.approx(tension / np.r_[np.full(4, 1.0e6), np.full(5, 1.0e3)], rel=1e-12)
    assert stage["final"]["max_tension_utilisation"] == {"value": pulled[4], "arc": 20.0}
    by_tension, by_stress = stage["warnings"]
    line_with([by_tension], "max_tension", f"{pulled[4]:.4g} times", "arc 20 m", f"tension is {tension[4]:.4g} N")
    line_with([by_stress], "design_factor", "yield_stress", f"{used[top]:.4g} times", f"arc {done.arc[top]:.5g} m")
    line_with([by_stress], "1 of the load", f"von Mises' stress is {stress[top]:.4g} Pa")
    screen = capsys.readouterr().out
    assert lines_with(screen, "von Mises stress of the wall")
    assert lines_with(screen, "stress utilisation")


def test_the_stress_that_is_warned_of_is_that_of_the_weaker_steel(tmp_path: Path) -> None:
    """Where a thin strong wall meets a thick weak one, stressed less but used more."""
    scene = hanging()
    weak, strong = ({"outer_diameter": D, "yield_stress": y} for D, y in ((OUTER, 5.0e7), (0.26, 1.0e9)))
    scene["line_types"] = {"strong": STEEL | {"wall": strong}, "weak": STEEL | {"wall": weak}}
    half = {"length": 0.5 * L, "elements": 4}
    scene["riser"]["segments"] = [{"line_type": name} | half for name in ("strong", "weak")]
    done = run_of(scene, tmp_path)
    used, stress = done["stress_utilisation"][-1], done["wall_von_mises_stress"][-1]
    assert int(np.argmax(used)) == 4
    assert stress[4] > 1.1 * used[4] * 5.0e7
    (warning,) = done.summary["stages"][0]["warnings"]
    line_with([warning], "arc 20 m", "1 of the load", f"von Mises' stress is {used[4] * 5.0e7:.4g} Pa")


def test_without_a_wall_nothing_of_it_is_recorded(tmp_path: Path) -> None:
    plain = {key: value for key, value in STEEL.items() if key != "wall"}
    done = run_of(hanging(plain), tmp_path)
    with h5py.File(done.folder / "results.nc") as file:
        assert not {"wall_von_mises_stress", "bending_moment_y", "internal_pressure", "tension_utilisation"} & {*file}


def test_in_a_plane_torque_is_not_recorded(tmp_path: Path) -> None:
    done = run_of(hanging(dimension=2), tmp_path)
    with h5py.File(done.folder / "results.nc") as file:
        assert "bending_moment_y" in file
        assert not {"bending_moment_z", "torque", "stress_utilisation"} & {*file}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wall": {"inner_diameter": 0.4}}, r"line_types.pipe.wall: .*must lie between two diameters.*0\.35 m.*0\.4 m"),
        ({"inner_diameter": 0.0}, "line_types.pipe.wall: .*needs an inner diameter"),
        ({"wall": {"design_factor": 0.67}}, "line_types.pipe.wall: .*has a design_factor without a yield_stress"),
        ({"wall": {"yield": 4.0e8}}, r"wall.yield: .*yield_stress"),
        ({"max_tension": 0.0}, "line_types.pipe.max_tension: .*greater than 0"),
    ],
)
def test_what_is_refused(change: Mapping, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(hanging(STEEL | change))


def test_the_pressure_outside_must_be_known() -> None:
    scene = hanging()
    del scene["water"]["surface_level"]
    with pytest.raises(SceneError, match=r"line_types.pipe.wall: .*water.surface_level"):
        scene_from_mapping(scene)


def test_in_air_without_contents_the_effective_tension_is_the_wall_s() -> None:
    scene = hanging()
    del scene["water"], scene["riser"]["contents"]
    riser = wall = settled(scene)
    assert wall.wall_axial_stress == pytest.approx(riser.effective_tension / A, rel=1e-12)
    assert not wall.wall_hoop_stress.any()
