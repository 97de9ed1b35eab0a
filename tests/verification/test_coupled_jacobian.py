"""The matrix of the whole system against finite differences of its residual, row group by row group.

The states are well beyond first yield and the riser presses on the soil and on the springs beside it.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from riser_soil.contact.node_contact import NodeContact
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.system import System
from riser_soil.soil.laws import LAWS
from tests.support.driven_stage import FirstStep, built, soil_under
from tests.support.scenes import LAY, Mapping, heave, touchdown

LIFT: Mapping = {"name": "lift", "kind": "static", "move": {"end": [22.5, 0.0, 15.1]}}
NEXT = {"static": LIFT, "dynamic": heave(1.0, time_step=0.01)}
CONTACT: dict[str, Mapping] = {
    "node": {},
    "surface": {
        "smoothing": 1e-3,
        "friction": {"axial": 0.4, "lateral": 0.7},
        "suction": {"cap": 300.0, "reach": 0.02},
    },
}
STEP = 1e-5  # of the finite differences, times perturbations of millimetres: no point starts or stops yielding


class Case:
    """The first step after laying, looked at in a state away from balance; x the unknowns there. By default the soil
    is perfectly plastic clay.
    """

    def __init__(
        self, kind: str, dimension: int, stage: str, method: str = "node", law: Mapping | None = None
    ) -> None:
        scene = touchdown(LAY, NEXT[stage], kind=kind, dimension=dimension, su=1000.0)
        scene["soil"]["law"] = law or scene["soil"]["law"]
        scene["contact"] = {"method": method} | CONTACT[method]
        scene["solver"]["soil"] = "whole"
        assembly = built(scene)
        self.step = FirstStep(assembly)
        self.assembly = assembly
        self._random = np.random.default_rng(5)
        self.x = self.direction()

    def direction(self) -> Array:
        """Random: millimetres on the riser, rotations to match, and what makes the soil yield."""
        x = self._random.normal(size=self.step.free)
        x[self.riser] *= 1e-3
        x[self.soil] *= 4e-3
        return x

    @property
    def riser(self) -> IntArray:
        line = self.assembly.riser.line
        return self.step.rows(line.offset + np.arange(line.size))

    @property
    def soil(self) -> IntArray:
        return np.setdiff1d(np.arange(self.step.free), self.riser)

    @property
    def active(self) -> dict[str, IntArray]:
        """Rows of the riser's and of the soil's dofs on which contact acts at x."""
        contact, state = soil_under(self.assembly).contact, self.step.state(self.x)
        if isinstance(contact, NodeContact):
            points = contact.touching(state).points
            touched = contact.pair_dofs(points.node, points.facet)
        else:
            assert isinstance(contact, SurfaceContact)
            pairs = contact.evaluate(state).pressed.pairs
            touched = contact.pair_dofs(pairs.element, pairs.facet)
        rows = self.step.rows(touched.ravel())
        return {
            "touched riser": np.intersect1d(rows, self.riser),
            "touched soil": np.intersect1d(rows, self.soil),
        }

    @property
    def pushes_and_pulls(self) -> bool:
        """Whether the soil presses on the pipe at some points at x, and by suction holds it at others."""
        contact = soil_under(self.assembly).contact
        assert isinstance(contact, SurfaceContact)
        force = contact.evaluate(self.step.state(self.x)).pressed.force
        return bool(force.min() < 0.0 < force.max())

    def groups(self) -> dict[str, IntArray]:
        return {"riser": self.riser, "soil": self.soil} | self.active

    def differences(self, direction: Array) -> Array:
        """Directional derivative of the residual at x."""
        return self.step.slope(self.x, direction, STEP)

    def errors(self) -> dict[str, float]:
        """Relative error of the matrix by row group, the largest over several directions."""
        matrix, errors = self.step.matrix(self.x), dict.fromkeys(self.groups(), 0.0)
        for direction in (self.direction() for _ in range(4)):
            wanted, got = self.differences(direction), matrix @ direction
            for name, rows in self.groups().items():
                error = np.linalg.norm((got - wanted)[rows]) / np.linalg.norm(wanted[rows])
                errors[name] = max(errors[name], float(error))
        return errors

    def plastic_share(self) -> float:
        """Share of the soil's cells in which some point yields on the way to x; x is accepted by this."""
        soil = soil_under(self.assembly).whole
        before = soil.output_fields().plastic_strain
        state = self.step.state(self.x)
        soil.commit(state)
        return float(np.mean(soil.output_fields().plastic_strain > before))


