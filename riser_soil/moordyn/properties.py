"""Types of lines and rods of a deck as line types of a scene."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

from riser_soil.imported_scene import Remark, twisting_stiffness
from riser_soil.moordyn.deck import Deck, DeckRow, as_number
from riser_soil.moordyn.nodes import Piece
from riser_soil.scene.problem import Path

STEEL = 2.1e11  # Pa: Young's modulus of the bar that stands for a rod
STIFFER = 10.0  # over the stiffest line's: the least of a rod


def type_of(deck: Deck, row: DeckRow) -> DeckRow:
    """Row of a line's type, or of a rod's; SceneError where the deck lacks it."""
    section, column = ("line types", "LineType") if "LineType" in row else ("rod types", "RodType")
    for each in deck.of(section):
        if each["Name"] == row[column]:
            return each
    known = ", ".join(each["Name"] for each in deck.of(section))
    kind = section.removesuffix("s")
    raise deck.error(row.line, f"{kind} {row[column]} is not among the {section.upper()} ({known}); correct the name")


def type_name(piece: Piece) -> str:
    """Name of the scene's line type."""
    return piece.row["LineType"] if piece.section == "lines" else f"rod_{piece.row['RodType']}"


def diameter(deck: Deck, line: DeckRow) -> float:
    """Diam of a line [m]."""
    return deck.number(type_of(deck, line), "Diam")


def bends(deck: Deck, piece: Piece) -> bool:
    """Whether a rod, or a line with a bending stiffness."""
    row = type_of(deck, piece.row)
    return "EA" not in row or ("EI" in row and as_number(row["EI"]) != 0.0)


def net_weight(deck: Deck, piece: Piece, rho: float) -> float:
    """Mass per length less that of the water displaced [kg/m]."""
    row = type_of(deck, piece.row)
    return deck.number(row, "Mass/m") - rho * math.pi / 4.0 * deck.number(row, "Diam") ** 2


def line_types(deck: Deck, pieces: Iterable[Piece]) -> tuple[dict[str, Any], list[Remark], dict[Path, int]]:
    """Line types of lines and rods, remarks, and the deck's line of each type."""
    types, remarks, origins = dict[str, Any](), list[Remark](), dict[Path, int]()
    rows = {type_name(piece): type_of(deck, piece.row) for piece in pieces}
    for name, row in sorted(rows.items(), key=lambda item: "EA" not in item[1]):
        types[name] = _line_type(deck, row) if "EA" in row else _rod_type(deck, row, types)
        remarks += [(row.line, about) for about in (_about(deck, row) if "EA" in row else _about_rod(row))]
        origins[("line_types", name)] = row.line
    return types, remarks, origins


def stiffen_in_torsion(deck: Deck, types: dict[str, Any]) -> Remark:
    """Give all types GJ, which lines in space need."""
    for each in types.values():
        each["GJ"] = twisting_stiffness(each["EI"], each["EA"], each["outer_diameter"])
    line = deck.of("line types")[0].line
    return line, "GJ, which MoorDyn does not know: as EI, or small where there is none"


def _line_type(deck: Deck, row: DeckRow) -> dict[str, Any]:
    stiffness = {"EA": row["EA"].split("|")[0], "EI": row.cells.get("EI", "0")}
    for key, word in stiffness.items():
        if as_number(word) is None:
            raise deck.error(row.line, f"{key} of {row['Name']} is {word!r}, a curve from a file; give one number")
    EA, EI = (deck.parsed(row, word, key) for key, word in stiffness.items())
    return {
        "outer_diameter": deck.number(row, "Diam"), "mass": deck.number(row, "Mass/m"), "EA": EA, "EI": EI,
        "drag": {"normal": deck.number(row, "Cd"), "tangential": deck.number(row, "CdAx")},
        "added_mass": {"normal": deck.number(row, "Ca"), "tangential": deck.number(row, "CaAx")},
    }  # fmt: skip


def _about(deck: Deck, row: DeckRow) -> Iterator[str]:
    name = row["Name"]
    if "|" in row["EA"]:
        yield f"EA {row['EA']} of {name}: the first alone, for all loads"
    if "BA/-zeta" in row and as_number(row["BA/-zeta"]) != 0.0:
        damps = "axial damping alone; `damping` of a line type would damp bending, too"
        yield f"BA/-zeta {row['BA/-zeta']} of {name}: {damps}"
    if "Cl" in row and deck.number(row, "Cl") != 0.0:
        yield f"Cl {row['Cl']} of {name}: vortex-induced vibration"


def _rod_type(deck: Deck, row: DeckRow, lines: dict[str, Any]) -> dict[str, Any]:
    D = deck.number(row, "Diam")
    EA, EI = (max(each[key] for each in lines.values()) for key in ("EA", "EI"))
    return {
        "outer_diameter": D, "mass": deck.number(row, "Mass/m"),
        "EA": max(STIFFER * EA, STEEL * math.pi / 4.0 * D**2), "EI": max(STIFFER * EI, STEEL * math.pi / 64.0 * D**4),
        "drag": {"normal": deck.number(row, "Cd")}, "added_mass": {"normal": deck.number(row, "Ca")},
    }  # fmt: skip


def _about_rod(row: DeckRow) -> Iterator[str]:
    yield f"rods of {row['Name']} are rigid; they are stiff pieces of the riser here, as a bar of steel at least"
    yield from about_ends(row)


def about_ends(row: DeckRow) -> Iterator[str]:
    """Remarks on properties of a rod type's ends."""
    for column in ("CdEnd", "CaEnd"):
        if column in row and as_number(row[column]) != 0.0:
            yield f"{column} {row[column]} of {row['Name']}: drag and added mass of a rod's ends"
