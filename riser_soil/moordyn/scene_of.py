"""A scene from a deck, and what of the deck it does not have, line by line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from riser_soil.imported_scene import ImportedScene, Remark, friction
from riser_soil.moordyn.deck import COUPLED, Chain, Deck, DeckRow, chain_with, elsewhere, is_free, place, point

DEFAULTS = {"g": 9.81, "rho": 1025.0, "wtrdpth": 0.0, "kbot": 3.0e6, "frictioncoefficient": 0.0}
ALONG_AND_ACROSS = ("mu_ka", "mu_kt")  # in MoorDyn-F in the place of one coefficient of friction
ALIASES = {"rhow": "rho", "gravity": "g", "depth": "wtrdpth", "mc": "statdynfricscale", "cv": "fricdamp"}
PHYSICAL = {
    "cbot": "the seabed's damping",
    "wavekin": "waves from files",
    "waterkin": "waves and currents from a file",
    "currents": "currents from files",
    "fricdamp": "friction's damping; it is elastic below its limit here",
    "statdynfricscale": "static friction larger than dynamic friction",
    "seafloorfile": "the seabed's shape; it is level here",
}
REPORTED_APART = ("line types", "rod types", "points", "lines", "options", "bodies", "rods")


def scene_of(deck: Deck, line: str | None = None) -> ImportedScene:
    """The scene of one of the deck's lines, with those that it is joined to by free points; by default the first's."""
    chain = chain_with(deck, line)
    first, last = (place(deck, name, row) for name, row in _ends(chain))
    if first[2] > last[2]:
        chain = chain.reversed()
    options, reported = options_of(deck)
    seabed, about_seabed = seabed_of(deck, chain, options)
    types, about_types = line_types(deck, chain)
    data: dict[str, Any] = {"title": deck.title.strip("- ") or deck.name, "gravity": options["g"]}
    data |= {"water": {"density": options["rho"], "surface_level": 0.0}, "line_types": types}
    data |= {"riser": _riser(deck, chain)} | seabed
    data |= {"stages": [{"name": "hang", "kind": "static"}]}
    remarks = [*reported, *about_seabed, *about_types, *_about_ends(deck, chain), *_left_out(deck, chain)]
    return ImportedScene(data, sorted(remarks))


def _ends(chain: Chain) -> tuple[tuple[str, DeckRow], tuple[str, DeckRow]]:
    return (chain.joints[0], chain.lines[0]), (chain.joints[-1], chain.lines[-1])


def options_of(deck: Deck) -> tuple[dict[str, float], list[Remark]]:
    values, remarks, known = dict(DEFAULTS), list[Remark](), (*DEFAULTS, *ALONG_AND_ACROSS)
    for row in deck.of("options"):
        key = ALIASES.get(row.words[1].lower(), row.words[1].lower())
        if key in PHYSICAL and row.words[0] not in ("0", "0.0"):
            remarks.append((row.line, f"{row.words[1]} {row.words[0]}: {PHYSICAL[key]}"))
        elif key not in PHYSICAL and key not in known:
            remarks.append((row.line, f"{row.words[1]} {row.words[0]}: a setting of MoorDyn's own"))
        elif key in known:
            values[key] = deck.number(row, 0, row.words[1])
    return values, remarks


def seabed_of(
    deck: Deck, chain: Chain, options: dict[str, float]
) -> tuple[dict[str, Any], list[Remark]]:
    """A bed of springs: kBot [Pa/m] times the diameter; MoorDyn's nodes touch with their axis."""
    if options["wtrdpth"] <= 0.0:
        return {}, [(deck.of("lines")[0].line, "no WtrDpth in the options: the scene has no seabed")]
    diameters = [_diameter(deck, row) for row in chain.lines]
    bed = {"kind": "spring", "stiffness": options["kbot"] * diameters[0], "level": -options["wtrdpth"]}
    data: dict[str, Any] = {"seabed": bed | {"contact_at": "axis"}}
    contact, reported = friction(*(options.get(key, options["frictioncoefficient"]) for key in ALONG_AND_ACROSS))
    rows = (row.line for row in deck.of("options") if row.words[1].lower() in ALONG_AND_ACROSS)
    remarks = [(next(rows), reported)] if reported else []
    data |= contact
    reported = f"kBot times the diameter differs along the riser; the seabed has that of line {chain.lines[0].words[0]}"
    if len(set(diameters)) > 1:
        remarks.append((chain.lines[0].line, reported))
    return data, remarks


def _type_row(deck: Deck, row: DeckRow) -> DeckRow:
    name = row.words[1]
    for each in deck.of("line types"):
        if each.words[0] == name:
            return each
    known = ", ".join(each.words[0] for each in deck.of("line types"))
    raise deck.error(row.line, f"line type {name} is not among the LINE TYPES ({known}); correct the name")


