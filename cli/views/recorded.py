"""One run with everything that is known of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pico.model.measurement import measurement_from_json
from pico.model.record import as_json
from pico.model.trace.run import TRIALS, GoalStood, Run
from pico.runs.operations import operations

from .diff import lines
from .measured import line, numbers, ranged, solved, value
from .report import expectations
from .runs import COLORS, deed, moment, shown
from .style import columns, count, number, paint, place, seconds

if TYPE_CHECKING:
    from pico.history.git.commit import Commit
    from pico.runs.document import RecordedRun
    from pico.runs.operations import OperationRun

PROVES = {
    "kinematic": "kinematic: simulated, never hardware",
    "physics": "physics: simulated, never hardware",
    "emulated": "emulated devices, never hardware",
    "hardware": "hardware",
}


def text(run: RecordedRun, commit: Commit | None) -> str:
    """Return what it was for, how it ended, what it changed, its operations, and what it ran with."""
    d, did = run.document, operations(run.trace)
    block = [*_head(d, commit), "", *_changed(d)]
    if did:
        head = [paint("dim", cell) for cell in ("from", "took", "planned", "operation", "", "how it ended")]
        block += ["", "Operations:", *columns([head, *(_operation(op) for op in did)], indent="  ")]
    block += ["", *expectations(d.expectations)] if d.expectations else []
    return "\n".join([*block, "", *_with(run)])


def _head(d: Run, commit: Commit | None) -> list[str]:
    where = "a trial: it stays with this bench" if d.cause.kind in TRIALS else "no commit has it yet"
    if commit:
        named = commit.label != commit.short
        where = f"carried by {commit.label} ({commit.short})" if named else f"carried by {commit.short}"
    total = sum(d.tally.values())
    begun = " begun" if d.outcome == "killed" else ""  # nobody was left to count the others
    ended = f"{d.tally.get('done', 0)} of {count(total, 'operation')}{begun} done in {seconds(d.seconds)}"
    by = f" by {shown(d.operator)}" if d.operator else ""
    resumed = f", taken up again {count(d.resumed, 'time')}" if d.resumed else ""
    return [
        f"{paint('yellow', f'run {shown(d.id)}')}  {where}",
        f"{shown(deed(d))}, {moment(d.started_at)} UTC{by}{resumed}",
        f"{paint(COLORS[d.outcome], d.outcome.capitalize())}: {ended} · {PROVES.get(d.evidence, d.evidence)}",
        *([paint("yellow", f"Not met: {shown(', '.join(d.unmet))}")] if d.unmet else []),
    ]


def _changed(d: Run) -> list[str]:
    moved = [c for c in d.changes if not c.tolerated]
    within = len(d.changes) - len(moved)
    block = ["Changed:", *lines(moved)] if moved else ["It changed nothing beyond tolerance."]
    block += [f"  {count(within, 'tunable')} within tolerance"] if within else []
    if d.afterwards:
        block += ["Between its end and the commit, by no operation:", *lines(d.afterwards)]
    if d.goals:
        block += [
            "",
            "Goals when it was committed:",
            *columns([_goal(n, g) for n, g in sorted(d.goals.items())], indent="  "),
        ]
    return block


def _goal(name: str, one: GoalStood) -> list[str]:
    """Return how a goal stood, and what was measured of it."""
    known = one.last or {}
    numbers = [f"{n} {value(v, '', known[f'{n}_sigma'])}" for n, v in known.items() if f"{n}_sigma" in known]
    return [shown(name), one.status, shown(", ".join(numbers) if one.status == "aligned" else one.why)]


def _operation(op: OperationRun) -> list[str]:
    name = f"{op.run[-6:]} {op.id}".strip() + (f" (attempt {op.attempt})" if op.attempt > 1 else "")
    what = f"{op.primitive} {op.address}"
    to = op.arguments.get("to")
    return [
        "-" if op.start is None else f"{op.start:.1f} s",
        "-" if op.seconds is None else seconds(op.seconds),
        "-" if op.planned is None else seconds(op.planned),
        shown(name),
        shown(what + (f" → {_place(to)}" if to is not None else "")),
        _ended(op),
    ]


def _place(to: Any) -> str:
    try:
        return place(to)
    except (KeyError, TypeError, ValueError, AttributeError):  # written by another program
        return str(to)


def _measured(found: Mapping[str, Any]) -> str:
    try:
        return line(found) + (f", assured: {', '.join(found['assured'])}" if found.get("assured") else "")
    except (KeyError, TypeError, ValueError, AttributeError):  # written by another program
        return str(found)


def _solved(found: Mapping[str, Any]) -> str:
    try:
        return solved(found)
    except (KeyError, TypeError, ValueError, AttributeError):  # written by another program
        return ""


def _ended(op: OperationRun) -> str:
    said = op.outcome
    error_mm, error_deg = op.data.get("error_mm"), op.data.get("error_deg")
    if isinstance(error_mm, int | float) and isinstance(error_deg, int | float):
        said += f", {number(error_mm)} mm, {number(error_deg)}° off"
    if isinstance(op.data.get("measurement"), Mapping):
        said += f": {shown(_measured(op.data['measurement']))}"
    if isinstance(op.data.get("met"), bool):
        said += ": met" if op.data["met"] else f": not met, {shown(str(op.data.get('why', '')))}"
    if found := ranged(op.data):
        said += f": {found}"
    if found := _solved(op.data):
        said += f": {shown(found)}"
    if op.settled:
        said += f", as {'the bench was seen later' if op.settled == 'observation' else shown(op.settled) + ' said'}"
    if op.error:
        said += f": {shown(str(op.error.get('summary', '')))}"
    return paint(COLORS[op.outcome], said) if op.outcome in ("done", "failed") else paint("yellow", said)


def _with(run: RecordedRun) -> list[str]:
    """Return what it ran with, and where its data is."""
    d = run.document
    rows = [["state", f"{_short(d.state_before)} → {_short(d.state_after)}"]]
    if d.observed:
        how = "observed" if d.observed.looked else "as the operations saw it, nobody looked afterwards"
        rows.append(["", f"{_short(d.observed.state)} {how}, {moment(d.observed.at)} UTC"])
    rows += [["planned from", d.parent[:7]]] if d.parent else []
    rows += [["goal", f"{shown(d.goal)} ({d.goal_commit[:7]})"]] if d.goal_commit else []
    rows += [["plan", _short(d.plan)], ["lab", f"{shown(d.lab.name)} {_short(d.lab.digest)}"]]
    rows += [["calibration", _short(d.calibration)]] if d.calibration else []
    rows += [["seed", str(d.seed)]] if d.seed is not None else []
    rows += [["environment", shown(", ".join(f"{k} {v}" for k, v in d.environment.items()))]] if d.environment else []
    rows += [["versions", shown(", ".join(f"{k} {v}" for k, v in d.versions.items()))]] if d.versions else []
    rows += [["files", ", ".join(f"{shown(name)} {f.size} bytes" for name, f in d.files.items())]] if d.files else []
    for artifact in d.artifacts:
        here = run.stored.get(artifact.sha256)
        where = f"here: {here}" if here else paint("red", "not here: `pico data pull`")
        rows.append(["artifact", f"{shown(artifact.name)} {artifact.size} bytes, {where}"])
    return columns([[paint("dim", name), value] for name, value in rows])


def _short(digest: str) -> str:
    return shown(digest.removeprefix("sha256:")[:12])


def data(run: RecordedRun, commit: Commit | None) -> dict[str, Any]:
    """Return `pico.recorded/v1`: `document`, `commit`, `operations`, `measurements`, `artifacts`, diagnostics."""
    found: dict[str, Any] = {"schema": "pico.recorded/v1", "document": as_json(run.document)}
    found |= {"commit": commit.id} if commit else {}
    artifacts = [
        {"artifact": as_json(a), "present": a.sha256 in run.stored, "path": run.stored.get(a.sha256)}
        for a in run.document.artifacts
    ]
    return found | {
        "operations": [_with_numbers(op) for op in operations(run.trace)], "measurements": as_json(run.measurements),
        "artifacts": artifacts, "diagnostics": as_json(run.diagnostics),
    }  # fmt: skip


def _with_numbers(op: OperationRun) -> dict[str, Any]:
    """Return an operation as JSON; of what it measured each number by name with its own unit, too."""
    said: dict[str, Any] = as_json(op)
    if not isinstance(measured := op.data.get("measurement"), Mapping):
        return said
    try:
        return said | {"numbers": numbers(measurement_from_json(measured))}
    except ValueError:  # written by another program
        return said
