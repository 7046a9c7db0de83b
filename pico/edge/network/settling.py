"""What became of commands that were cut short with the process of the edge: the journal knows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import PicoError, error
from pico.edge.link import wire
from pico.edge.local import LocalEdge
from pico.edge.network.granting import Granting

ENDS = ("done", "failed")


def settled(edge: LocalEdge, granting: Granting) -> None:
    """Write how each command ended that began and has no end; raises PicoError. What the bench was doing then is found
    out by looking, when it is taken next."""
    for key in granting.gate.memory.unsettled:
        granting.ended(key, _answer(edge, key))


def _answer(edge: LocalEdge, key: str) -> Mapping[str, Any]:
    memory, parts = edge.memory, key.split("/")
    if memory is not None and parts[1:2] == ["start"] and memory.document(parts[0]) is not None:
        return {"value": parts[0]}
    if memory is not None and len(parts) == 3 and parts[2].isdigit():
        ended = [record for record in memory.records(key=key) if record.kind in ENDS]
        if ended:
            return {"value": ended[-1].data}
    text = "the process of the edge was killed while it did this"
    return wire.failure(PicoError(error("link", text, hint="`pico status` shows how the bench stands")))