def _diameter(deck: Deck, row: DeckRow) -> float:
    return deck.number(_type_row(deck, row), 1, "Diam")


def line_types(deck: Deck, chain: Chain) -> tuple[dict[str, Any], list[Remark]]:
    types, remarks = dict[str, Any](), list[Remark]()
    for row in dict.fromkeys(_type_row(deck, line) for line in chain.lines):
        name, *stiffnesses = row.words[0], row.words[3], row.words[5]
        first, *more = stiffnesses[0].split("|")
        stiffness = DeckRow(row.line, (first, stiffnesses[1]))
        given = {n: deck.number(row, n, key) for n, key in ((1, "Diam"), (2, "Mass/m"), (6, "Cd"), (7, "Ca"))}
        axial = {n: deck.number(row, n, key) for n, key in ((8, "CdAx"), (9, "CaAx"))}
        types[name] = {
            "outer_diameter": given[1], "mass": given[2],
            "EA": deck.number(stiffness, 0, "EA (curves from files can't be carried over)"),
            "EI": deck.number(stiffness, 1, "EI (curves from files can't be carried over)"),
            "drag": {"normal": given[6], "tangential": axial[8]},
            "added_mass": {"normal": given[7], "tangential": axial[9]},
        }  # fmt: skip
        if more:
            remarks.append((row.line, f"EA {stiffnesses[0]} of {name}: the first alone, for all loads"))
        if row.words[4] not in ("0", "0.0"):
            reported = "axial damping alone; `damping` of a line type would damp bending, too"
            remarks.append((row.line, f"BA/-zeta {row.words[4]} of {name}: {reported}"))
        if len(row.words) > 10 and deck.number(row, 10, "Cl") != 0.0:
            remarks.append((row.line, f"Cl {row.words[10]} of {name}: vortex-induced vibration"))
    return types, remarks


def _riser(deck: Deck, chain: Chain) -> dict[str, Any]:
    segments, attachments, arc = list[dict[str, Any]](), list[dict[str, Any]](), 0.0
    for row, joint in zip(chain.lines, chain.joints[1:], strict=True):
        length = deck.number(row, 4, "UnstrLen")
        segments.append({"line_type": row.words[1], "length": length, "elements": int(deck.number(row, 5, "NumSegs"))})
        arc += length
        if is_free(deck, joint) and (held := held_at(deck, joint)):
            attachments.append({"at": arc} | held)
    if is_free(deck, chain.joints[0]) and (held := held_at(deck, chain.joints[0])):
        attachments.insert(0, {"at": 0.0} | held)
    start, end = (_end(deck, *each) for each in _ends(chain))
    hung = {"attachments": attachments} if attachments else {}
    return {"segments": segments} | hung | {"start": start, "end": end}


def held_at(deck: Deck, joint: str) -> dict[str, float]:
    """What sits at a free point; nothing of it that is zero."""
    row = point(deck, joint)
    assert row is not None
    keys = ("mass", "volume", "drag_area", "added_mass")
    values = {key: deck.number(row, 5 + n, key) for n, key in enumerate(keys)}
    if values["volume"] == 0.0:
        del values["added_mass"]
    return {key: value for key, value in values.items() if value != 0.0}


def _end(deck: Deck, joint: str, line: DeckRow) -> Any:
    return "free" if is_free(deck, joint) else {"position": list(place(deck, joint, line))}


def _about_ends(deck: Deck, chain: Chain) -> Iterator[Remark]:
    for joint, line in _ends(chain):
        row = point(deck, joint)
        if row is None:
            yield line.line, f"line {line.words[0]} is clamped to the rod at {joint}; its end is free to turn here"
            continue
        if row.words[1].lower().startswith((*COUPLED, "body")):
            yield row.line, f"the motion of point {joint}, which comes from outside: the end stays where it is"
        if not is_free(deck, joint) and any(deck.number(row, n, "a property") for n in (5, 6, 7)):
            yield row.line, f"mass, volume and drag of point {joint}, which is held"


def _left_out(deck: Deck, chain: Chain) -> Iterator[Remark]:
    for row in elsewhere(deck, chain):
        yield row.line, f"line {row.words[0]}: a scene has one riser; --line {row.words[0]} imports this one"
    for row in chain.lines:
        if len(row.words) > 6 and row.words[6] != "-":
            yield row.line, f"outputs {row.words[6]} of line {row.words[0]}: a run writes its own"
    yield from left_of_sections(deck, ("bodies", "rods"))


def left_of_sections(deck: Deck, known: tuple[str, ...]) -> Iterator[Remark]:
    """Rows of sections that are not imported, these among them."""
    for section in known:
        yield from ((row.line, f"{section}: {' '.join(row.words)}") for row in deck.of(section))
    for section in deck.rows.keys() - set(REPORTED_APART):
        yield from ((row.line, f"{section}: {' '.join(row.words)}") for row in deck.of(section))
