"""Columns of a table by its row of headings; where some are none of MoorDyn's, by their place in MoorDyn's order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from riser_soil.moordyn.names import SECTIONS, Section, plain

MOST_WORDS = 3  # words of a heading, as in "Unstr. Len"


def columns_of(section: str, headings: Sequence[str]) -> tuple[list[str | None], list[str]] | None:
    """Name of each column, None where it is none of MoorDyn's, and remarks on those known by their place alone.

    None where MoorDyn's columns are not among the headings.
    """
    table = SECTIONS[section]
    readings = [_named(table, headings, words) for words in (1, MOST_WORDS)]
    for names in readings:
        if None not in names and not missing(table, names):
            return names, []
    for names in readings:
        if (order := _order_with(table, names)) is not None:
            by_place = [(h, name) for h, known, name in zip(headings, names, order, strict=False) if known != name]
            return order, [f"heading {heading} is read as {name}, by its place" for heading, name in by_place]
        if not missing(table, names):
            return names, []
    return None


def fits(section: str, headings: Sequence[str]) -> bool:
    """Whether at least half of the headings are those of a section."""
    names = _named(SECTIONS[section], headings, 1)
    return len(names) > 1 and 2 * names.count(None) <= len(names)


def missing(table: Section, names: Sequence[str | None]) -> list[str]:
    return [name for name in table.columns if name not in names and name not in table.optional]


def _named(table: Section, headings: Sequence[str], most: int) -> list[str | None]:
    """most: number of words that a heading may have."""
    return [*_read(table, [*headings], most, set())]


def _read(table: Section, headings: list[str], most: int, used: set[str]) -> Iterator[str | None]:
    while headings:
        for words in range(min(most, len(headings)), 0, -1):
            heading = plain("".join(headings[:words]))
            free = (name for name, known in table.columns.items() if heading in known and name not in used)
            if (name := next(free, None)) is not None or words == 1:
                used.update([] if name is None else [name])
                del headings[:words]
                yield name
                break


def _order_with(table: Section, names: list[str | None]) -> list[str | None] | None:
    """Names by an order of MoorDyn's in which the known columns are where they are here; what is unknown after the last
    of these is left so, unless a column is missing.
    """
    for order in table.orders:
        some = order[: len(names)]
        at_their_places = len(some) == len(names) and all(
            known in (None, name) for known, name in zip(names, some, strict=True)
        )
        if not at_their_places or missing(table, some) or 2 * names.count(None) > len(names):
            continue
        last = len(names) if missing(table, names) else max(n for n, name in enumerate(names) if name is not None)
        return [*some[:last], *names[last:]]
    return None
