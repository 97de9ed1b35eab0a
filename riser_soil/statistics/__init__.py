"""Statistics of a run's outputs in time: `riser-soil statistics`."""
