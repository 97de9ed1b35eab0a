"""Summary of a run, summary.json: what was built, how each stage ended, extremes and warnings."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.core.saved_state import Saved, Stateful, gathered, packed, restore_all, unpacked
from riser_soil.core.snapshot import RunFacts
from riser_soil.results.folder import SUMMARY, FolderLock, write_atomically
from riser_soil.results.stage_tally import StageTally


class Summary:
    """Keeps the whole summary and writes it. lines: their names, "" of the only one."""

    def __init__(self, facts: RunFacts, lines: Sequence[str] = ("",)) -> None:
        self.finished = False
        self.laying: dict[str, float] | None = None  # how a slack riser was laid before the stages
        self.stages: list[StageTally] = []
        self.seconds: Counter[str] = Counter()
        self.processor_seconds = math.nan  # until the run ends
        self._facts, self._lines = facts, lines

    def begin_stage(self, name: str, kind: str, automatic: bool = False) -> StageTally:
        """Arguments as of `StageTally`."""
        self.stages.append(StageTally(self._facts, name, kind, self._lines, automatic))
        return self.stages[-1]

    def as_dict(self) -> dict[str, Any]:
        """The summary as it goes into the file, before nan becomes null."""
        facts = self._facts
        return {
            "title": facts.title,
            "finished": self.finished,
            "version": facts.version,
            "versions": dict(facts.versions),
            "ranks": facts.ranks,
            "parts": {"built": list(facts.built), "left_out": dict(facts.left_out)},
            "dofs": {"riser": facts.riser_dofs, "soil": facts.soil_dofs},
            "warnings": list(facts.warnings),
            "stages": [stage.as_dict() for stage in self.stages],
            "seconds": dict(self.seconds),
            "processor_seconds": self.processor_seconds,
            **({"laying": self.laying} if self.laying is not None else {}),
        }

    def write(self, path: Path, lasting: bool = False) -> None:
        write_atomically(path, json.dumps(plain_json(self.as_dict()), indent=2, allow_nan=False) + "\n", lasting)

    def state(self) -> Saved:
        begun = [(stage.name, stage.kind, stage.automatic) for stage in self.stages]
        values = {"begun": begun, "laying": self.laying, "seconds": self.seconds}
        return gathered(self._numbered) | {"values": packed(values)}

    def restore(self, saved: Saved) -> None:
        values = unpacked(saved["values"])
        self.laying, self.seconds, self.stages = values["laying"], Counter(values["seconds"]), []
        for begun in values["begun"]:
            self.begin_stage(*begun)
        restore_all(self._numbered, saved)

    @property
    def _numbered(self) -> dict[str, Stateful]:
        return {str(n): stage for n, stage in enumerate(self.stages)}


def add_to_summary(folder: Path, blocks: Mapping[str, Any]) -> None:
    """Add blocks to the summary of a finished run."""
    summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8")) | blocks
    with FolderLock(folder):
        write_atomically(folder / SUMMARY, json.dumps(plain_json(summary), indent=2, allow_nan=False) + "\n")


def plain_json(value: Any) -> Any:
    """A value in JSON's terms: plain numbers; null for nan and infinities, which JSON lacks."""
    if isinstance(value, Mapping):
        return {str(key): plain_json(v) for key, v in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain_json(v) for v in value]
    if isinstance(value, np.generic):
        return plain_json(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