CASES = [("tet", 3, "dynamic", "node"), ("hex", 2, "static", "surface")]
OTHERS = [(k, d, s, "node") for k in ("hex", "tet") for d in (2, 3) for s in ("static", "dynamic")]
OTHERS = [*(case for case in OTHERS if case not in CASES), ("tet", 3, "static", "surface")]


@pytest.mark.parametrize(
    ("kind", "dimension", "stage", "method"),
    [*CASES, *(pytest.param(*case, marks=pytest.mark.verify) for case in OTHERS)],
)
def test_jacobian_equals_finite_differences(kind: str, dimension: int, stage: str, method: str) -> None:
    case = Case(kind, dimension, stage, method)
    errors = case.errors()
    assert max(errors.values()) < 1e-7, errors
    assert all(len(rows) > 10 for rows in case.groups().values())
    assert case.plastic_share() > 0.3


OF_CLAY: Mapping = {"su": 1000.0, "su_gradient": 500.0, "E_over_su": 300.0, "nu": 0.49}
# So soft that the millimetres keep clear of the cone's apex.
SAND: Mapping = {"friction_angle_deg": 30.0, "dilation_angle_deg": 10.0, "cohesion": 1000.0, "E": 1.0e5, "nu": 0.2}
OF_LAWS: dict[str, Mapping] = {
    "linear-elastic": {"E": 3.0e5, "nu": 0.49},
    "von-mises": OF_CLAY,
    "kinematic-hardening": OF_CLAY,
    "iwan": OF_CLAY,
    "drucker-prager": SAND,
}


def test_every_law_is_known_here() -> None:
    """The tangent of one from a file is tried where it is read."""
    assert OF_LAWS.keys() | {"imported"} == LAWS.keys()


LONG = "linear-elastic", "von-mises", "kinematic-hardening"  # which others have within them


@pytest.mark.parametrize("law", [pytest.param(law, marks=[pytest.mark.verify] * (law in LONG)) for law in OF_LAWS])
def test_jacobian_with_every_law_friction_and_suction(law: str) -> None:
    """In space and in motion, under the pipe's surface."""
    case = Case("hex", 3, "dynamic", "surface", {"kind": law} | OF_LAWS[law])
    assert case.pushes_and_pulls
    errors = case.errors()
    assert max(errors.values()) < 1e-7, errors
    assert (case.plastic_share() > 0.3) == (law != "linear-elastic")


@pytest.mark.parametrize(("kind", "method"), [("hex", "node"), ("tet", "node"), ("hex", "surface")])
def test_every_part_matters_in_the_jacobian(kind: str, method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Left out of the matrix, each part shows in the rows that it acts on."""
    case = Case(kind, 3, "dynamic", method)
    system = case.step.system
    for part in system.model.parts:
        if part.name == "new mesh":  # acts between steps
            continue
        others = [each for each in system.model.parts if each is not part]
        with monkeypatch.context() as without:
            without.setattr(system, "assemble", partial(System.assemble, system, parts=others))
            errors = case.errors()
        assert max(errors.values()) > 1e-5, part.name
        if part.name == "contact":
            assert min(errors["touched riser"], errors["touched soil"]) > 5e-3, errors


@pytest.mark.parametrize("stage", ["static", "dynamic"])
def test_matrix_is_symmetric_where_the_system_says_so(stage: str) -> None:
    """Still water's drag and the turning of accelerated directors make dynamics unsymmetric."""
    case = Case("hex", 3, stage)
    matrix = case.step.matrix(case.x)
    skew = abs(matrix - matrix.T).max() / abs(matrix).max()
    assert case.step.system.symmetric == (stage == "static")
    assert (skew < 1e-12) == (stage == "static")
