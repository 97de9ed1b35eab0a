"""What all tests share: a process that Ctrl-C interrupts. What a script starts in the background ignores it, and passes
that on to all that it starts; a handler, though, ends where another program begins. Before anything else is imported,
as gmsh remembers how it found Ctrl-C. What runs keep for others of their compliance is not kept, nor read.
"""

from __future__ import annotations

import gc
import os
import signal

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

os.environ["RISER_SOIL_COMPLIANCE"] = "off"

from hypothesis import settings

gc.set_threshold(100_000, 10, 10)  # in what compiling kernels makes a search for garbage takes a tenth of its time

settings.register_profile("unhurried", deadline=None)  # nothing hangs on how busy the machine is
settings.load_profile("unhurried")
