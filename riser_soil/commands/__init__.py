"""Commands of riser-soil, one module each or a few that belong together."""
