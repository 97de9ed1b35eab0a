"""Figures that pages take from the tables that long runs have written, there or on other pages: no run is needed.

`make figures` writes them to their places, and a quick test compares them with the tables.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Iterator

from demos.page import ROOT, block, table


def block_of(page: str, name: str) -> list[str]:
    """Lines of the block of this name of a page."""
    return block((ROOT / page).read_text(encoding="utf-8"), name).splitlines()


def row(page: str, name: str, *first: str) -> list[str]:
    """Cells of the only row that begins with these cells, in the block of this name of a page."""
    lines = (line for line in block_of(page, name) if line.startswith("|"))
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]
    (match,) = [cells for cells in rows if cells[: len(first)] == [*first]]
    return match


def numbers(page: str, name: str, *first: str) -> list[float]:
    """The first number of each of the cells after those."""
    return [float(re.findall(r"-?[\d.]+", cell)[0]) for cell in row(page, name, *first)[len(first) :] if cell]


def by_head(page: str, *first: str, name: str = "cheap", head: str = "elements") -> dict[str, str]:
    """Cells of a row by the heads of their columns; head: that of the first."""
    return dict(zip(row(page, name, head), row(page, name, *first), strict=True))


def table_figures() -> dict[str, str]:
    """All of them by their names."""
    demos = {**of_catenary(), **of_tank(), **of_trench(), **of_dug_trench(), **of_pipe_segment()}
    return {**demos, **of_peers(), **of_clay(), **of_vortices(), **of_soil_precision(), **of_quality()}


def of_catenary() -> dict[str, str]:
    scene, graded = (by_head("demos/catenary/convergence.md", *first) for first in (("35", "0.1"), ("73, graded",)))
    return {
        "catenary forces": percent(scene["error of forces"]),
        "catenary moment": percent(scene["error of M"]),
        "catenary seconds": scene["run s"],
        "catenary graded step": graded["step s"],
        "catenary graded seconds": graded["run s"],
        **beside_published(),
    }


def beside_published() -> dict[str, str]:
    """The riser at rest with the implied weight beside the published rows: forces in per cent, angles in degrees."""

    def at_rest(*first: str) -> dict[str, float]:
        cells = by_head("demos/catenary/README.md", *first, name="table1", head="")
        return {name: float(cells[f"{name} {unit}"]) for name, unit in OF_TABLE_1.items()}

    ours, first, second = (
        at_rest(*row)
        for row in (("riser_soil, 560 elements", "364.2"), ("Yazdchi & Crisfield (2002)",), ("da Silva et al. (2017)",))
    )
    forces = {name: 100.0 * abs(ours[name] / first[name] - 1.0) for name in ("V1", "V2", "H1", "H2")}
    vertical = (100.0 * abs(ours[name] / second[name] - 1.0) for name in ("V1", "V2"))
    below = (f"{100.0 * (1.0 - second[name] / ours[name]):.1f}" for name in ("H1", "H2"))
    return {
        "catenary forces first": f"{max(forces.values()):.2f}",
        "catenary theta1 first": f"{abs(ours['theta1'] - first['theta1']):.2f}",
        "catenary theta2 first": f"{abs(ours['theta2'] - first['theta2']):.2f}",
        "catenary V second": f"{max(vertical):.2f}",
        "catenary theta2 second": f"{abs(ours['theta2'] - second['theta2']):.2f}",
        "catenary H second": " and ".join(below),
    }


OF_TABLE_1 = {"V1": "kN", "V2": "kN", "H1": "kN", "H2": "kN", "theta1": "deg", "theta2": "deg"}


def of_tank() -> dict[str, str]:
    scene = by_head("demos/tank/convergence.md", "200", "0.05")
    return {
        "tank seconds": scene["run s"],
        "tank tensions": percent(scene["error of forces"]),
        "tank moment": percent(scene["of M"]),
        "tank touchdown": f"{1e3 * float(scene['of touchdown m']):.1f}",
        **of_seabeds(),
        **{f"tank by {method}": of_method(method) for method in ("line", "node")},
    }


def of_seabeds() -> dict[str, str]:
    """How the hose swings on its rigid floor, and what other seabeds change."""
    page = "demos/tank/README.md"
    heads = row(page, "seabeds", "seabed")[1:]
    rigid, springs, clay = (
        dict(zip(heads, numbers(page, "seabeds", name), strict=True)) for name in ("rigid", "springs", "clay")
    )
    low, high = rigid["top min N"], rigid["top max N"]
    return {
        "tank swing": f"{100.0 * (high - low) / (high + low):.1f}",
        "tank bottom": f"{rigid['bottom max N'] / rigid['bottom min N']:.1f}",
        "tank travel": f"{rigid['touchdown max m'] - rigid['touchdown min m']:.2f}",
        "tank springs": f"{100.0 * (1.0 - springs['M max N.m'] / rigid['M max N.m']):.1f}",
        "tank digs": f"{clay['deepest mm'] / clay['sunk at rest mm']:.1f}",
    }


def of_method(method: str) -> str:
    """Error of H with 200 elements by a method of contact, on either stiffness the larger."""
    cells = (row("demos/tank/README.md", "at_rest_mesh", method, k, "200")[3] for k in ("1e+06", "1e+08"))
    return f"{max(abs(float(cell)) for cell in cells):.1e}"


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
    behind, fitted = numbers(page, "fits", "closed form, smooth, `soil.law.su`")[:2]
    return {
        "pipe coarse": beside(coarse[2:], smooth[2:]),
        "pipe fine": beside(fine[2:], smooth[2:]),
        "pipe small strain": f"{small[2] / fine[2]:.1f}",
        "pipe law 1": f"{100.0 * (laws[0][0] / own[0] - 1.0):.0f}",
        "pipe law 2": f"{100.0 * (laws[1][0] / own[0] - 1.0):.0f}",
        "pipe laws far": " and ".join(f"{100.0 * (law[3] / own[3] - 1.0):.0f}" for law in laws),
        "pipe su": f"{100.0 * (fitted / behind - 1.0):.0f}",
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


CALCULIX = {name: f"CalculiX, C3D8{name}" for name in ("I", "R")}


def of_clay() -> dict[str, str]:
    """CalculiX's elements beside riser_soil on a pipe pressed into clay, mesh by mesh."""
    meshes = list(dict.fromkeys(line.split("|")[1].strip() for line in block_of("docs/peers.md", "clay")[2:]))
    rows = {who: [clay_row(mesh, who) for mesh in meshes[:-1]] for who in ("riser_soil", *CALCULIX.values())}
    ours = [each["processor s"] for each in rows["riser_soil"]]
    costs = {
        name: [theirs["processor s"] / own for theirs, own in zip(rows[who], ours, strict=True)]
        for name, who in CALCULIX.items()
    }
    off = {name: [each["off riser_soil"] for each in rows[who]] for name, who in CALCULIX.items()}
    return {
        "peers clay off": f"{max(off['I']):.1f}",
        "peers clay off the finest": listed(f"{each['off the finest']:.1f}" for each in rows["riser_soil"]),
        **{f"peers clay cost {name}": listed(f"{each:.2g}" for each in cost) for name, cost in costs.items()},
        "peers clay off R": f"{min(off['R']):.1f} to {max(off['R']):.1f}",
    }


