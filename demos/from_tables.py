"""Figures that pages take from the tables that long runs have written, there or on other pages: no run is needed.

`make figures` writes them to their places, and a quick test compares them with the tables.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from demos.page import ROOT, block, table


def row(page: str, name: str, *first: str) -> list[str]:
    """Cells of the only row that begins with these cells, in the block of this name of a page."""
    text = block((ROOT / page).read_text(encoding="utf-8"), name)
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("|")]
    (found,) = [cells for cells in rows if cells[: len(first)] == [*first]]
    return found


def numbers(page: str, name: str, *first: str) -> list[float]:
    """The first number of each of the cells after those."""
    return [float(re.findall(r"-?[\d.]+", cell)[0]) for cell in row(page, name, *first)[len(first) :] if cell]


def by_head(page: str, *first: str, name: str = "cheap", head: str = "elements") -> dict[str, str]:
    """Cells of a row by the heads of their columns; head: that of the first."""
    return dict(zip(row(page, name, head), row(page, name, *first), strict=True))


def table_figures() -> dict[str, str]:
    """All of them by their names."""
    demos = {**of_catenary(), **of_tank(), **of_trench(), **of_dug_trench(), **of_pipe_segment()}
    return {**demos, **of_peers(), **of_quality()}


def of_catenary() -> dict[str, str]:
    scene, graded = (by_head("demos/catenary/convergence.md", *first) for first in (("35", "0.1"), ("73, graded",)))
    return {
        "catenary forces": percent(scene["error of forces"]),
        "catenary moment": percent(scene["error of M"]),
        "catenary seconds": scene["run s"],
        "catenary graded step": graded["step s"],
        "catenary graded seconds": graded["run s"],
    }


def of_tank() -> dict[str, str]:
    scene = by_head("demos/tank/convergence.md", "200", "0.05")
    return {
        "tank seconds": scene["run s"],
        "tank tensions": percent(scene["error of forces"]),
        "tank moment": percent(scene["of M"]),
        "tank touchdown": f"{1e3 * float(scene['of touchdown m']):.1f}",
    }


def percent(cell: str) -> str:
    """The number of `0.120 %`."""
    return f"{float(cell.removesuffix(' %')):g}"


def of_trench() -> dict[str, str]:
    def both(name: str) -> list[float]:
        return numbers("demos/trench/README.md", "trench", name)

    touchdown, rest = both("at rest: touchdown arc length [m]"), both("largest bending moment [kN m]")
    heave = [float(cell.split(" to ")[1]) for cell in row("demos/trench/README.md", "trench", HEAVED)[1:]]
    return {
        "trench later": f"{touchdown[0] - touchdown[1]:.1f}",
        "trench smaller": f"{100.0 * (1.0 - rest[0] / rest[1]):.0f}",
        "trench larger": f"{100.0 * (heave[0] / heave[1] - 1.0):.0f}",
    }


HEAVED = "largest bending moment, in heave [kN m]"


def of_dug_trench() -> dict[str, str]:
    page = "demos/dug_trench/README.md"
    laid, first, second = numbers(page, "depth", "deepest [mm]")
    arcs = numbers(page, "depth", "touchdown arc length [m]")
    storms = [row(page, "fatigue", name) for name in ("first, on clay as laid", "second, in the trench")]
    damage, bar = (float(each) for each in storms[0][1].split(" ± "))
    moved = float(storms[0][2]) - float(storms[1][2])
    return {
        "dug first": f"{first - laid:.0f}",
        "dug second": f"{second - first:.0f}",
        "dug away first": f"{arcs[0] - arcs[1]:.0f}",
        "dug away second": f"{arcs[1] - arcs[2]:.0f}",
        "dug less": f"{100.0 * (1.0 - numbers(page, 'fatigue', 'second over first')[0]):.0f}",
        "dug bars": f"{100.0 * bar / damage:.0f}",
        "dug scatter": " and ".join(storm[3].removesuffix("%") for storm in storms),
        "dug moved": f"{moved:.0f}",
        "dug sections": row(page, "fatigue", "the same, section by section")[1],
    }


def of_pipe_segment() -> dict[str, str]:
    page = "demos/pipe_segment/README.md"
    coarse, fine, small, smooth = (
        numbers(page, "capacity", name)
        for name in ("segment, cells of D/16", "segment, cells of D/32", "segment, D/16, small strain",
                     "Merifield et al., smooth")
    )  # fmt: skip
    own, *laws = (numbers(page, "stiffness", name) for name in ("segment", "randolph-quiggin", "aubeny-biscontin"))
    behind, told = numbers(page, "fits", "closed form, smooth, `soil.law.su`")[:2]
    return {
        "pipe coarse": beside(coarse[2:], smooth[2:]),
        "pipe fine": beside(fine[2:], smooth[2:]),
        "pipe small strain": f"{small[2] / fine[2]:.1f}",
        "pipe law 1": f"{100.0 * (laws[0][0] / own[0] - 1.0):.0f}",
        "pipe law 2": f"{100.0 * (laws[1][0] / own[0] - 1.0):.0f}",
        "pipe laws far": " and ".join(f"{100.0 * (law[3] / own[3] - 1.0):.0f}" for law in laws),
        "pipe su": f"{100.0 * (told / behind - 1.0):.0f}",
    }


def beside(values: list[float], others: list[float]) -> str:
    """How far values lie below and above others, in per cent."""
    off = [100.0 * (a / b - 1.0) for a, b in zip(values, others, strict=True)]
    return f"{-min(off):.0f} % below to {max(off):.0f} % above"


OTHERS = ("Exudyn", "CableDyn, tolerance 1e-4", "MoorDyn")


def of_peers() -> dict[str, str]:
    """What others cost over what riser_soil costs, by accuracy; how far its finest runs are off what all agree on."""
    rows = [*cheaper("catenary", "surge"), *cheaper("tank", "hose in a tank")]
    head = ["costs, over those of riser_soil with graded elements", *OTHERS]
    head += [f"the cheapest of them, over riser_soil {how}" for how in ("with equal elements", "by SNES")]
    off = (row("docs/peers.md", f"{name} finest", "riser_soil, compiled")[-1] for name in ("catenary", "tank"))
    return {
        "peers cheaper": table(head, rows),
        "peers at 1 %": " to ".join(sorted(times_at_one(rows), key=float)),
        **dict(zip(("peers off in surge", "peers off in the tank"), off, strict=True)),
    }


def cheaper(name: str, case: str) -> Iterator[list[str]]:
    """A row for each accuracy that riser_soil reaches in all ways."""
    graded, equal, by_snes = (costs_of(name, f"riser_soil, {how}") for how in ("compiled, graded", "compiled", "SNES"))
    others = [costs_of(name, who) for who in OTHERS]
    for accuracy, cost in graded.items():
        theirs = [other.get(accuracy) for other in others]
        least = min(each for each in theirs if each is not None)
        ours = (times(least / own[accuracy]) for own in (equal, by_snes))
        yield [f"{case}, {accuracy}", *("–" if each is None else times(each / cost) for each in theirs), *ours]


def costs_of(name: str, who: str) -> dict[str, float]:
    """Processor seconds per simulated second by the accuracy, where it is reached."""
    cells = by_head("docs/peers.md", who, name=f"{name} cost", head="processor seconds per simulated second")
    return {at: float(cell.split(" (")[0]) for at, cell in cells.items() if "%" in at and cell != "–"}


def times_at_one(rows: list[list[str]]) -> list[str]:
    """What the cheapest of the others costs, over riser_soil with graded elements, at an error of 1 %."""
    return [min(set(cells[:3]) - {"–"}, key=float) for name, *cells in rows if name.endswith(", 1 %")]


def times(ratio: float) -> str:
    return f"{ratio:.2g}"


def of_quality() -> dict[str, str]:
    """Of error bars, accuracies asked and stress cases."""
    scenes, judged = row("docs/error_bars.md", "error bars out of sample", "scenes, key results judged")[1].split(", ")
    inside = row("docs/error_bars.md", "error bars out of sample", "true error inside its bar")[1].removesuffix("%")
    asked = block((ROOT / "docs/asked_accuracy.md").read_text(encoding="utf-8"), "asked accuracy")
    found = re.search(r"of all (\d+) scenes \((\d+) say that they do not reach it\) \| ([\d.]+)%", asked)
    assert found, asked
    cases = block((ROOT / "docs/quality.md").read_text(encoding="utf-8"), "stress").splitlines()[2].split("|")[1]
    return {
        "bars scenes": scenes,
        "bars judged": judged,
        "bars inside": inside,
        "asked scenes": found[1],
        "asked not": found[2],
        "asked reached": f"{int(found[1]) * float(found[3]) / 100.0:.0f}",
        "stress cases": cases.strip(),
    }
