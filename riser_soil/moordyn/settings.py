"""Options of a deck, and the seabed that follows from them."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from riser_soil.imported_scene import Remark, friction
from riser_soil.moordyn.chains import Chain
from riser_soil.moordyn.deck import Deck, DeckRow, as_number
from riser_soil.moordyn.names import ALIASES, DEFAULTS, HARMLESS, LOST, lost_option, option_of
from riser_soil.moordyn.nodes import Node, is_anchor, node_at, place
from riser_soil.moordyn.properties import diameter
from riser_soil.scene.problem import Path

ROUND_OFF = 1e-6  # m: what is no more below an anchor is as deep as it
NEAR = 0.8  # of 1: how alike an unknown option is to one that may be meant
SOME_DEPTH = 1e-6  # m: an anchor that is no more below the seabed lies on it


@dataclass(frozen=True)
class Options:
    """Values of the options that a scene has, by MoorDyn's names, and the line of each that the deck gives."""

    values: dict[str, float]
    lines: dict[str, int]

    def __getitem__(self, name: str) -> float:
        return self.values[name]


def options_of(deck: Deck) -> tuple[Options, list[Remark]]:
    """The options, and a remark on each that is not carried over, but for those that can't change an answer."""
    options, remarks = Options(dict(DEFAULTS), {}), list[Remark]()
    for row in deck.of("options"):
        _refuse_swapped(deck, row)
        if len(row.words) < 2:
            remarks.append((row.line, f"{row.words[0]}: an option has a value and a name, and MoorDyn skips this one"))
        elif (name := option_of(row.words[1])) is None:
            remarks.extend((row.line, about) for about in _about_option(row))
        elif name == "WtrDpth" and as_number(row.words[0]) is None:
            remarks.append((row.line, f"{row.words[1]} {row.words[0]}: depths from a file; the seabed is level here"))
        else:
            if name in options.lines:
                again = f"{row.words[1]} {row.words[0]} counts, and not the value of line {options.lines[name]}"
                remarks.append((row.line, again))
            options.values[name] = deck.parsed(row, row.words[0], row.words[1])
            if options.values[name] < 0.0:
                raise deck.error(row.line, f"{row.words[1]} is {row.words[0]}, less than 0; give its size")
            options.lines[name] = row.line
    if options["g"] == 0.0:
        raise deck.error(options.lines["g"], "g is 0: without gravity no line hangs; give 9.81")
    return options, remarks


def _refuse_swapped(deck: Deck, row: DeckRow) -> None:
    """An option's name before its value, which MoorDyn does not read."""
    first, second, *_ = (*row.words, "", "")
    known = option_of(first) or lost_option(first) or first.lower() in HARMLESS
    if known and not (option_of(second) or lost_option(second) or second.lower() in HARMLESS):
        right = f"{second or 'VALUE'} {first}"
        raise deck.error(row.line, f"{first} {second}: an option has its value first; write {right}")


def _about_option(row: DeckRow) -> Iterator[str]:
    value, word = row.words[:2]
    if word.lower() in HARMLESS:
        return
    lost = lost_option(word)
    if lost is None:
        known = [*(name for names in (*ALIASES.values(), *LOST) for name in names), *HARMLESS]
        near = difflib.get_close_matches(word.lower(), known, 1, NEAR)
        meant = f"; {near[0]} is, if that is meant" if near else ""
        yield f"{word} {value}: no option of MoorDyn{meant}"
    elif lost[0] is None or as_number(value) != lost[0]:
        yield f"{word} {value}: {lost[1]}"


def seabed_of(
    deck: Deck, chains: list[Chain], options: Options
) -> tuple[dict[str, Any], list[Remark], dict[Path, int]]:
    """A bed of springs: kBot [Pa/m] times the diameter; MoorDyn's nodes touch with their axis. With remarks, and the
    deck's lines where it comes from.
    """
    level, remarks = level_of(deck, options)
    if level is None:
        return {}, remarks, {}
    lowest = chains[0].lines[0]
    diameters = {diameter(deck, row) for chain in chains for row in chain.lines}
    stiffness = options["kBot"] * diameter(deck, lowest)
    data: dict[str, Any] = {
        "seabed": {"kind": "spring", "stiffness": stiffness, "level": level, "contact_at": "axis"}
    }
    if len(diameters) > 1:
        remark = "kBot times the diameter differs along the riser; the seabed has that of"
        remarks.append((lowest.line, f"{remark} line {lowest['ID']}, {stiffness:g} Pa"))
    given = [name for name in ("mu_kA", "mu_kT") if name in options.lines]
    axial, lateral = (options[name] if given else options["FrictionCoefficient"] for name in ("mu_kA", "mu_kT"))
    contact, about_friction = friction(axial, lateral)
    rows = [options.lines[name] for name in (*given, "FrictionCoefficient") if name in options.lines]
    if about_friction:
        remarks.append((rows[0], about_friction))
    if given and "FrictionCoefficient" in options.lines:
        both = f"FrictionCoefficient {options['FrictionCoefficient']:g}: {' and '.join(given)} count"
        remarks.append((options.lines["FrictionCoefficient"], both))
    origins: dict[Path, int] = {("contact",): rows[0]} if contact else {}
    if "WtrDpth" in options.lines:
        origins[("seabed",)] = options.lines["WtrDpth"]
    if "kBot" in options.lines:
        origins[("seabed", "stiffness")] = options.lines["kBot"]
    return data | contact, remarks, origins


def level_of(deck: Deck, options: Options) -> tuple[float | None, list[Remark]]:
    """Height of the seabed [m], by WtrDpth or else at the deepest anchor; None where nothing tells."""
    if options["WtrDpth"] > 0.0:
        level = -options["WtrDpth"]
        return level, [*_anchors_below(deck, level)]
    nodes = [node_at(deck, row, "points") for row in deck.of("points")]
    nodes += [node_at(deck, row, "rods", end) for row in deck.of("rods") for end in "AB"]
    heights = {node: place(deck, node)[2] for node in nodes}
    anchors = {node: z for node, z in heights.items() if is_anchor(deck, node)}
    line = options.lines.get("WtrDpth", deck.of("lines")[0].line)
    if not anchors or min(anchors.values()) > min(heights.values()) + ROUND_OFF:
        return None, [(line, "no WtrDpth in the options, and no anchor is deeper than all else: there is no seabed")]
    deepest = min(anchors, key=lambda node: anchors[node])
    level = anchors[deepest]
    remark = "no WtrDpth in the options: the seabed is at the deepest anchor"
    return level, [(line, f"{remark}, {deepest.name}, z = {level:g} m")]


def _anchors_below(deck: Deck, level: float) -> Iterator[Remark]:
    for row in deck.of("points"):
        node = node_at(deck, row, "points")
        if is_anchor(deck, node) and (z := place(deck, node, level)[2]) < level - SOME_DEPTH:
            yield row.line, below_the_seabed(node, z, level)


def below_the_seabed(node: Node, z: float, level: float) -> str:
    deep = f"{node.name} is {level - z:.4g} m below the seabed (z = {z:g} m, WtrDpth {-level:g} m)"
    lowers = "MoorDyn in C++ lowers the seabed to it; write that depth as WtrDpth if it is meant"
    return f"{deep}: the line is laid from there, up through the seabed's springs; {lowers}"
