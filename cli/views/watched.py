"""What `pico watch` tells: a line for each change, and for what was brought back."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.bench.drift import Drift, Drifted

from .diff import said
from .drift import about, entry
from .style import paint


def text(found: Drifted, fresh: Sequence[Drift], right: Sequence[str], note: str = "") -> str:
    """Return a line for each tunable that drifted, or is right again; `note`: what was healed, or why it was not."""
    at = paint("dim", found.observed_at)
    lines = [f"{at}  {paint('yellow', '!')} {d.address} {said(d.change)}  {paint('dim', about(d))}" for d in fresh]
    lines += [f"{at}  {paint('green', '✓')} {name} is as {found.head} says again" for name in right]
    return "\n".join([*lines, *([f"{at}  {note}"] if note else [])])


def data(found: Drifted, fresh: Sequence[Drift], right: Sequence[str], note: str = "") -> dict[str, Any]:
    """Return schema `pico.watch/v1`: `head`, `observed_at`, `drifted`, `right` (again) and `note`."""
    own = {"head": found.head, "observed_at": found.observed_at, "drifted": [entry(d) for d in fresh]}
    return {"schema": "pico.watch/v1", **own, "right": list(right), "note": note}
