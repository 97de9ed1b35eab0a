"""Static and dynamic analysis of a flexible riser on a deformable seabed, solved as one system."""

__version__ = "0.1.0"
