"""The pool of runs on this machine."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event
from typing import Any

import pytest

from riser_soil.errors import WriteError
from riser_soil.variants import pool
from riser_soil.variants.pool import Workers, outcomes
from riser_soil.variants.runs_folder import Outcome


def test_no_run_is_wanted_once_one_has_found_the_disk_full(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever time its caller takes to close the pool."""
    asked, was_asked = list[bool](), Event()

    def run(task: dict[str, Any], wanted: Callable[[], bool]) -> dict[str, Any]:
        asked.append(wanted())
        if task["name"] == "second":
            was_asked.set()
        return Outcome(task["name"], "key", WriteError.exit_status, "full").as_dict()

    monkeypatch.setattr(pool, "run_variant", run)
    results = outcomes([{"name": "first"}, {"name": "second"}], Workers(1), lambda: None)
    assert next(results).name == "first"
    assert was_asked.wait(10.0)
    results.close()
    assert asked == [True, False]
