"""When garbage is looked for: not while a command loads. What it loads it keeps, and to go through that again and again
took a third of the time of a plan of 5,000 components."""

from __future__ import annotations

import gc


def wait_for_loading() -> None:
    """Look for no garbage until `loaded`; for a process of one command, at its very beginning."""
    gc.disable()


def loaded() -> None:
    """Look for garbage from now on, and never among what is there already; nothing where nobody waits for it."""
    if not gc.isenabled():
        gc.freeze()
        gc.enable()
