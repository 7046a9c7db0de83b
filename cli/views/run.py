"""A run while it goes on and when it is over."""

from __future__ import annotations

from typing import Any

from pico.model.plan import Plan
from pico.model.trace.event import Event

from . import measured
from .plan import change_of, what
from .style import count, pad, paint, seconds, shorten, wide, width


class Progress:
    """Turns events into lines: one that stays for each operation that ended, one that is overwritten meanwhile."""

    def __init__(self, plan: Plan) -> None:
        self.operations = {op.id: op for op in plan.operations}
        self.ended: set[str] = set()
        self.titles = {op.id: f"{op.address} {what(op, change_of(plan, op))}" for op in plan.operations}
        self.names = max(map(width, self.titles.values()), default=0)
        self.began: float | None = None
        self.started: dict[str, float] = {}

    def line(self, event: Event) -> str:
        """Return the line that stays after an event; empty for none."""
        if event.operation not in self.operations:
            return ""
        marks = {
            "operation_done": paint("green", "✓"),
            "operation_failed": paint("red", "✗"),
            "operation_unknown": paint("red", "?"),
            "operation_skipped": paint("dim", "-"),
            "operation_retried": paint("yellow", "↻"),
        }
        if event.kind not in marks:
            return ""
        if event.kind != "operation_retried":
            self.ended.add(event.operation or "")
        mark = paint("yellow", "↩") if _put_back(event) else marks[event.kind]
        return f"  {mark} {self._head(event)}  {self._tail(event)}".rstrip()

    def live(self, event: Event) -> str:
        """Return the line that stands while an operation is under way; empty for none.

        It ends with the time that passed on the bench since the first operation began: in the simulator, simulated.
        """
        op = self.operations.get(event.operation or "")
        if op is None or event.kind not in ("operation_started", "operation_progress"):
            return ""
        self.began = event.time if self.began is None else self.began
        if event.kind == "operation_started":
            self.started[op.id] = event.time
        took = event.time - self.started.get(op.id, event.time)
        phase, passed = event.data.get("phase", ""), event.time - self.began
        beside = f"{took:5.1f} of about {op.seconds:.1f} s"
        tail = f"{paint('yellow', beside) if op.is_late(took) else beside}  {phase:8}  {passed:.0f} s in all"
        return shorten(f"  {paint('cyan', '▸')} {self._head(event)}  {tail}".rstrip(), wide())

    def _head(self, event: Event) -> str:
        """How many operations ended with this one, or will have when it does: several may run beside one another."""
        op, total = event.operation or "", len(self.operations)
        return f"{len(self.ended | {op}):>{len(str(total))}}/{total} " + pad(self.titles[op], self.names)

    def _tail(self, event: Event) -> str:
        data = event.data
        if event.kind == "operation_done":
            took = f"{seconds(float(data['seconds'])):>7}" if "seconds" in data else ""
            op = self.operations[event.operation or ""]
            if op.is_late(float(data.get("seconds", 0.0))):
                took += paint("yellow", f" of about {seconds(op.seconds)}")
            said = measured.line(data["measurement"]) if "measurement" in data else measured.ranged(data)
            said = placement(data) if "error_mm" in data else sought(data) if "algorithm" in data else said
            return took + (f"   {said}" if said else "")
        if event.kind == "operation_skipped":
            because = self.operations.get(str(data.get("because", "")))
            return f"skipped: {because.address} did not get there" if because else "not started"
        found = data.get("diagnostic")
        summary = found.get("summary", "") if isinstance(found, dict) else getattr(found, "summary", "")
        if event.kind == "operation_retried":
            return f"tried again: {summary}"
        if _put_back(event):
            return str(summary)
        return f"{'failed' if event.kind == 'operation_failed' else 'outcome unknown'}: {summary}".rstrip(": ")


def _put_back(event: Event) -> bool:
    """Return whether a part was brought back, or left, because the run was interrupted: no failure."""
    found = event.data.get("diagnostic")
    return isinstance(found, dict) and found.get("code") == "put-back"


def sought(data: Any) -> str:
    """Return `met in 4 measurements`."""
    times = count(int(data.get("measurements", 0)), "measurement")
    return f"met in {times}" if data.get("met") else f"not met in {times}: {data.get('why', '')}"


def placement(data: Any) -> str:
    """Return `placed 0.11 mm, 0.03° from its goal`."""
    turned = f", {float(data['error_deg']):.2f}°" if data.get("error_deg") is not None else ""
    return f"off by {float(data['error_mm']):.2f} mm{turned}"
