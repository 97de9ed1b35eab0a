"""Decks of MoorDyn as texts, of a taut polyester line over a short chain, whose parts a test gives in other words."""

from __future__ import annotations

from pathlib import Path

from riser_soil.moordyn.deck import Deck, read_deck

TYPES = ["Name Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx", "(-) (m) (kg/m) (N) (N-s) (N-m2) (-) (-) (-) (-)",
         "rope 0.12 11.5 4.2e7 -0.9 0 1.3 1.1 0.04 0.02"]  # fmt: skip
POINTS = ["ID Attachment X Y Z Mass Volume CdA Ca", "(-) (-) (m) (m) (m) (kg) (m3) (m2) (-)",
          "1 Fixed -240 0 -75 0 0 0 0", "2 Coupled 6 0 -5 0 0 0 0"]  # fmt: skip
LINES = ["ID LineType AttachA AttachB UnstrLen NumSegs Outputs", "(-) (-) (-) (-) (m) (-) (-)",
         "1 rope 1 2 258.5 24 -"]  # fmt: skip
OPTIONS = ["75 WtrDpth", "1.5e5 kBot", "1020 rho", "9.8 g"]
SECTIONS = {"LINE TYPES": TYPES, "POINTS": POINTS, "LINES": LINES, "OPTIONS": OPTIONS}


def text_of_deck(sections: dict[str, list[str]] | None = None, **others: list[str]) -> str:
    """others: rows of a section of `SECTIONS` in place of its own, or after them, by its header in lower case."""
    parts = dict(SECTIONS) | (sections or {})
    parts |= {name.replace("_", " ").upper(): rows for name, rows in others.items()}
    rows = [row for name, part in parts.items() for row in (f"------ {name} ------", *part)]
    return "\n".join(["A rope over a bed", *rows, "------ end ------"]) + "\n"


def deck_of_text(folder: Path, text: str) -> Deck:
    (folder / "deck.dat").write_text(text)
    return read_deck(folder / "deck.dat")
