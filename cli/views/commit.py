"""A commit that was just made."""

from __future__ import annotations

from typing import Any

from pico.model.record import as_json
from pico.model.trace.report import Committed

from .capture import aligned
from .diff import lines
from .style import count, on_bench, paint


def text(made: Committed) -> str:
    """Return the commit as `git commit` would show it, with what it changed on the table."""
    branch = made.branch or "detached HEAD"
    summary = made.message.strip().partition("\n")[0]
    head = f"[{branch} {paint('yellow', made.commit[:7])}] {summary}"
    block = [head, *lines(made.changes)]
    if made.captured:
        found = sum(len(addresses) for addresses in (made.aligned or {}).values())
        if len(made.captured) > found:
            block.append(f"{count(len(made.captured) - found, 'tunable')} taken from the bench.")
        block += aligned(made.captured, made.aligned)
    if not made.realized:
        block.append("Committed as planned: not compared with the bench yet, `pico verify` does that.")
    elif made.runs:
        block.append(f"With {count(len(made.runs), 'run')} ({on_bench(made.evidence, made.bench)}).")
    if not made.branch:
        block.append("HEAD is detached and no branch holds this commit: `git switch -c NAME` keeps it findable.")
    return "\n".join(block)


def data(made: Committed) -> dict[str, Any]:
    """Return schema `pico.commit/v1`."""
    return {"schema": "pico.commit/v1", **as_json(made)}
