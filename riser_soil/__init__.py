"""Static and dynamic analysis of a flexible riser on a deformable seabed, solved as one system.

`Scene`, `run` and `Run` are imported when they are first asked for: the package itself costs nothing.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from riser_soil.api import Run, Scene, run

__version__ = "0.2.0"
__all__ = ["Run", "Scene", "__version__", "run"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from riser_soil import api

    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
