"""What of a bench was measured longer ago than it counts: its glass, and where its cameras are."""

from __future__ import annotations

from collections.abc import Iterator

from pico.base import clock
from pico.diagnostics import Diagnostic, warning
from pico.model.quantities import convert
from pico.model.setup import Setup


def expired(setup: Setup, calibrated: str, now: str) -> Iterator[Diagnostic]:
    """Yield one line that says what was measured longer ago than it is valid for, and what to do; nothing where nothing
    was. `calibrated`: when the cameras were, empty for never; `now` by the wall; both ISO 8601. What says no date, or
    not how long it counts, does not get old."""
    specimens = [
        (name, number, known.at, known.valid_for)
        for name, part in setup.lab.inventory.items()
        for number, known in (part.measured or {}).items()
        if known.valid_for and old(known.at, known.valid_for, now)
    ]
    said = [f"{number} of {name} ({at[:10]}, valid for {lasts})" for name, number, at, lasts in specimens]
    hints = [f"measure it, then `{_swap(setup, *specimens[0][:2])}`"] if specimens else []
    lasts = setup.lab.policy.calibrated_for
    if lasts and calibrated and old(calibrated, lasts, now):
        said.append(f"the calibration of the cameras ({calibrated[:10]}, valid for {lasts})")
        hints.append("`pico calibrate`")
    if said:
        text = f"measured too long ago: {'; '.join(said)}"
        yield warning("expired", text, hint="; ".join(hints), address=specimens[0][0] if specimens else "")


def old(at: str, valid_for: str, now: str) -> bool:
    """Return whether what was measured `at` a day or time counts no more `now`."""
    return clock.seconds_between(at, now) > float(convert(valid_for, "s"))


def _swap(setup: Setup, name: str, number: str) -> str:
    serial = setup.lab.inventory[name].serial or "SERIAL"
    given = '--focal-length "100 mm"' if number == "focal_length" else f"--parameter {number}=VALUE"
    return f"pico swap {name} --serial {serial} {given} --measured DAY"
