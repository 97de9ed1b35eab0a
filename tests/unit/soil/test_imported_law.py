"""Laws of one's own, from files of a user: what the program makes of the three shapes, and says of wrong ones."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from riser_soil.checks.settlement import predicted_settlement
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.results import Run
from riser_soil.scene.document import parse
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.identity import first_difference, identity_of
from riser_soil.scene.reader import checked, scene_from_mapping
from riser_soil.soil import mandel
from riser_soil.soil.imported_law import ImportedLaw
from riser_soil.soil.large_strain import turned
from riser_soil.soil.law import STRESS
from riser_soil.soil.von_mises import VonMises
from riser_soil.whole_run import run
from tests.support.driven_stage import built
from tests.support.material_paths import initial_stress, random_paths
from tests.support.run_on_ranks import COMPARED, ran
from tests.support.said import line_with, telling
from tests.support.scenes import LAY, Mapping, touchdown

E, NU = 2.4e6, 0.3
MU, LAME = E / (2.0 * (1.0 + NU)), E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU))
PLACES = ("xx", "yy", "zz", "xy", "xz", "yz")

HEAD = """
import numpy as np
from riser_soil.soil import mandel
from riser_soil.soil.law import STRESS
"""
# Linear elastic soil with a count of its increments. The marks are where tests make it wrong.
ELASTIC = """
class Own:
    columns = (*STRESS, "count")
    symmetric = True
    by_rate = False

    def __init__(self, initial, E, nu=0.3):
        n = len(initial)
        self.C = mandel.stiffness(np.full(n, E / 3 / (1 - 2 * nu)), np.full(n, E / 2 / (1 + nu)))

    def update(self, increment, history, dt):
        tangent = self.C.copy()
        #tangent
        stress = history[:, :6] + np.einsum("nij,nj->ni", self.C, increment)
        after = np.column_stack((stress, history[:, 6] + 1.0))
        #answer
        return stress, tangent, after
"""
# As ELASTIC by fenics-constitutive's interface, but three times as stiff in shear yz; `xz_last`: its older order.
CONSTITUTIVE = """
class Own:
    history_dim = {"total": 6, "count": 1, "pair": 2}
    symmetric = True

    def __init__(self, parameters: dict[str, float], xz_last: bool):
        E, nu = parameters["E"], parameters["nu"]
        self.mu, self.lam, self.xz_last = E / 2 / (1 + nu), E * nu / (1 + nu) / (1 - 2 * nu), xz_last

    def evaluate(self, t, del_t, grad_del_u, stress, tangent, history):
        g = grad_del_u.reshape(-1, 3, 3)
        pairs = ((0, 0), (1, 1), (2, 2), (0, 1), *(((1, 2), (0, 2)) if self.xz_last else ((0, 2), (1, 2))))
        strain = np.column_stack([(g[:, i, j] + g[:, j, i]) * (0.5 if i == j else 0.5**0.5) for i, j in pairs])
        D = 2 * self.mu * np.eye(6)
        D[:3, :3] += self.lam
        D[pairs.index((1, 2)), pairs.index((1, 2))] *= 3.0
        stress.reshape(-1, 6)[:] += strain @ D
        tangent[:] = np.tile(D.ravel(), len(g))
        history["total"].reshape(-1, 6)[:] += strain
        history["count"] += 1.0
        history["pair"].reshape(-1, 2)[:, 1] += del_t
"""
ENERGY = """
import ufl

class Own:
    def __init__(self, E, nu, softens_at, grows=0.0):
        self.mu, self.K, self.g, self.grows = E / 2 / (1 + nu), E / 3 / (1 - 2 * nu), softens_at, grows

    def psi(self, eps, depth):
        e = ufl.dev(eps)
        shear = ufl.sqrt(1 + 2 * ufl.inner(e, e) / self.g**2) - 1
        return (self.K / 2 * ufl.tr(eps) ** 2 + self.mu * self.g**2 * shear) * (1 + self.grows * depth)
