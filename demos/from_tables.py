"""Figures that sentences of the demos' pages take from the tables that long runs have written: no run is needed.

`make figures` writes them to their places, and a quick test compares them with the tables.
"""

from __future__ import annotations

import re

from demos.page import ROOT, block

DEMOS = ROOT / "demos"


def row(page: str, name: str, *first: str) -> list[str]:
    """Cells of the only row that begins with these cells, in the block of this name of a page of the demos."""
    text = block((DEMOS / page).read_text(encoding="utf-8"), name)
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("|")]
    (found,) = [cells for cells in rows if cells[: len(first)] == [*first]]
    return found


def numbers(page: str, name: str, *first: str) -> list[float]:
    """The first number of each of the cells after those."""
    return [float(re.findall(r"-?[\d.]+", cell)[0]) for cell in row(page, name, *first)[len(first) :] if cell]


def by_head(page: str, *first: str) -> dict[str, str]:
    """Cells of a cheap run's row by the heads of their columns."""
    return dict(zip(row(page, "cheap", "elements"), row(page, "cheap", *first), strict=True))


def table_figures() -> dict[str, str]:
    """All of them by their names."""
    return {**of_catenary(), **of_tank(), **of_trench(), **of_dug_trench(), **of_pipe_segment()}


def of_catenary() -> dict[str, str]:
    scene, graded = (by_head("catenary/convergence.md", *first) for first in (("35", "0.1"), ("73, graded",)))
    return {
        "catenary forces": percent(scene["error of forces"]),
        "catenary moment": percent(scene["error of M"]),
        "catenary seconds": scene["run s"],
        "catenary graded step": graded["step s"],
        "catenary graded seconds": graded["run s"],
    }


def of_tank() -> dict[str, str]:
    scene = by_head("tank/convergence.md", "200", "0.05")
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
        return numbers("trench/README.md", "trench", name)

    touchdown, rest = both("at rest: touchdown arc length [m]"), both("largest bending moment [kN m]")
    heave = [float(cell.split(" to ")[1]) for cell in row("trench/README.md", "trench", HEAVED)[1:]]
    return {
        "trench later": f"{touchdown[0] - touchdown[1]:.1f}",
        "trench smaller": f"{100.0 * (1.0 - rest[0] / rest[1]):.0f}",
        "trench larger": f"{100.0 * (heave[0] / heave[1] - 1.0):.0f}",
    }


HEAVED = "largest bending moment, in heave [kN m]"


def of_dug_trench() -> dict[str, str]:
    page = "dug_trench/README.md"
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
    page = "pipe_segment/README.md"
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
