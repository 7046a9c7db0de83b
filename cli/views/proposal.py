"""What the lab's files propose that the bench should be."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import inert, paint, wrap

if TYPE_CHECKING:
    from pico.bench.updating import Proposal

COLOURS = {"+": "green", "-": "red", "@": "cyan"}


def text(found: Proposal, *, adopted: bool) -> str:
    """Return the difference as a patch."""
    if not found.new:
        return f"Nothing to adopt: the bench is what the lab's files describe ({_short(found.bench)})."
    lines = [_coloured(inert(line)) for line in found.patch.splitlines()]
    if not found.bench:
        return "\n".join([*lines, "", *wrap(f"{inert(found.differences[0])}.", "")])
    lines += [f"{inert(one)}." for one in found.differences if " is now called " in one]
    return "\n".join(lines if found.differences else [*lines, "", "Only words differ: plans stay what they are."])


def data(found: Proposal, *, adopted: bool) -> dict[str, Any]:
    """Return schema `pico.proposal/v1`: `bench` and `tree` (digests), `differences`, `patch`, `adopted`."""
    return {"schema": "pico.proposal/v1", **as_json(found), "adopted": adopted}


def _coloured(line: str) -> str:
    return paint(COLOURS[line[0]], line) if line[:1] in COLOURS else line


def _short(digest: str) -> str:
    return digest.removeprefix("sha256:")[:10]