"""
# The program's own von Mises clay, as a user would hand it on.
CLAY = """
from riser_soil.soil.von_mises import VonMises

class Own:
    symmetric = True
    by_rate = False

    def __init__(self, depth, initial, fails_at=None, **given):
        self.formula = VonMises(kind="von-mises", **given).at_points(depth, initial)
        self.columns, self.start, self.overstress = self.formula.columns, self.formula.start, self.formula.overstress
        self.fails_at = fails_at

    def update(self, increment, history, dt):
        if self.fails_at is not None and abs(increment).max() > self.fails_at:
            raise ArithmeticError("too far")
        return self.formula.update(increment, history, dt)
"""
Write = Callable[..., ImportedLaw]


@pytest.fixture
def own(tmp_path: Path) -> Write:
    """The law of a file with this text, beside a scene."""

    def written(text: str, **given: Any) -> ImportedLaw:
        (tmp_path / "own.py").write_text(HEAD + text, encoding="utf-8")
        return read(tmp_path, {"kind": "imported", "from": "own.py:Own", **given})

    return written


def read(folder: Path, law: Mapping) -> ImportedLaw:
    return ImportedLaw.model_validate(law, context={"folder": folder})


def points(n: int = 40) -> tuple[Array, Array]:
    """Depths, and a geostatic stress."""
    return np.linspace(0.02, 2.0, n), initial_stress(n, 0.95)


def strains(n: int, seed: int = 2) -> Array:
    return np.asarray(np.random.default_rng(seed).normal(scale=1e-3, size=(n, 6)))


def test_columns_modulus_and_energy_follow_from_an_update_alone(own: Write) -> None:
    law = own(ELASTIC, E=E)
    depth, initial = points()
    formula, strain = law.at_points(depth, initial), strains(40)
    update = formula.update(strain, formula.update(0.5 * strain, formula.start()).history)
    change = 1.5 * strain @ mandel.stiffness(np.array([LAME + 2.0 * MU / 3.0]), np.array([MU]))[0]
    np.testing.assert_allclose(update.stress, initial + change, rtol=1e-12)
    np.testing.assert_allclose(update.stored, 0.5 * mandel.product(change, 1.5 * strain), rtol=1e-12)
    np.testing.assert_allclose(update.elastic, 1.5 * strain, rtol=1e-10, atol=1e-15)
    assert np.all(update.history[:, 6] == 2.0)
    assert law.surface_modulus(0.3) == pytest.approx(E, rel=1e-12)
    assert formula.symmetric
    assert not formula.by_rate


@pytest.mark.parametrize("xz_last", [True, False])
def test_an_evaluate_of_either_order_of_components(own: Write, xz_last: bool) -> None:
    """fenics-constitutive had yz before xz, and has had xz before yz since."""
    depth, initial = points()
    formula, strain = (
        own(CONSTITUTIVE, parameters={"E": E, "nu": NU}, xz_last=xz_last).at_points(depth, initial),
        strains(40),
    )
    update = formula.update(strain, formula.start(), 0.25)
    C = mandel.stiffness(np.array([LAME + 2.0 * MU / 3.0]), np.array([MU]))[0]
    C[5, 5] *= 3.0
    np.testing.assert_allclose(update.stress, initial + strain @ C, rtol=1e-12)
    np.testing.assert_allclose(update.tangent, np.broadcast_to(C, (40, 6, 6)), rtol=1e-12)
    assert formula.columns == (*STRESS, *(f"total_{place}" for place in PLACES), "count", "pair_0", "pair_1")
    np.testing.assert_allclose(update.history[:, 6:12], strain, rtol=1e-12)
    assert np.all(update.history[:, 12:] == [1.0, 0.0, 0.25])
    assert formula.by_rate


def test_a_history_of_six_numbers_turns_with_the_material(own: Write) -> None:
    depth, initial = points(3)
    formula = own(CONSTITUTIVE, parameters={"E": E, "nu": NU}, xz_last=True).at_points(depth, initial)
    history = formula.update(np.tile([1e-3, 0.0, -2e-3, 0.0, 0.0, 0.0], (3, 1)), formula.start(), 1.0).history
    quarter = np.tile([0.0, 2.0, 0.0], (3, 1))  # Hughes & Winget's turn by 90 degrees about y
    after = turned(history, formula.columns, quarter)
    np.testing.assert_allclose(after[:, 6:9], np.tile([-2e-3, 0.0, 1e-3], (3, 1)), atol=1e-15)
    assert np.array_equal(after[:, 12:], history[:, 12:])


def test_stress_and_moduli_of_an_energy_are_its_derivatives(own: Write) -> None:
    limit, grows = 1.5e-3, 0.4
    depth, initial = points()
    formula = own(ENERGY, E=E, nu=NU, softens_at=limit, grows=grows).at_points(depth, initial)
    first, strain = strains(40), strains(40, seed=5)
    update = formula.update(strain, formula.update(first, formula.start()).history)
    total, deeper = first + strain, 1.0 + grows * depth
    K, e = LAME + 2.0 * MU / 3.0, mandel.deviator(total)
    root = np.sqrt(1.0 + 2.0 * mandel.product(e, e) / limit**2)
    stress = 3.0 * K * mandel.mean(total)[:, None] * mandel.UNIT + 2.0 * MU * e / root[:, None]
    energy = 4.5 * K * mandel.mean(total) ** 2 + MU * limit**2 * (root - 1.0)
    np.testing.assert_allclose(update.stress - initial, deeper[:, None] * stress, rtol=1e-10)
    np.testing.assert_allclose(update.stored, deeper * energy, rtol=1e-10)
    np.testing.assert_allclose(update.elastic, total, rtol=1e-14)
    np.testing.assert_allclose(update.history[:, 6:], total, rtol=1e-14)
    slopes = np.empty((40, 6, 6))
    for j in range(6):
        ahead, behind = (
            formula.update(strain + h * np.eye(6)[j], formula.update(first, formula.start()).history)
            for h in (1e-7, -1e-7)
        )
        slopes[:, :, j] = (ahead.stress - behind.stress) / 2e-7
    np.testing.assert_allclose(update.tangent, slopes, atol=1e-6 * E)


def test_an_energy_gives_back_all_that_it_took(own: Write) -> None:
    """Around a closed path; and no path of increments dissipates less than nothing."""
    depth, initial = points()
    formula = own(ENERGY, E=E, nu=NU, softens_at=1e-3).at_points(depth, initial)
    history = formula.start()
    for seed, sign in ((1, 1.0), (2, 1.0), (2, -1.0), (1, -1.0)):
        update = formula.update(sign * strains(40, seed), history)
        history = update.history
    np.testing.assert_allclose(update.stress, initial, atol=1e-9 * E)
    np.testing.assert_allclose(update.stored, 0.0, atol=1e-12 * E)
    assert random_paths(formula, initial, 10, seed=3) == 0.0


def clay_scene(tmp_path: Path, **given: Any) -> Mapping:
    (tmp_path / "own.py").write_text(HEAD + CLAY, encoding="utf-8")
    clay = {key: value for key, value in touchdown(LAY)["soil"]["law"].items() if key != "kind"} | {"su_gradient": 0.0}
    scene = touchdown(LAY)
    scene["soil"]["law"] = {"kind": "imported", "from": f"{tmp_path / 'own.py'}:Own"} | clay | given
    return scene


def test_the_program_s_clay_by_way_of_a_file_is_the_same_clay(tmp_path: Path) -> None:
    depth, initial = points()
    scene = scene_from_mapping(clay_scene(tmp_path))
    assert scene.soil is not None
    law = scene.soil.top_law
    given = {key: value for key, value in clay_scene(tmp_path)["soil"]["law"].items() if key not in ("kind", "from")}
    known = VonMises(kind="von-mises", **given)
    one, other = law.at_points(depth, initial), known.at_points(depth, initial)
    history, again = one.start(), other.start()
    for seed in range(3):
        update, wanted = one.update(3.0 * strains(40, seed), history), other.update(3.0 * strains(40, seed), again)
        for values, expected in zip(update, wanted, strict=True):
            assert np.array_equal(values, expected)
        history, again = update.history, wanted.history
    np.testing.assert_allclose(one.bulk, other.bulk, rtol=1e-12)
    np.testing.assert_allclose(one.shear, other.shear, rtol=1e-12)
    assert law.surface_modulus(0.3) == pytest.approx(known.surface_modulus(0.3), rel=1e-12)


@pytest.mark.verify
def test_two_ranks_find_on_it_what_one_finds_on_the_program_s_own_clay(tmp_path: Path) -> None:
    scene = clay_scene(tmp_path)
    given = {key: value for key, value in scene["soil"]["law"].items() if key != "from"}
    program_s = scene | {"soil": scene["soil"] | {"law": given | {"kind": "von-mises"}}}
    run(scene_from_mapping(program_s), tmp_path / "on1")
    wanted, computed = Run(tmp_path / "on1").dataset, ran(scene, tmp_path / "on2", 2).dataset
    for name in COMPARED:
        largest = float(np.abs(wanted[name]).max())
        np.testing.assert_allclose(computed[name], wanted[name], rtol=1e-6, atol=1e-6 * largest)


WRONG: dict[str, tuple[str, str, str, tuple[str, ...]]] = {
    "tangent": (ELASTIC, "#tangent", "tangent[:, 4, 4] *= 1.001", ("tangent", "xz by xz", "0.001")),
    "unsymmetric": (
        ELASTIC, "#tangent", "self.C[:, 0, 1] *= 1.1; tangent = self.C.copy()", ("symmetric", "symmetric = False"),
    ),
    "overflow": (ELASTIC, "#answer", "stress += np.expm1(1e9 * abs(increment))", ("the stress is not finite",)),
    "nan in its history": (ELASTIC, "#answer", "after[:, 6] = np.sqrt(-1.0)", ("the history is not finite",)),
    "history of another size": (ELASTIC, "#answer", "after = after[:, :6]", ("history", "shape", "7)")),
    "stress of another size": (ELASTIC, "#answer", "stress = stress[:, :4]", ("stress", "shape", "6)")),
    "no numbers": (ELASTIC, "#answer", "tangent = None", ("tangent", "shape ()")),
    "two values": (ELASTIC, "tangent, after", "tangent", ("2 values", "stress, tangent, history")),
    "its history written over": (ELASTIC, "#answer", "history[:, 6] += 1.0", ("changes its input history",)),
    "its increment written over": (ELASTIC, "#answer", "increment *= 2.0", ("changes its input increment",)),
    "an error of its own": (ELASTIC, "#answer", "1.0 / 0", ("own.py:20", "ZeroDivisionError", "division by zero")),
    "time matters": (ELASTIC, "#answer", "stress += min(dt, 10.0) * increment", ("by_rate = True", "1 s")),
    "no stiffness": (ELASTIC, "E / 3 / (1 - 2 * nu)", "0.0", ("bulk modulus", "above 0")),
    "stress without strain": (ELASTIC, "#answer", "stress += 10.0; after[:, :6] = stress", ("no strain", "10 Pa")),
    "another start": (
        ELASTIC, "def update", "start = lambda self: np.ones((len(self.C), 7))\n    def update", ("start()", "initial"),
    ),
    "no stress among its columns": (ELASTIC, '(*STRESS, "count")', '("count",)', ("columns", "begin with the stress")),
    "half a tensor": (ELASTIC, '"count")', '"back_xx")', ("columns", "back_xx", "all six")),
    "a name twice": (ELASTIC, '"count")', '"stress_xx")', ("columns", "twice")),
    "no method": (ELASTIC, "def update", "def updated", ("update, evaluate, psi", "has none")),
    "too many methods": (ELASTIC, "def update", "def psi(self, eps): pass\n\n    def update", ("has update and psi",)),
    "plane strain": (
        CONSTITUTIVE, "history_dim =", "stress_strain_dim = 4\n    history_dim =", ("4 components", "FULL"),
    ),
    "history in place of a dimension": (CONSTITUTIVE, '"count": 1', '"count": (3, 3)', ("count", "(3, 3)")),
    "no answer to shear": (CONSTITUTIVE, "strain @ D", "0.0 * strain @ D", ("yz", "can't be seen")),
    "another history handed back": (
        CONSTITUTIVE, 'history["count"] += 1.0', 'history["count"] = np.zeros(3)', ("history count", "shape (3,)"),
    ),
    "energy that is no number": (ENERGY, "return (", "return eps * (", ("psi must return a number",)),
    "energy with a stress at rest": (ENERGY, "return (", "return ufl.tr(eps) * 1e3 + (", ("psi", "no strain")),
    "energy of a name that is not there": (ENERGY, "ufl.dev", "ufl.deviator", ("own.py", "AttributeError", "deviator")),
}  # fmt: skip
PARAMETERS: dict[str, dict[str, Any]] = {
    ELASTIC: {"E": E},
    CONSTITUTIVE: {"parameters": {"E": E, "nu": NU}, "xz_last": True},
    ENERGY: {"E": E, "nu": NU, "softens_at": 1e-3},
}


@pytest.mark.parametrize("name", WRONG)
def test_what_a_law_does_wrong_is_told_in_one_line(own: Write, name: str) -> None:
    text, right, wrong, words = WRONG[name]
    assert right in text
    law = own(text.replace(right, wrong, 1), **PARAMETERS[text])
    depth, initial = points()
    with pytest.raises(SceneError, match=telling("soil.law", "own.py:Own", *words)) as error:
        law.at_points(depth, initial)
    assert "\n" not in str(error.value)


def test_a_wrong_tangent_is_told_with_depth_and_strain_increment(own: Write) -> None:
    """A clay whose tangent is elastic where it flows."""
    call = "found = self.formula.update(increment, history, dt)"
    text = CLAY.replace("return self", f"{call}\n        return found._replace(tangent=self.formula._elastic) #")
    law = own(text, su=1e3, su_gradient=0.0, E_over_su=300.0)
    with pytest.raises(SceneError, match=telling("at a depth of", "gamma_xz 0.0127", "tangent")):
        law.at_points(*points())


def scene_text(folder: Path, law: Mapping) -> str:
    scene = touchdown(LAY)
    scene["soil"]["law"] = law
    return json.dumps(scene, indent=1)


def refused(folder: Path, law: Mapping) -> str:
    with pytest.raises(SceneError) as error:
        checked(parse(scene_text(folder, law), "scene.yaml"), folder)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_a_scene_names_file_class_and_parameters_or_is_refused(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(HEAD + ELASTIC, encoding="utf-8")
    (tmp_path / "broken.py").write_text("x = 1\nclass Own\n", encoding="utf-8")
    (tmp_path / "lost.py").write_text("import numpy\n\nimport no_such_module_anywhere\n", encoding="utf-8")
    law = {"kind": "imported", "from": "own.py:Own", "E": E}
    checked(parse(scene_text(tmp_path, law), "scene.yaml"), tmp_path)
    line_with(refused(tmp_path, law | {"nue": 0.2}), "soil.law.nue:", "known are E, nu", 'did you mean "nu"?')
    line_with(refused(tmp_path, law | {"initial": 0.2}), "soil.law.initial:", "comes from the program")
    line_with(refused(tmp_path, {"kind": "imported", "from": "own.py:Own"}), "soil.law.E:", "missing")
    line_with(
        refused(tmp_path, law | {"from": "own.py:Owner"}), "soil.law.from:", "no class Owner", 'did you mean "Own"?'
    )
    line_with(
        refused(tmp_path, law | {"from": "other.py:Own"}), "soil.law.from:", "no such file", str(tmp_path / "other.py")
    )
    line_with(refused(tmp_path, law | {"from": "own.py"}), "soil.law.from:", "my_clay.py:CamClay")
    line_with(refused(tmp_path, law | {"from": 3}), "soil.law.from:", "my_clay.py:CamClay")
    line_with(refused(tmp_path, law | {"from": "broken.py:Own"}), "soil.law.from:", "broken.py:2:", "SyntaxError")
    line_with(refused(tmp_path, law | {"from": "lost.py:Own"}), "lost.py:3:", "ModuleNotFoundError")
    line_with(refused(tmp_path, law | {"from": "no_such_module_anywhere:Own"}), "soil.law.from:", "ModuleNotFoundError")
    line_with(refused(tmp_path, {"kind": "imported"}), "soil.law.from:", "required")


def test_words_stand_for_members_of_an_enumeration(own: Write) -> None:
    kinds = "from enum import Enum\n\nclass Kind(Enum):\n    SOFT = 0.2\n    STIFF = 0.45\n"
    text = kinds + ELASTIC.replace("nu=0.3):", "mode: Kind):\n        nu = mode.value")
    formula = own(text, E=E, mode="STIFF").at_points(*points())
    np.testing.assert_allclose(formula.bulk, E / (3.0 * (1.0 - 0.9)), rtol=1e-12)
    with pytest.raises(ValidationError, match="SOFT, STIFF"):
        own(text, E=E, mode="SOLID")


def test_a_scene_that_was_written_out_is_the_same_scene_and_knows_its_file(tmp_path: Path) -> None:
    given = clay_scene(tmp_path)
    scene = scene_from_mapping(given)
    before = identity_of(scene)
    assert identity_of(checked(parse(dump_scene(scene), "again.yaml"), Path("/"))) == before
    (tmp_path / "own.py").write_text(HEAD + CLAY + "\n# changed\n", encoding="utf-8")
    changed = first_difference(before, identity_of(scene_from_mapping(given)))
    assert changed is not None
    assert changed.key.startswith("soil.law.from")


def test_a_changed_file_is_read_anew(own: Write) -> None:
    first = own(ELASTIC, E=E).at_points(*points()).bulk
    second = own(ELASTIC.replace("E / 3", "2 * E / 3"), E=E).at_points(*points()).bulk
    np.testing.assert_allclose(second, 2.0 * first, rtol=1e-12)


def test_a_failure_on_the_way_is_told_once_and_answers_nothing(own: Write, capsys: pytest.CaptureFixture[str]) -> None:
    law = own(CLAY, su=1e3, E_over_su=300.0, fails_at=0.02)
    depth, initial = points(4)
    formula = law.at_points(depth, initial)
    capsys.readouterr()
    for _ in range(2):
        update = formula.update(np.full((4, 6), 0.05), formula.start())
        assert all(np.isnan(values).all() for values in update[:3])
    line_with(capsys.readouterr().err, "soil.law", "own.py:Own", "own.py:19:", "ArithmeticError", "too far")


def test_forecasts_and_contact_take_the_stress_at_a_depth(own: Write, tmp_path: Path) -> None:
    """A law as stiff as it is pressed: G = 40 p. The predicted settlement is that of layers of such stiffness."""
    text = HEAD + ELASTIC.replace("n = len(initial)", "E = E * -mandel.mean(initial)").replace("np.full(n, ", "(")
    (tmp_path / "own.py").write_text(text, encoding="utf-8")
    scene = touchdown(LAY)
    scene["soil"] |= {"law": {"kind": "imported", "from": f"{tmp_path / 'own.py'}:Own", "E": 100.0}, "K0": 0.6}
    soil = scene_from_mapping(scene).soil
    assert soil is not None
    law = soil.top_law
    assert law.surface_modulus(0.3) == pytest.approx(100.0 * 0.15 * 5.0e3 * (1.0 + 1.2) / 3.0, rel=1e-9)
    settled = predicted_settlement(built(scene).riser)
    assert settled is not None
    assert 0.0 < settled.by_weight < 1.0
