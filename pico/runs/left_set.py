"""What a recorded run that was cut short had set only for the while: for a measurement, or while an arm worked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from pico.model.operation import operation_from_json
from pico.model.quantities import Value

if TYPE_CHECKING:
    from pico.model.observation import Observation
    from pico.runs.memory import Memory


def left_set(memory: Memory, seen: Observation) -> Mapping[str, Value]:
    """Return the tunables that the last step of the last run had set in passing and not set back, by address, each with
    its value before, and where a search that was cut short began; nothing of a run that had no steps."""
    last = memory.last()
    if last is None or last.outcome == "done":
        return {}
    records = memory.records(run=last.run)
    step = max((step_of(r.key.split("/")[1]) for r in records), default=0)
    if not step:
        return {}
    own = [r for r in records if step_of(r.key.split("/")[1]) == step]
    begun = {r.key for r in own if r.kind == "started"}
    ended = {r.key for r in own if r.kind == "done"}
    operations = {r.key: operation_from_json(r.data) for r in own if r.kind == "intent" and r.key in begun}
    sets = [op for op in operations.values() if op.primitive == "set"]
    meant = {op.address for op in sets if op.reason.kind != "interlock"}
    before = {op.address: op.arguments["from"] for op in reversed(sets) if op.address not in meant}
    for key, op in operations.items():
        if op.primitive in ("optimize", "survey") and key not in ended:
            before |= op.arguments.get("from", {})
    return {a: v for a, v in before.items() if v is not None and _differs(seen, a, v)}


def step_of(operation: str) -> int:
    """Return the number of the step that an operation of an open run belongs to; 0 where it is of none."""
    number, dot, _ = operation.partition(".")
    return int(number) if dot and number.isdigit() else 0


def _differs(seen: Observation, address: str, value: Value) -> bool:
    component, _, tunable = address.partition(".")
    live = seen.known_values.get(component, {}).get(tunable)
    return live is not None and live != value
