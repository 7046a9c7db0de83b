"""What became of the expectations of a state."""

from __future__ import annotations

from pico.model.record import record


@record
class Expected:
    """One expectation against the bench. `holds`: None where that is unknown, which counts as a failure; `why`: what
    the bench shows, or why it can't be told."""

    that: str
    message: str = ""
    holds: bool | None = None
    why: str = ""
