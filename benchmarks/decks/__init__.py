"""Decks and files of public repositories: what import, check and a run make of each, beside a catenary's tension."""
