"""A recipe out of runs: what was done by hand, from Python or by sight, step by step, so that it can be done again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

from pico.model.pose import Pose
from pico.model.state import ComponentState
from pico.runs.document import RecordedRun
from pico.runs.left_set import step_of
from pico.runs.operations import OperationRun, operations

PASSED_OVER = ("park", "survey")
"""What comes with other steps, or has its own command."""
MOVES = ("move", "stow")
"""What takes a part elsewhere."""


def encoded(name: str, lab: str, runs: Iterable[RecordedRun]) -> str:
    """Return a recipe as YAML: a step for each thing that was done in the runs, in their order. Of a part that was
    moved several times in a plan, or set, only where it ended up counts: the rest made way, or kept light shut. A
    recorded run is as many plans as it had steps."""
    import yaml

    lines = [
        "apiVersion: pico/v1", "kind: Recipe",
        f"metadata: {yaml.safe_dump({'name': name, 'lab': lab}, default_flow_style=True, width=200).strip()}",
        "steps:",
    ]  # fmt: skip
    for run in runs:
        found = list(_steps(run))
        lines.append(f"  # run {run.document.id}{'' if found else ': nothing that a step does'}")
        for kind, what in found:
            said = yaml.safe_dump(what, default_flow_style=True, width=10_000, allow_unicode=True)
            lines.append(f"  - {kind}: {said.removesuffix('...' + chr(10)).strip()}".rstrip())
    return "\n".join(lines) + "\n"


def _steps(run: RecordedRun) -> Iterator[tuple[str, Any]]:
    done = [op for op in operations(run.trace) if op.outcome == "done" and op.primitive not in PASSED_OVER]
    for _, ops in groupby(done, lambda op: (op.run, step_of(op.id))):
        yield from _of_plan([*ops], run)


def _of_plan(done: Sequence[OperationRun], run: RecordedRun) -> Iterator[tuple[str, Any]]:
    last = {_changed(op): n for n, op in enumerate(done)}
    first = {_changed(op): op for op in reversed(done)}
    sets: dict[str, Any] = {}
    for n, op in enumerate(done):
        if op.primitive in (*MOVES, "set") and last[_changed(op)] != n:
            continue
        if op.primitive == "set":
            if first[_changed(op)] is op or first[_changed(op)].arguments.get("from") != op.arguments["to"]:
                sets[op.address] = op.arguments["to"]
            continue
        if sets:
            yield "set", sets
            sets = {}
        yield from _step(op, run)
    if sets:
        yield "set", sets


def _changed(op: OperationRun) -> str:
    return op.component if op.primitive in MOVES else f"{op.primitive} {op.address}"


def _step(op: OperationRun, run: RecordedRun) -> Iterator[tuple[str, Any]]:
    if op.primitive in MOVES:
        yield "move", {op.component: _place(op.arguments["to"])}
    elif op.primitive in ("measure", "home"):
        yield op.primitive, op.address
    elif op.primitive == "optimize":
        yield "optimize", str(op.arguments["goal"])
    elif op.primitive == "operator":
        yield "prompt", str(op.arguments.get("text", op.reason))
    elif op.primitive == "teleoperate":
        yield from _steered(op, run)
    else:
        words = [f"{k}={v}" for k, v in op.arguments.items() if isinstance(v, int | float | str)]
        yield "do", " ".join([op.component, op.primitive, *words])


def _place(to: Mapping[str, Any]) -> Any:
    return str(to["slot"]) if to.get("slot") else _pose(Pose(**to["pose"]))


def _pose(pose: Pose) -> dict[str, float]:
    return {"x": round(pose.x, 3), "y": round(pose.y, 3), "yaw": round(pose.yaw, 3)}


def _steered(op: OperationRun, run: RecordedRun) -> Iterator[tuple[str, Any]]:
    """What a person steered by eye is set to where that ended."""
    nothing = ComponentState()
    was, now = (s.components.get(op.component, nothing) if s else nothing for s in (run.before, run.after))
    if now.pose is not None and now.pose != was.pose:
        yield "move", {op.component: _pose(now.pose)}
    if values := {f"{op.component}.{t}": v for t, v in now.values.items() if v != was.values.get(t)}:
        yield "set", values
