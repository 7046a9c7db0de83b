"""What a device says goes wrong, told at the level of component and operation."""

from __future__ import annotations

from dataclasses import replace

from pico.backends.attempt import Failed
from pico.diagnostics import PicoError
from pico.model.operation import Operation


def failed(operation: Operation, exc: PicoError, leg: str = "") -> Failed:
    """Return the failure of an operation in which a device failed; `leg`: of an arm's way, where it did."""
    said = exc.diagnostics[0]
    where = f" ({leg})" if leg else ""
    text = f"{operation.id}, {operation.primitive} of {operation.address}, failed{where}: {said.summary}"
    return Failed(replace(said, summary=text, severity="error", address=operation.address))
