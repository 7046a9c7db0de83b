"""Which parts were put down anew since a moment, as the journal of a bench knows."""

from __future__ import annotations

from pico.base import clock
from pico.model.primitive import primitive
from pico.runs.memory import Memory


def put_down_since(memory: Memory | None, at: str) -> frozenset[str] | None:
    """Return the parts that an arm or a person began to put elsewhere since `at` (by the wall, ISO 8601); None where
    the journal does not reach back to that. Raises PicoError where it can't be read."""
    begin, found = clock.parse(at), set[str]()
    for run in reversed(memory.runs()) if memory else ():
        records = memory.records(run=run.run) if memory else ()
        moves = {r.key for r in records if r.kind == "intent" and _moves(str(r.data.get("primitive")))}
        began = (r for r in records if r.kind == "started" and r.key in moves)
        found |= {r.component for r in began if clock.parse(r.at) >= begin}
        if clock.parse(run.started_at) <= begin:
            return frozenset(found)
    return None


def _moves(name: str) -> bool:
    kind = primitive(name)
    return kind.by in ("arm", "person") and kind.changes != "nothing"
