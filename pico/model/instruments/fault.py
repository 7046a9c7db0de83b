"""A fault of a device, as a person at the table has to know it."""

from __future__ import annotations

from typing import Literal, get_args

from pico.diagnostics import Diagnostic, error
from pico.model.record import record

FaultCode = Literal["device-fault", "arm-fault", "gripper-fault"]
"""The codes of diagnostics that tell a fault."""
CODES: frozenset[str] = frozenset(get_args(FaultCode))
AGAIN = "`pico recover` clears it"
"""The way on from a fault, for hints."""


@record
class DeviceFault:
    """A fault that a device reports and keeps until it is cleared."""

    device: str
    """The name of the device in the lab's files."""
    number: str
    """As the vendor prints it, with its letter: `C31`."""
    means: str
    """What happened."""
    check: str
    """What a person checks or does at the table before it is cleared."""
    person: bool = True
    """Whether a person must have been at the table before it is cleared."""
    code: FaultCode = "device-fault"
    """The code of its diagnostics."""

    def __str__(self) -> str:
        return f"{self.device} has fault {self.number}: {self.means}"


def fault_diagnostic(fault: DeviceFault) -> Diagnostic:
    """Return a fault as an error that names what to check and `pico recover`."""
    detail = "it is cleared only after a person was there" if fault.person else "it may be cleared from here"
    hint = f"{fault.check}; then {AGAIN}"
    return error(fault.code, str(fault), detail=detail, hint=hint, address=fault.device)
