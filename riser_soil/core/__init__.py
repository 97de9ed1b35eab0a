"""Core: array types, compiled kernels, the interface of parts, numbering, and the system that they make up."""
