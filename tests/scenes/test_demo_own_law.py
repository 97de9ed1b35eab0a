"""The worked law of one's own: modified Cam clay against closed forms, its page, a pipe pressed into it."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from demos.own_law.run import HERE, PAGE, resistance, soil_of, strength
from demos.page import block
from riser_soil import Scene
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.material import memory
from riser_soil.material.path import read_path
from riser_soil.material.point import drive, point_at
from riser_soil.material.study import study
from riser_soil.soil import mandel
from riser_soil.soil.imported_law import ImportedLaw
from riser_soil.soil.law import Formula
from tests.support.material_paths import initial_stress, random_paths
from tests.support.pages import blocks
from tests.support.said import line_with, telling

M, LAM, KAPPA, E0, G_OVER_P = 0.9, 0.2, 0.04, 1.2, 50.0
PRESSURE = np.array([1.5e3, 9.0e3])  # Pa, of two points


def clay(initial: Array, **given: Any) -> Formula:
    numbers = {"M": M, "lam": LAM, "kappa": KAPPA, "e0": E0, "G_over_p": G_OVER_P} | given
    law = {"kind": "imported", "from": f"{HERE / 'my_clay.py'}:CamClay", **numbers}
    return ImportedLaw.model_validate(law).at_points(np.arange(len(initial)) + 0.5, initial)


def isotropic() -> Array:
    return np.asarray(-PRESSURE[:, None] * mandel.UNIT)


def followed(law: Formula, strain: Array, steps: int) -> Array:
    """History (n, nh) after a strain (6,) in equal steps."""
    history = law.start()
    for _ in range(steps):
        history = law.update(np.tile(strain / steps, (len(history), 1)), history).history
    return history


def of(law: Formula, history: Array, name: str) -> Array:
    return np.asarray(history[:, law.columns.index(name)])


def test_virgin_and_swelling_lines_are_straight_over_ln_p() -> None:
    law, lost = clay(isotropic()), 0.03
    pressed = followed(law, -lost / 3.0 * mandel.UNIT, 7)
    np.testing.assert_allclose(of(law, pressed, "pressure"), PRESSURE * math.exp(lost * (1.0 + E0) / LAM), rtol=1e-10)
    back = law.update(np.tile(0.01 / 3.0 * mandel.UNIT, (2, 1)), pressed).history
    ratio = of(law, back, "pressure") / of(law, pressed, "pressure")
    np.testing.assert_allclose(ratio, math.exp(-0.01 * (1.0 + E0) / KAPPA), rtol=1e-10)
    np.testing.assert_allclose(-mandel.mean(back[:, :6]), of(law, back, "pressure"), rtol=1e-12)


@pytest.mark.parametrize("water", [0.0, 2.0e7])
@pytest.mark.parametrize("OCR", [1.0, 1.6, 5.0])
def test_shear_at_constant_volume_ends_at_the_critical_state(OCR: float, water: float) -> None:
    """q = M p at p (OCR/2)^(1 - kappa/lam), pc = 2 p, by steps of any length; all else is the water's pressure."""
    shear = np.array([0.0, 0.0, 0.0, 0.0, 0.25, 0.0])
    law = clay(isotropic(), OCR=OCR, water=water)
    sheared = followed(law, shear, 100)
    p = of(law, sheared, "pressure")
    np.testing.assert_allclose(p, PRESSURE * (0.5 * OCR) ** (1.0 - KAPPA / LAM), rtol=1e-4)
    np.testing.assert_allclose(mandel.von_mises(sheared[:, :6]), M * p, rtol=1e-4)
    np.testing.assert_allclose(of(law, sheared, "preconsolidation"), 2.0 * p, rtol=1e-4)
    np.testing.assert_allclose(of(law, sheared, "pore_pressure"), 0.0, atol=1e-9 * PRESSURE[1])
    np.testing.assert_allclose(-mandel.mean(sheared[:, :6]), p, rtol=1e-9)


def test_the_water_bears_what_is_squeezed_where_nothing_drains() -> None:
    """The mean total stress grows by water and skeleton in parallel."""
    law, lost = clay(isotropic(), OCR=3.0, water=2.0e7), 1e-4
    after = followed(law, -lost / 3.0 * mandel.UNIT, 1)
    np.testing.assert_allclose(of(law, after, "pore_pressure"), 2.0e7 * lost, rtol=1e-9)
    skeleton = PRESSURE * math.exp(lost * (1.0 + E0) / KAPPA)
    np.testing.assert_allclose(-mandel.mean(after[:, :6]), skeleton + 2.0e7 * lost, rtol=1e-9)


def test_drained_triaxial_compression_ends_at_the_critical_state(tmp_path: Path) -> None:
    """The radial stress stays: q = 3 M p0/(3 - M), driven by stress on two sides."""
    file = tmp_path / "triaxial.csv"
    rows = "".join(f"{-n / 250}, 0, 0\n" for n in range(1, 301))
    file.write_text("eps_zz [-], sigma_xx [Pa], sigma_yy [Pa]\n" + rows, encoding="utf-8")
    soil = Scene.from_file(HERE / "scene.yaml").changed({"soil.law.water": 0.0, "soil.law.attraction": 1.0}).model.soil
    assert soil is not None
    point = point_at(soil, 1.0)
    stress = drive(point, read_path(file)).stress[-1]
    assert stress[0] - stress[2] == pytest.approx(3.0 / (3.0 - 1.0) * 5.001e3, rel=1e-3)


