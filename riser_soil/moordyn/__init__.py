"""Decks of MoorDyn v1, v2 and MoorDyn-F (Hall and others; moordyn.readthedocs.io, "Input Files"), read into scenes."""
