"""What a commit recorded of its light: what was measured in its runs when the bench stood as it says, and how its parts
were then seen to stand."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from pico.history.lab.folder import LabFolder
from pico.history.runs.loading import runs_in
from pico.model.measurement import Measurement, measurement_from_json
from pico.model.observation import ObservedComponent, observed_from_json
from pico.model.primitive import primitive
from pico.model.trace.run import STRENGTH, TraceEvent
from pico.runs.trace import measurement_in

_ALONG = ("interlock", "parked")
"""Reasons of operations that leave the bench as it was when they are over."""


@dataclass(frozen=True)
class RecordedLight:
    """What a commit recorded: measurements by address, all of which was assured; the goals that were met, or aligned
    when it was made, by name with what was measured then; and components as they were `seen` when its runs were over.
    """

    measured: Mapping[str, Measurement] = field(default_factory=dict)
    goals: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    seen: Mapping[str, ObservedComponent] = field(default_factory=dict)


def recorded_light(folder: LabFolder, commit: str, evidence: Collection[str] = tuple(STRENGTH)) -> RecordedLight:
    """Return what the runs recorded that a commit (its id) brought: the last of each measurable and goal. What the
    bench was changed after counts no more. evidence: of the runs that count."""
    measured: dict[str, Measurement] = {}
    goals: dict[str, Mapping[str, float]] = {}
    seen: dict[str, ObservedComponent] = {}
    for run in (run for run in runs_in(folder, commit) if run.document.evidence in evidence):
        _follow(run.trace, measured, goals)
        stood = (run.document.goals or {}).items()
        seen |= _seen(run.measurements)
        goals = {**goals, **{name: one.last for name, one in stood if one.status == "aligned" and one.last}}
    sure = {address: one for address, one in measured.items() if not one.not_assured and not one.unknown}
    return RecordedLight(sure, goals, seen)


def _seen(measurements: Iterable[TraceEvent]) -> dict[str, ObservedComponent]:
    """Return the components that were observed after runs, each as it was last."""
    found = {}
    for event in measurements:
        if event.kind == "observation" and event.component:
            with suppress(KeyError, TypeError, ValueError):
                if part := observed_from_json(event.data):
                    found[event.component] = part
    return found


def _follow(
    trace: Iterable[TraceEvent], measured: dict[str, Measurement], goals: dict[str, Mapping[str, float]]
) -> None:  # fmt: skip
    begun: dict[tuple[str | None, str | None], Mapping[str, Any]] = {}
    for event in trace:
        key = (event.run, event.operation)
        if event.kind == "intent":
            begun[key] = event.data
        elif event.kind == "started" and (operation := begun.get(key)):
            kind = (operation.get("reason") or {}).get("kind")
            if primitive(str(operation.get("primitive"))).mutating and kind not in _ALONG:
                measured.clear()
        elif data := measurement_in(event):
            with suppress(ValueError):
                taken = measurement_from_json(data)
                measured[taken.address] = taken
        elif event.kind == "done" and "met" in (found := event.data.get("data") or {}):
            if found["met"]:
                goals[str(found["goal"])] = found.get("last") or {}
            else:
                goals.pop(str(found["goal"]), None)
