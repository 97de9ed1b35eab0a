"""A scene of all lines, points and free bodies of a deck, and what of the deck it does not have, line by line."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from riser_soil.imported_scene import ImportedScene, Remark
from riser_soil.moordyn.deck import COUPLED, FREE, Chain, Deck, DeckRow, is_free, place, point
from riser_soil.moordyn.scene_of import held_at, left_of_sections, line_types, options_of, seabed_of

TWIST = 1e-4  # of EA D^2: torsional stiffness of a line without bending stiffness
LEAST_MASS = 1e-3  # of the water that it displaces: of a point that has a volume and no mass


def whole_scene_of(deck: Deck) -> ImportedScene:
    """The whole deck; SceneError for rods, and for bodies that are turned."""
    if deck.of("rods"):
        raise deck.error(deck.of("rods")[0].line, "rods are not there yet; import one of the lines, --line NAME")
    chain = Chain(tuple(deck.of("lines")), ())
    options, reported = options_of(deck)
    seabed, about_seabed = seabed_of(deck, chain, options)
    types, about_types = line_types(deck, chain)
    for each in types.values():
        each["GJ"] = each["EI"] or TWIST * each["EA"] * each["outer_diameter"] ** 2
    bodies, about_bodies = _bodies(deck, options["rho"])
    joints = {name: joint for n, name in enumerate(_shared(deck)) for name, joint in _joints(deck, name, bodies, n)}
    data: dict[str, Any] = {"title": deck.title.strip("- ") or deck.name, "gravity": options["g"]}
    data |= {"water": {"density": options["rho"], "surface_level": 0.0}, "line_types": types}
    data |= {"lines": {_name(row): _line(deck, row) for row in deck.of("lines")}}
    data |= ({"bodies": bodies} if bodies else {}) | ({"joints": joints} if joints else {}) | seabed
    data |= {"stages": [{"name": "hang", "kind": "static"}]}
    twisted = (deck.of("line types")[0].line, "GJ, which MoorDyn does not know: as EI, or small where there is none")
    remarks = [*reported, *about_seabed, *about_types, *about_bodies, twisted]
    return ImportedScene(data, sorted([*remarks, *_driven(deck), *left_of_sections(deck, ("rods",))]))


def _name(row: DeckRow) -> str:
    return f"line{row.words[0]}"


def _line(deck: Deck, row: DeckRow) -> dict[str, Any]:
    """From its lower end on, as far as both have a place of their own."""
    length, elements = deck.number(row, 4, "UnstrLen"), int(deck.number(row, 5, "NumSegs"))
    ends = [_end(deck, name, row) for name in _ends(deck, row)]
    segments = [{"line_type": row.words[1], "length": length, "elements": elements}]
    return {"segments": segments, "start": ends[0], "end": ends[1]}


def _ends(deck: Deck, row: DeckRow) -> tuple[str, str]:
    """Names of what a line ends at, the lower one first."""
    first, last = row.words[2:4]
    return (last, first) if place(deck, first, row)[2] > place(deck, last, row)[2] else (first, last)


def _end(deck: Deck, name: str, line: DeckRow) -> Any:
    return "free" if is_free(deck, name) or _body_of(deck, name) else {"position": list(place(deck, name, line))}


def _body_of(deck: Deck, name: str) -> DeckRow | None:
    """The free body that a point sits on."""
    row = point(deck, name)
    word = "" if row is None else row.words[1].lower().removesuffix("pinned")
    return next((b for b in deck.of("bodies") if word == f"body{b.words[0]}" and b.words[1].lower() in FREE), None)


def _shared(deck: Deck) -> list[str]:
    """Names of the points that hold ends and move with them."""
    ends = (name for row in deck.of("lines") for name in row.words[2:4])
    return [name for name in dict.fromkeys(ends) if is_free(deck, name) or _body_of(deck, name)]


def _joints(deck: Deck, name: str, bodies: dict[str, Any], n: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """Of all ends at a point: with its body where it has one, else with each other."""
    rows = [row for row in deck.of("lines") if name in row.words[2:4]]
    ends: list[dict[str, Any]] = [
        {"line": _name(row), "at": ("start", "end")[_ends(deck, row).index(name)]} for row in rows
    ]
    at = point(deck, name)
    assert at is not None
    if (body := _body_of(deck, name)) is not None:
        offset = [deck.number(at, 2 + i, "a coordinate") for i in range(3)]
        ends.insert(0, {"body": f"body{body.words[0]}", "offset": offset})
    elif f"point{name}" in bodies:
        ends.insert(0, {"body": f"point{name}"})
    first, *others = ends
    if "body" in first:
        pairs, place_of = [(first, each) for each in others], {}
    else:
        pairs, place_of = [*pairwise(ends)], {"position": list(place(deck, name, rows[0]))}
    for m, pair in enumerate(pairs, start=1):
        number = f"_{m}" if len(pairs) > 1 else ""
        yield f"at{name}{number}", {"kind": "pinned", "between": list(pair), **place_of}


def _bodies(deck: Deck, rho: float) -> tuple[dict[str, Any], list[Remark]]:
    """Free points that have something of their own, and free bodies."""
    found, remarks = dict[str, Any](), list[Remark]()
    for row in deck.of("points"):
        held = held_at(deck, row.words[0])
        if not is_free(deck, row.words[0]) or not held:
            continue
        if "mass" not in held:
            held["mass"] = LEAST_MASS * rho * held.get("volume", 0.0) or 1.0
            remarks.append((row.line, f"point {row.words[0]} has no mass; it gets {held['mass']:g} kg"))
        where = [deck.number(row, 2 + n, "a coordinate") for n in range(3)]
        found[f"point{row.words[0]}"] = {"kind": "point", "position": where} | held
    for row in deck.of("bodies"):
        if row.words[1].lower() in FREE:
            found[f"body{row.words[0]}"] = _rigid(deck, row)
    return found, remarks


def _rigid(deck: Deck, row: DeckRow) -> dict[str, Any]:
    x, angles = ([deck.number(row, first + n, "a coordinate") for n in range(3)] for first in (2, 5))
    if any(angles):
        raise deck.error(row.line, f"body {row.words[0]} is turned; give its points in axes that are not")
    if len(row.words) < 14:
        raise deck.error(row.line, f"body {row.words[0]} has {len(row.words)} entries of 14; give all of them")
    centre = _centre(_numbers(deck, row, 9, "CG"))
    drag, added = (_numbers(deck, row, n, key) for n, key in ((12, "CdA"), (13, "Ca")))
    J = _numbers(deck, row, 10, "I")
    return {
        "kind": "rigid", "position": x, "mass": deck.number(row, 8, "Mass"), "inertia": _three(J),
        "centre_of_gravity": centre, "volume": deck.number(row, 11, "Volume"),
        "centre_of_buoyancy": centre,  # MoorDyn lets both act at CG
        "drag_area": _three(drag), "added_mass": _three(added), "rotational_drag": _turning(drag),
    }  # fmt: skip


def _numbers(deck: Deck, row: DeckRow, column: int, what: str) -> list[float]:
    """Of a word such as 1.0|2.0|3.0."""
    words = row.words[column].split("|")
    return [deck.number(DeckRow(row.line, tuple(words)), n, what) for n in range(len(words))]


def _centre(values: list[float]) -> list[float]:
    return values if len(values) == 3 else [0.0, 0.0, values[0]]


def _three(values: list[float]) -> list[float]:
    """By axis: one for all, one for all and one for rotations, three, or three and three for rotations."""
    return values[:3] if len(values) in (3, 6) else values[:1] * 3


def _turning(values: list[float]) -> list[float]:
    """Those for rotations; zero where there are none."""
    return {2: values[1:] * 3, 6: values[3:]}.get(len(values), [0.0, 0.0, 0.0])


def _driven(deck: Deck) -> Iterator[Remark]:
    """What moves from outside."""
    for row in [*deck.of("points"), *deck.of("bodies")]:
        word = row.words[1].lower()
        if word.startswith(COUPLED):
            yield row.line, f"the motion of {row.words[0]} ({row.words[1]}), which comes from outside: it stays there"
