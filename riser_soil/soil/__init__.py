"""The seabed as a small-strain continuum: mesh, constitutive laws, and the Soil part."""
