"""Natural frequencies and mode shapes of the riser at rest: `riser-soil modes`."""
