"""Environment of a process that this one starts for itself, apart from the ranks of its MPI job."""

import os

# A child that saw its parent's MPI rank in these would take itself for that rank.
_MPI = ("OMPI_", "PMIX_", "PMI_", "HYDRA_", "SLURM_")


def environment_alone() -> dict[str, str]:
    """This process's environment without what MPI told it."""
    return {name: value for name, value in os.environ.items() if not name.startswith(_MPI)}
