"""Hydrodynamic loads: waves, current, Morison's formula, buoyancy at the surface."""
