"""What goes over a link: one JSON document a line.

A call names a method of the edge; its answer is a value, for streams several `next` ones before it, or what went wrong.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from pico.backends.device import Capabilities
from pico.backends.hardware.guard.note import Ended
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.edge.armings import Kept
from pico.edge.protocol import Holder, Job, Lease, OwnLab
from pico.model.arming import Arming
from pico.model.instruments.fault import DeviceFault
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult, Outcome
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.trace.dose import Dose
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport
from pico.model.trace.run import RunOutcome
from pico.model.trace.unattended import Left, Terms
from pico.runs.journal import JournalRecord, RunRecord, Success, Unsettled
from pico.teleop.frames import Answer, Frame
from pico.twin.placement import Placement
from pico.twin.snapshot import Snapshot
from pico.version import __version__, upgrade_hint
from pico.vision.arm import ArmOffsets

About = tuple[tuple[dict[str, Any], ...], dict[str, Any] | None]
Triple = tuple[float, float, float]
CALLS: Mapping[str, tuple[tuple[Any, ...], Any]] = {
    "describe": ((), Capabilities),
    "holder": ((), Holder | None),
    "unended": ((), str | None),
    "lab": ((), OwnLab | None),
    "adopt": ((OwnLab, str), None),
    "armings": ((), tuple[Kept, ...]),
    "arm": ((Arming,), Arming),
    "disarm": ((str, str), bool),
    "hold": ((Terms,), Left | None),
    "goes_on": ((str,), None),
    "leave": ((str, bool), Left),
    "unattended": ((), Terms | None),
    "doses": ((), tuple[Dose, ...]),
    "observe": ((), Observation),
    "look": ((), dict[str, Any]),
    "peek": ((str, str), Measurement),
    "faults": ((), tuple[DeviceFault, ...]),
    "clear_fault": ((str, str), None),
    "array": ((str,), str),
    "picture": ((str, str, list[str]), dict[str, Any]),
    "acquire": ((str, float), Lease),
    "execute": ((Operation, str, Lease), OperationResult),
    "start": ((Job, str), str),
    "open": ((Job, str), Lease),
    "finish": ((str, RunOutcome), RunReport),
    "events": ((str, int), Event),
    "live": ((), dict[str, Any]),
    "report": ((str,), RunReport),
    "film": ((str,), list[Snapshot]),
    "jog": ((str, Frame), Answer),
    "cancel": ((str,), None),
    "halt": ((), None),
    "stop": ((), None),
    "end_light": ((), Ended | None),
    "resolve": ((str, Outcome, str), None),
    "memory": ((), bool),
    "memory.runs": ((), tuple[RunRecord, ...]),
    "memory.last": ((), RunRecord | None),
    "memory.moving": ((), frozenset[str]),
    "memory.document": ((str,), str | None),
    "memory.about": ((str,), About),
    "memory.records": ((str | None, str | None), tuple[JournalRecord, ...]),
    "memory.successes": ((list[str],), tuple[Success, ...]),
    "memory.unsettled": ((), tuple[Unsettled, ...]),
    "world": ((), None),
    "world.placements": ((), dict[str, Placement]),
    "world.reset": ((int | None,), None),
    "world.put": ((Observation,), None),
    "world.nudge": ((str, float, float, float), Pose),
    "world.bump": ((str | None, Triple, Triple), None),
    "world.true_cameras": ((), dict[str, Any]),
    "world.true_arms": ((), dict[str, ArmOffsets]),
    "world.remove": ((str,), None),
    "world.slip": ((str, str, float), None),
    "world.upset": ((str, dict[str, float | str]), None),
    "world.clear": ((str | None,), tuple[str, ...]),
    "world.hidden": ((), dict[str, dict[str, float | str]]),
    "world.wait": ((float,), None),
    "world.power_cycle": ((), None),
    "world.person": ((bool,), None),
    "world.faults": ((list[str],), dict[str, Any]),
}
"""Every call that there is: the types of its arguments, and of its value or of each `next` one."""
STREAMS = frozenset({"events", "live"})
TAKES = frozenset({"acquire", "adopt", "arm", "disarm", "start", "open", "hold", "resolve"}) | (
    {call for call in CALLS if call.startswith("world.")}
    - {"world.placements", "world.true_cameras", "world.true_arms", "world.hidden"}
)
"""Calls that take the bench, as only the worktree may that it is attached to."""
HOLDS = frozenset({"execute", "finish", "goes_on", "leave", "jog"})
"""Calls of who has the bench, or an unattended run on it."""
AT_TABLE = frozenset({"clear_fault"})
"""Calls that a person at the table makes, over the socket of the bench's own computer: no coordinator relays them, and
no edge takes them from one."""
LONGEST = 1 << 28
"""Bytes of the longest line."""


@cache
def adapter(kind: Any) -> Any:
    """Return what reads a type from JSON data."""
    from pydantic import TypeAdapter

    return TypeAdapter(kind)


def line(document: Mapping[str, Any]) -> bytes:
    """Return a document as it goes over the link."""
    return json.dumps(document, separators=(",", ":")).encode() + b"\n"


def call(name: str, arguments: tuple[Any, ...]) -> bytes:
    """Return the line of a call."""
    return line({"call": name, "with": [as_json(argument) for argument in arguments]})


def read_call(data: bytes) -> tuple[str, list[Any]]:
    """Return the name of a call and its arguments; raises PicoError for what is none."""
    try:
        document = json.loads(data)
        name, given = document["call"], document["with"]
        kinds = CALLS[name][0]
        return name, [adapter(kind).validate_python(value) for kind, value in zip(kinds, given, strict=True)]
    except (ValueError, KeyError, TypeError, RecursionError) as exc:
        text = f"the edge does not know this call: {str(exc)[:200]}"
        hint = f"the edge runs PICO {__version__}. If the client is newer, {upgrade_hint()} there, and restart the edge"
        raise PicoError(error("link", text, hint=hint)) from exc


def read_answer(name: str, data: bytes) -> tuple[str, Any]:
    """Return what a line is that answers a call, as `read_document` does."""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError) as exc:
        raise _senseless(name, exc) from exc
    return read_document(name, document)


def read_document(name: str, document: Any) -> tuple[str, Any]:
    """Return what a document is that answers a call (`value`, or `next` of a stream), and that; raises PicoError for
    what went wrong at the other end, and for what is no answer."""
    try:
        failed = _raised(document) if "error" in document else None
        kind = "next" if "next" in document else "value"
        if failed is None:
            over = name in STREAMS and kind == "value"
            return kind, document[kind] if over else adapter(CALLS[name][1]).validate_python(document[kind])
    except (ValueError, KeyError, TypeError, RecursionError) as exc:
        raise _senseless(name, exc) from exc
    raise failed


def _senseless(name: str, exc: Exception) -> PicoError:
    text = f"the edge answered {name} with something else: {str(exc)[:200]}"
    hint = f"it broke off, or the edge is of another version than this PICO {__version__}. If it is newer: "
    hint += f"{upgrade_hint()}"
    return PicoError(error("link", text, hint=hint))


def failure(exc: PicoError) -> dict[str, Any]:
    """Return what went wrong, as JSON."""
    return {"error": as_json(exc.diagnostics), "exit": int(exc.exit_code)}


def _raised(document: Mapping[str, Any]) -> PicoError:
    """Return what went wrong at the other end."""
    found = adapter(tuple[Diagnostic, ...]).validate_python(document["error"])
    return PicoError(found, ExitCode(document["exit"]))
