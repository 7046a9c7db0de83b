"""What `pico drift --watch` tells: a line for each change, and for what was brought back."""

from __future__ import annotations

from typing import Any

from pico.bench.watching import Told

from .diff import said
from .drift import about, entry
from .style import paint
from .unread import in_known


def text(told: Told) -> str:
    """Return a line for each tunable that drifted, or is right again, and what was healed, or why it was not."""
    at = paint("dim", told.found.observed_at)
    lines = [f"{at}  {paint('yellow', '!')} {d.address} {said(d.change)}  {paint('dim', about(d))}" for d in told.fresh]
    lines += [f"{at}  {paint('green', '✓')} {name} is as {told.found.head} says again" for name in told.right]
    return "\n".join([*lines, *([f"{at}  {told.note}"] if told.note else [])])


def right(told: Told) -> str:
    """Return what is said where the first look finds nothing."""
    return f"No drift: the bench is as {told.found.head} says{in_known(told.found.unread)}. Watching; Ctrl-C ends it."


def data(told: Told) -> dict[str, Any]:
    """Return schema `pico.watch/v1`: `head`, `observed_at`, `drifted`, `right` (again) and `note`."""
    own = {"head": told.found.head, "observed_at": told.found.observed_at, "drifted": [entry(d) for d in told.fresh]}
    return {"schema": "pico.watch/v1", **own, "right": list(told.right), "note": told.note}
