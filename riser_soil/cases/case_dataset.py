"""Table of cases as a dataset: cases.nc, which xarray and any reader of netCDF-4 open."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray

from riser_soil import __version__
from riser_soil.cases.case_table import CaseTable


def dataset(table: CaseTable) -> xarray.Dataset:
    """Dimension `case`: its name; `set_…`, what it differs in from the base scene; status, reason, seconds; a variable
    for each quantity, nan where a case failed.
    """
    names = [case.name for case in table.cases]
    outcomes = [table.outcomes[name] for name in names]
    variables: dict[str, Any] = {
        "status": ("case", np.array([o.status for o in outcomes], "i4"), {"long_name": "exit status; 0 is done"}),
        "reason": ("case", _texts([o.reason for o in outcomes]), {"long_name": "why a case failed"}),
        "seconds": ("case", [o.seconds for o in outcomes], {"units": "s", "long_name": "from its start to its end"}),
    }
    for path in table.paths:
        given = _given([case.values.get(path) for case in table.cases])
        variables[_identifier(f"set_{path}")] = ("case", given, {"long_name": path})
    for key, value in table.quantities.items():
        told = {"units": value.unit.replace(".", " "), "long_name": value.name, "stage": value.stage}
        told |= {"sign_convention": value.sign} if value.sign else {}
        variables[_identifier(key)] = ("case", table.column(key), told)
    about = {"title": table.title, "source": f"riser_soil {__version__}", "Conventions": "CF-1.11"}
    return xarray.Dataset(variables, {"case": ("case", _texts(names), {"long_name": "name of the case"})}, about)


def _given(values: Sequence[Any]) -> Any:
    """Numbers as such, nan where the base scene's holds; what is not all numbers as text."""
    if all(value is None or (isinstance(value, int | float) and not isinstance(value, bool)) for value in values):
        return np.array([np.nan if value is None else value for value in values], "f8")
    return _texts(["" if v is None else v if isinstance(v, str) else json.dumps(v, ensure_ascii=False) for v in values])


def _texts(values: Sequence[str]) -> Any:
    return np.array(values, dtype=object)


def _identifier(text: str) -> str:
    """`heave_top_tension_mean`."""
    return re.sub(r"\W+", "_", text).strip("_")
