"""A fault of a device, for the person who is to check it at the table."""

from __future__ import annotations

from pico.model.instruments.fault import DeviceFault

from .style import paint

QUESTION = "Did you check that at the table, and may the fault be cleared?"


def text(fault: DeviceFault) -> str:
    """Return the fault in the vendor's number and words, and what to check."""
    lines = [paint("bold", str(fault)), f"  Check at the table: {fault.check}."]
    lines.append("  Keep clear of it: its motors may be switched on again. Nothing moves before you approve it.")
    return "\n".join(lines)


def cleared(fault: DeviceFault) -> str:
    """Return that it is cleared."""
    return f"Cleared {fault.number} of {fault.device}, and read back that it is gone."
