"""The soil as a small-strain continuum: mesh, constitutive laws, and the part "soil"."""
