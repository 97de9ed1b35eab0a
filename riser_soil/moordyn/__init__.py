"""Decks of MoorDyn v2 (Hall and others; moordyn.readthedocs.io, "The V2 Input File"), read into scenes."""
