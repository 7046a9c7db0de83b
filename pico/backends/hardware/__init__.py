"""The real bench: opening it says what is missing until its drivers exist."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from pico.diagnostics import PicoError, error
from pico.model.setup import Setup


def opened(setup: Setup, root: Path, fidelity: str, clock: Callable[[], str]) -> NoReturn:
    """The bench of the lab in folder `root`, with its real arms, cameras and mounts, can't be opened yet: raises
    PicoError naming what of it has no driver."""
    motors = sorted(
        f"{name}.{tunable}"
        for name in setup.lab.inventory
        for tunable, kind in setup.type_of(name).tunables.items()
        if kind.mover in ("motor", "electronics")
    )
    missing = [f"no driver for the arm {name} ({robot.model})" for name, robot in sorted(setup.lab.robots.items())]
    missing.append("no driver for cameras, so that nobody sees where the components stand")
    if motors:
        missing.append(f"no driver for {', '.join(motors)}")
    hint = "`--backend sim` works on the simulated bench"
    raise PicoError(error("no-hardware", "the real bench cannot be used yet", detail="\n".join(missing), hint=hint))