def test_the_tangent_is_the_stress_s_derivative() -> None:
    """Along a path that flows on the wet and the dry side, and goes back; and it differs where nothing flows."""
    law = clay(isotropic(), OCR=1.3, water=1.0e6)
    rng, history, flowed = np.random.default_rng(4), law.start(), 0
    for _ in range(12):
        increment = rng.normal(scale=3e-3, size=(2, 6))
        update, slopes = law.update(increment, history), np.empty((2, 6, 6))
        for j in range(6):
            ahead, behind = (law.update(increment + h * np.eye(6)[j], history).stress for h in (1e-8, -1e-8))
            slopes[:, :, j] = (ahead - behind) / 2e-8
        np.testing.assert_allclose(update.tangent, slopes, atol=1e-5 * float(update.tangent.max()))
        softer = mandel.DEVIATOR @ (update.tangent - mandel.stiffness(np.zeros(2), law.shear)) @ mandel.DEVIATOR
        flowed += int(np.abs(softer).max() > 0.1 * law.shear.max())
        history = update.history
    assert flowed > 5


@pytest.mark.parametrize("OCR", [1.0, 4.0])
def test_no_path_gives_work_back(OCR: float) -> None:
    initial = initial_stress(100, 0.7)
    random_paths(clay(initial, OCR=OCR, water=5.0e6), initial, 30, seed=3, largest=-1.5)


def test_the_page_shows_the_files() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert blocks(PAGE, "python")[0] == (HERE / "my_clay.py").read_text(encoding="utf-8")
    assert blocks(PAGE, "yaml") == [(HERE / "scene.yaml").read_text(encoding="utf-8")]
    assert len((HERE / "my_clay.py").read_text(encoding="utf-8").splitlines()) <= 100
    su, gradient = strength(Scene.from_file(HERE / "scene.yaml"))
    assert f"{1e-3 * su:.2f} kPa at the seabed, {1e-3 * gradient:.2f} kPa/m more" in re.sub(r"\s+", " ", text)


def test_the_page_s_energy_softens_in_shear_alone(tmp_path: Path) -> None:
    """Its secant shear modulus is half of G where 1 + 2 e:e/g² = 4."""
    (tmp_path / "softening.py").write_text(blocks(PAGE, "python")[1], encoding="utf-8")
    given = {"kind": "imported", "from": f"{tmp_path / 'softening.py'}:Softening", "K": 2e7, "G": 1e6, "half_at": 2e-3}
    law = ImportedLaw.model_validate(given).at_points(np.ones(1), np.zeros((1, 6)))
    strain = np.array([[-1e-3, -1e-3, -1e-3, 0.0, 2e-3 * math.sqrt(1.5), 0.0]])
    stress = law.update(strain, law.start()).stress
    np.testing.assert_allclose(stress, [[-6e4, -6e4, -6e4, 0.0, 1e6 * strain[0, 4], 0.0]], rtol=1e-12, atol=1e-6)


def test_the_material_command_drives_the_page_s_law(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Cycles, by which the law's memory is told, have few rows."""
    monkeypatch.setattr(memory, "ROWS", 8)
    results = study(Scene.from_file(HERE / "scene.yaml").model, tmp_path / "point")
    line_with(results, "imported at a depth of 0.75 m", "gamma_xz")
    assert (tmp_path / "point" / "material.csv").is_file()


@pytest.mark.parametrize("term", ["multiplier_by", "lost_by"])
def test_a_tangent_without_a_term_is_refused(tmp_path: Path, term: str) -> None:
    text = (HERE / "my_clay.py").read_text(encoding="utf-8")
    line = "        K = self.elastic * p\n"
    wrong = text.replace(line, f"        {term} = 0.0 * {term}\n{line}")
    assert wrong != text
    (tmp_path / "my_clay.py").write_text(wrong, encoding="utf-8")
    law = soil_of(Scene.from_file(HERE / "scene.yaml")).top_law.model_dump(by_alias=True)
    with pytest.raises(SceneError, match=telling("my_clay.py:CamClay", "tangent")):
        ImportedLaw.model_validate(law | {"from": f"{tmp_path / 'my_clay.py'}:CamClay"}).surface_modulus(0.25)


def test_a_pipe_meets_the_resistance_of_clay_of_the_same_strength() -> None:
    """Within a per cent that of von Mises clay; and that of a smooth pipe in rigid plastic clay at D/10, within 3 %."""
    scene = Scene.from_file(HERE / "scene.yaml")
    shown = [line.split("|")[1:-1] for line in block(PAGE.read_text(encoding="utf-8"), "resistance").splitlines()[2:]]
    table = {name.strip(): [float(x) for x in numbers] for name, *numbers in shown}
    factor = resistance(scene) / strength(scene)[0]
    assert factor == pytest.approx(table["my_clay.py"], abs=0.006)
    assert factor == pytest.approx(table["von-mises of the same su"], rel=0.01)
    assert factor[-1] == pytest.approx(5.3 * 0.1**0.25, rel=0.03)