def clay_row(mesh: str, who: str) -> dict[str, float]:
    """Cells that have a number, by their heads."""
    heads, cells = (row("docs/peers.md", "clay", *first)[2:] for first in (("mesh, unknowns",), (mesh, who)))
    return {head: float(cell.removesuffix(" %")) for head, cell in zip(heads, cells, strict=True) if cell != "–"}


def listed(words: Iterable[str]) -> str:
    """`a, b and c`."""
    *most, last = words
    return f"{', '.join(most)} and {last}"


def of_vortices() -> dict[str, str]:
    """How far programs are apart in an upright riser shaken by its vortices, and what its drag grows to."""
    cells = ([float(cell) for cell in line.split("|")[2:6]] for line in block_of("docs/peers.md", "vortices")[2:])
    hertz, largest, along, sag = zip(*cells, strict=True)
    apart = max(100.0 * (max(each) / min(each) - 1.0) for each in (hertz, largest, along))
    return {
        "vortices apart": f"{apart:.1f}",
        "vortices drag": f"{sag[0]:.2f}",
        "vortices by Vandiver": f"{1.0 + 1.043 * (math.sqrt(2.0) * along[0]) ** 0.65:.1f}",
    }


def of_soil_precision() -> dict[str, str]:
    """Errors and processor seconds by method, of docs/soil_precision.csv."""
    with (ROOT / "docs/soil_precision.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))

    def of(scene: str, method: str, figure: str, column: str = "error") -> dict[int, float]:
        """Table by the number of cells to a diameter."""
        asked = (scene, method, figure, "relative")
        matches = (row for row in rows if tuple(row[key] for key in ("scene", "method", "figure", "norm")) == asked)
        return {int(row["cells to a diameter"]): float(row[column]) for row in matches}

    def seconds(scene: str, method: str) -> dict[int, float]:
        return of(scene, method, "trench depth", "processor s")

    small = of("pushed", "small strain", CAPACITY).values()
    half, whole, tets = (seconds("laid", method) for method in ("large strain", "whole", "tetrahedra"))
    halves = [half[n] / whole[n] for n in whole]
    condensed, kept = (seconds("elastic", method) for method in ("condensed", "kept"))
    on_clay = {**{"kept": half}, **{method: seconds("laid", method) for method in ("direct", "iterative")}}
    return {
        "precision small": f"{100.0 * min(small):.0f} to {100.0 * max(small):.0f}",
        "precision trench": f"{1.0 + max(of('laid', 'small strain', 'trench depth').values()):.1f}",
        "precision nodes": f"{min(n for n, error in of('pushed', 'nodes', CAPACITY).items() if math.isinf(error))}",
        "precision tet": f"{100.0 * of('pushed', 'tetrahedra', CAPACITY)[4]:.0f}",
        "precision tet s": f"{tets[3]:.0f}",
        "precision tet trench": f"{100.0 * of('laid', 'tetrahedra', 'trench depth')[3]:.0f}",
        "precision hex s": f"{half[4]:.0f}",
        "precision hex trench": f"{100.0 * of('laid', 'large strain', 'trench depth')[4]:.0f}",
        "precision half": f"{min(halves):.2f} to {max(halves):.2f}",
        "precision condensed": f"{condensed[max(kept)] / kept[max(kept)]:.2f}",
        "precision on clay": listed(f"{on_clay[method][12]:.0f}" for method in ("direct", "kept", "iterative")),
    }


CAPACITY = "capacity at 0.2 D"


def of_quality() -> dict[str, str]:
    """Figures of error bars, accuracies asked and stress cases."""
    scenes, judged = row("docs/error_bars.md", "error bars out of sample", "scenes, key results judged")[1].split(", ")
    inside = row("docs/error_bars.md", "error bars out of sample", "true error inside its bar")[1].removesuffix("%")
    asked = "\n".join(block_of("docs/asked_accuracy.md", "asked accuracy"))
    match = re.search(r"of all (\d+) scenes \((\d+) say that they do not reach it\) \| ([\d.]+)%", asked)
    assert match, asked
    cases = block_of("docs/quality.md", "stress")[2].split("|")[1]
    return {
        "bars scenes": scenes,
        "bars judged": judged,
        "bars inside": inside,
        "asked scenes": match[1],
        "asked not": match[2],
        "asked reached": f"{int(match[1]) * float(match[3]) / 100.0:.0f}",
        "stress cases": cases.strip(),
    }
