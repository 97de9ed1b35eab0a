"""The table of outputs: a quantity is one entry, and the pages say the same of it."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from riser_soil.core import outputs
from riser_soil.core.output import OutputQuantity
from riser_soil.core.step_outputs import OF_STEP
from riser_soil.plots.curves import ALONG_ARC
from riser_soil.plots.scales import SHOWN
from riser_soil.results import Run
from riser_soil.results.netcdf import HEALTH, SERIES
from tests.support.on_ranks import HANGS, ROOT, environment
from tests.support.pages import text
from tests.support.run_with_toys import HEIGHT, SETTLEMENT, WHOLE_ENERGY
from tests.support.vtk_reading import read_by_vtk

OF_INSTANT: list[OutputQuantity[Any]] = [*outputs.of_instant()]
TABLE: list[OutputQuantity[Any]] = [*OF_INSTANT, *outputs.OF_SOIL]


@pytest.fixture(scope="module")
def toys(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Folder and screen of the runs whose table has one entry more along the riser, of the soil and of the steps."""
    folder = tmp_path_factory.mktemp("toys")
    call = [sys.executable, str(ROOT / "tests/support/run_with_toys.py"), str(folder)]
    done = subprocess.run(call, env=environment(), capture_output=True, text=True, timeout=HANGS, check=False)
    assert done.returncode == 0, done.stderr
    return folder, done.stdout


def test_a_new_entry_is_a_choice_of_the_scene(toys: tuple[Path, str]) -> None:
    schema = json.loads((toys[0] / "schema.json").read_text(encoding="utf-8"))
    fields = schema["$defs"]["Output"]["properties"]["fields"]
    behind = 1 + len(outputs.OF_SOIL)  # across the riser, and of the soil
    names = [*outputs.choices()[:-behind], HEIGHT.name, *outputs.choices()[-behind:], SETTLEMENT.name]
    assert fields["items"]["enum"] == fields["default"] == names
    assert "fields: [height]" in (toys[0] / "solved" / "scene.yaml").read_text(encoding="utf-8")


def test_a_new_entry_is_in_the_files_with_its_unit_and_text(toys: tuple[Path, str]) -> None:
    run, (times, frames) = Run(toys[0] / "solved"), read_by_vtk(toys[0] / "solved" / "riser.xdmf")
    np.testing.assert_array_equal(run["height"], run["position"][..., 2])
    np.testing.assert_array_equal(frames[-1]["point:height"], run["height"][-1])
    assert times == run.time.tolist()
    with h5py.File(run.folder / "results.nc") as file:
        assert set(file) & {*outputs.choices(), "height"} == {"height"}
        attributes = {name: file["height"].attrs[name] for name in ("units", "long_name", "sign_convention")}
        assert attributes == {"units": HEIGHT.units, "long_name": HEIGHT.text, "sign_convention": HEIGHT.sign}
        assert file["stored_energy"].attrs["long_name"] == WHOLE_ENERGY.text
        assert file["stored_energy"].shape == file["step"].shape


def test_a_new_entry_of_the_soil_is_in_its_frames(toys: tuple[Path, str]) -> None:
    fields = Run(toys[0] / "told").soil_frame().fields
    np.testing.assert_array_equal(fields["settlement"], -fields["displacement"][:, 2])


def test_a_new_entry_is_in_the_summary_with_its_extremes_and_on_the_screen(toys: tuple[Path, str]) -> None:
    run, (stage,) = Run(toys[0] / "solved"), Run(toys[0] / "solved").summary["stages"]
    highest = run["height"][-1].argmax()
    assert stage["final"]["max_height"] == {"value": run["height"][-1, highest], "arc": run.arc[highest]}
    assert list(stage["final"])[-2:] == ["contact_force", "max_height"]
    assert stage["extremes"]["max_height"]["max"] == run["height"][-1, highest]
    row = rf"greatest height +│ +{1e-3 * run['height'][-1, highest]:.5g} km at {run.arc[highest]:.5g} m"
    assert re.search(row, toys[1])
    heave = Run(toys[0] / "told").summary["stages"][1]["extremes"]["max_height"]
    assert heave["max"] == Run(toys[0] / "told")["height"].max() > heave["min"]


PREFIXES = {"k": 1e3, "M": 1e6, "m": 1e-3}


def of_si(unit: str, si: str) -> float:
    """How many of a unit are one of SI, by its prefix."""
    return 1.0 / PREFIXES[unit[0]] if unit[1:] == si else 1.0


def test_figures_are_reported_in_the_units_that_stand_beside_them() -> None:
    spelt = {"N m-1": "N/m", "m-1": "1/m", "1": "-", "degree": "°"}
    rows = [(output.units, each.row) for output in TABLE for each in output.figures if each.row is not None]
    assert len(rows) > 15
    for units, row in rows:
        si = spelt.get(units, units)
        assert row.scale == pytest.approx(of_si(row.unit, si)), row
    for units, (unit, factor) in SHOWN.items():
        assert factor == pytest.approx(of_si(unit, spelt.get(units, units)))
        assert unit.endswith(spelt.get(units, units))
    for name, (words, factor) in ALONG_ARC.items():
        (si,) = (spelt.get(output.units, output.units) for output in TABLE if output.name == name)
        assert factor == pytest.approx(of_si(re.findall(r"\[(.*)\]", words)[0], si)), words


def test_names_of_the_table_are_unique() -> None:
    names = [*(output.name for output in TABLE), *(output.name for output in OF_STEP)]
    figures = [figure.name for _, figure in outputs.figures(())]
    figures += [figure.name for output in outputs.OF_SOIL for figure in output.figures]
    assert (len(names), len(figures)) == (len(set(names)), len(set(figures)))


def test_files_have_what_the_table_has() -> None:
    written = [output.name for output in OF_INSTANT if output.where != "summary"]
    assert list(SERIES) == ["time", "stage", *written]
    assert list(HEALTH) == ["step", "step_time", "step_stage", *(output.name for output in OF_STEP)]


def test_pages_give_the_table_s_symbols_and_units() -> None:
    """Symbols and units of the results in the table of docs/conventions.md; one unit there may serve several words."""
    table = text(ROOT / "docs/conventions.md").split("| word | symbol | unit | meaning |")[1].split("\n\n")[0]
    known = {output.name: output for output in TABLE}
    listed = set()
    for row in table.splitlines()[2:]:
        words, symbols, units = ([*re.split(", ?", cell.strip())] for cell in row.split("|")[1:4])
        names = [word.strip("`") for word in words]
        for place, name in enumerate(names):
            if name in known:
                output = known[name]
                assert _page_s(output.units) == units[min(place, len(units) - 1)], name
                assert output.symbol == (symbols[place] if len(symbols) == len(names) else ""), name
                listed.add(name)
    assert listed >= set(outputs.choices()) - {"wall_tension", "moment_vector", "displacement"}


def _page_s(units: str) -> str:
    """A unit of results.nc as the pages write it."""
    return {"1": "–", "N m": "N.m", "m-1": "1/m", "N m-1": "N/m"}.get(units, units)
