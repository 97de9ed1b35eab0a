"""A pipe falls on a slice of soil: no energy appears beyond what gravity puts in, whatever the contact's stiffness."""

from __future__ import annotations

from pathlib import Path

import pytest

from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.stages import run_stage
from riser_soil.whole_run import run
from tests.support.driven_stage import built
from tests.support.said import lines_with
from tests.support.scenes import CLAY, ELASTIC, END, FALL_ON_SOIL, MIDDLE, Mapping, falling_on_soil
from tests.support.stage_histories import Energies

LAWS = pytest.mark.parametrize("law", [ELASTIC, CLAY], ids=["elastic", "clay"])
WHERE = pytest.mark.parametrize("where", [MIDDLE, END], ids=["middle", "end"])


def gains_nothing(k: float, dt: float, law: Mapping, where: tuple[float, float]) -> None:
    """The pipe has struck, and what is stored never exceeds what it began with.

    Contact's own account is of either sign in a step, as the surface turns while clay flows; it gives nothing on the
    whole.
    """
    assembly, watch = built(falling_on_soil(k, dt, law, where)), Energies()
    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), watch, Timer.new())
    print(f"k {k:.0e} N/m2, dt {dt:g} s: {watch.report()}")
    assert watch.gain[-1] < -0.1 * FALL_ON_SOIL, "nothing was struck"
    assert watch.gain.max() < 1e-9 * FALL_ON_SOIL
    assert watch.appeared.max() < 5e-3 * FALL_ON_SOIL
    assert watch.by_contact.sum() > -5e-3 * FALL_ON_SOIL


@pytest.mark.parametrize(
    ("k", "dt", "law"),
    [(1e7, 0.05, ELASTIC), pytest.param(1e8, 0.02, CLAY, marks=pytest.mark.verify), (1e7, 0.02, CLAY)],
    ids=["elastic", "stiff on clay", "clay"],
)
def test_impact_on_soil_gains_no_energy(k: float, dt: float, law: Mapping) -> None:
    """On clay Newton's iterations may halt for a while, far from balance, where the pattern of contact is renewed."""
    gains_nothing(k, dt, law, MIDDLE)


@pytest.mark.parametrize(("k", "warned"), [(1e4, True), (1e7, False)], ids=["sinks through", "lands"])
def test_a_pipe_that_sinks_through_the_surface_is_reported(k: float, warned: bool, tmp_path: Path) -> None:
    """Contact as soft as that pushes it out below, with more energy than it took."""
    run(scene_from_mapping(falling_on_soil(k, 0.02, ELASTIC)), tmp_path)
    (stage,) = Run(tmp_path).summary["stages"]
    warnings = [warning for warning in stage["warnings"] if "sank through the soil's surface" in warning]
    assert len(warnings) == warned
    lost = stage["energy"]["dissipated_by"]
    assert lost["contact"] == 0.0
    given = -lost["contact_time_scheme"]
    assert lines_with(warnings, "contact with the soil", f"gave {given:.3g} J") == warnings
    assert (given > FALL_ON_SOIL) == warned


@pytest.mark.verify
@pytest.mark.parametrize("k", [1e5, 1e6, 1e7, 1e8, 1e9])
@LAWS
@WHERE
def test_impact_on_soil_gains_no_energy_at_any_step(k: float, law: Mapping, where: tuple[float, float]) -> None:
    for dt in (0.05, 0.02, 0.005):
        gains_nothing(k, dt, law, where)
