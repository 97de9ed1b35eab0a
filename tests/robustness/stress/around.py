"""Stress around a scene: its extremes, each run in a process with limits and judged by bounds and by its neighbours.

    python -m tests.robustness.stress.around SCENE [-o FOLDER] [--limit SECONDS] [--jobs N]

Ends with status 1 where a run ends quietly wrong, broken or out of time.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from riser_soil.errors import RiserSoilError
from riser_soil.results.folder import write_atomically
from riser_soil.results.read import Run
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import read_scene
from riser_soil.scene.scene import Scene
from riser_soil.variants.key_results import key_results
from riser_soil.whole_run import run
from tests.robustness.limited_process import Ending, Job, Limits, ended, import_all
from tests.robustness.stress.bounds import Answer, between, bounds
from tests.robustness.stress.extremes import ExtremeScene, extremes, is_at_rest
from tests.robustness.stress.outcome import PASSED, REPORTED, StressOutcome, as_json, line_of, markdown, outcome

AT_REST = 1e-3  # of a key_result: what time steps without motion may change


@dataclass(frozen=True)
class StressedScene:
    """One of the scenes after its run. place: its folder."""

    extreme: ExtremeScene
    place: Path
    ending: Ending

    @property
    def run(self) -> Run | None:
        """Results of a run, where it left some."""
        folder = self.place / "scene"
        return Run(folder) if (folder / "summary.json").is_file() else None


def stress(
    scene: Scene, folder: Path, limits: Limits, jobs: int, command: str, says: Callable[[str], None]
) -> list[StressOutcome]:
    """Run all extremes of a scene, results to folders in `folder`, and tell each; table and figures go there, too."""
    import_all()
    places = [(extreme, folder / f"{n:02d}") for n, extreme in enumerate(extremes(scene))]
    with ThreadPoolExecutor(jobs) as pool:
        done = list(pool.map(lambda item: _run(item[0], item[1], limits), places))
    rows = [_judged(each, done) for each in done]
    for row in rows:
        says(line_of(row))
    write_atomically(folder / "stress.json", as_json(rows, command))
    write_atomically(folder / "stress.md", markdown(rows) + "\n")
    return rows


def _run(extreme: ExtremeScene, place: Path, limits: Limits) -> StressedScene:
    place.mkdir(parents=True, exist_ok=True)
    (place / "scene.yaml").write_text(dump_scene(extreme.scene), encoding="utf-8")
    return StressedScene(extreme, place, ended(running(["scene"]), place, limits))


def _judged(stressed: StressedScene, done: list[StressedScene]) -> StressOutcome:
    run, name = stressed.run, stressed.extreme.name
    runs = [] if run is None else [run]
    answers = list(_answers(stressed, done)) if run is not None and stressed.ending.finished else []
    row = outcome(name, "", stressed.ending, runs, answers, may_tell=_own_warnings(stressed, done[0]))
    return replace(row, as_hoped=row.verdict in (PASSED, REPORTED))


def _answers(stressed: StressedScene, done: list[StressedScene]) -> Iterator[Answer]:
    run, extreme = stressed.run, stressed.extreme
    assert run is not None
    yield from bounds(run)
    if is_at_rest(extreme):
        yield from _at_rest(run)
        return
    other = next((each for each in done if each.extreme.name == extreme.against), None)
    if other is None or other.run is None or not other.ending.finished or extreme.apart is None:
        return
    theirs = key_results(other.run.summary)
    for key, mine in key_results(run.summary).items():
        if key in theirs and mine.unit == "N":
            apart = theirs[key].error(mine)
            yield between(f"{key}, apart from that {other.extreme.name} [-]", apart, 0.0, extreme.apart)


def _at_rest(run: Run) -> Iterator[Answer]:
    """Dynamic stages without motion: their extremes are the static stage's values."""
    results = list(key_results(run.summary).values())
    statics, moving = (
        [stage["name"] for stage in run.summary["stages"] if (stage["kind"] == "static") is still]
        for still in (True, False)
    )
    before = {each.label: each for each in results if each.stage == statics[-1]}
    names = ("top tension", "force at end", "force at start")
    for now in results:
        if now.stage in moving and now.name in names and now.label in before:
            yield between(f"{now.key}, apart from rest [-]", before[now.label].error(now), 0.0, AT_REST)


def _own_warnings(stressed: StressedScene, base: StressedScene) -> str | None:
    """Pattern of the warnings that the scene as it is has not, by their first words; None without any."""
    known = {_begin(line) for line in _warnings(base.ending)} if stressed is not base else set()
    own = [line for line in _warnings(stressed.ending) if _begin(line) not in known]
    return "|".join(re.escape(line.strip()) for line in own) or None


def _warnings(ending: Ending) -> list[str]:
    return [line for line in ending.output.splitlines() if line.strip().startswith("warning:")]


def _begin(line: str) -> str:
    """A warning without its numbers."""
    return re.sub(r"[-+\d.e]+", "#", line)[:60]


def running(names: Sequence[str]) -> Job:
    """Run NAME.yaml in turn, results to folders NAME, up to the first that fails; its exit status."""

    def job() -> int:
        for name in names:
            try:
                run(read_scene(f"{name}.yaml"), Path(name), force=True)
            except RiserSoilError as err:
                print(err, file=sys.stderr)
                return err.exit_status
        return 0

    return job


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path)
    parser.add_argument("-o", "--output", type=Path, help="folder; else the scene's name and -stress")
    parser.add_argument("--limit", type=int, default=120, help="processor time that each run may take [s]")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time, each a process")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a change of the scene")
    asked = parser.parse_args(arguments)
    try:
        scene = read_scene(asked.scene, asked.set)
    except RiserSoilError as err:
        parser.error(str(err))
    folder = asked.output or Path(f"{asked.scene.stem}-stress")
    rows = stress(scene, folder, Limits(cpu=asked.limit), asked.jobs, f"around {asked.scene}", print)
    bad = [row.name for row in rows if not row.as_hoped]
    print(f"{len(rows)} runs; quietly wrong, broken or out of time: {'; '.join(bad) or 'none'}; tables are in {folder}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
