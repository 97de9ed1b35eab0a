"""The soil as a continuum: mesh, constitutive laws, and the part "soil"."""
