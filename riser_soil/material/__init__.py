"""One material point of a scene's soil law, driven along a path: `riser-soil material`."""
