"""Text data files of OrcaFlex 11 (YAML; orcina.com/webhelp/OrcaFlex, "Text data files"), read into scenes.

Units are those of its SI system: m, s, te, kN, and deg; so densities are in te/m3, pressures in kPa, and the stiffness
of an end in kN.m/deg. Names of data are OrcaFlex's own.
"""
