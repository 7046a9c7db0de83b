"""What became of a check: for people a line a question, what changes on the table and how."""

from __future__ import annotations

import os
from typing import Any

from pico.bench.checking.verdict import TITLES, Check, CheckReport, LabChecked
from pico.diagnostics import ExitCode
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.record import as_json

from .diff import lines
from .plan import change_of, reason, tally, what
from .style import columns, count, listed, pad, paint, seconds, wide, width, wrap

SIGNS = {"passed": "✓", "advised": "!", "failed": "✗", "skipped": "–"}
_COLORS = {"passed": "green", "advised": "yellow", "failed": "red", "skipped": "dim"}
VERDICTS = {
    ExitCode.DONE: "all is well",
    ExitCode.ERROR: "not valid",
    ExitCode.IMPOSSIBLE: "physically impossible",
    ExitCode.EXPECTATION: "an expectation fails",
    ExitCode.DENIED: "denied by the policy of the lab",
}


def text(checked: CheckReport) -> str:
    """Return the verdicts on every lab."""
    blocks = [_lab(checked, lab) for lab in checked.labs]
    if checked.alike:
        verb = "is" if len(checked.alike) == 1 else "are"
        blocks.append(f"{listed(checked.alike)} {verb} as at {base(checked)}, and {verb} not checked.")
    return "\n\n".join(blocks)


def data(checked: CheckReport) -> dict[str, Any]:
    """Return schema `pico.check/v1`: `what`, `base`, `exit_code`, and of each lab `checks`, `changes`, `plan`, ..."""
    labs = [{**as_json(lab), "exit_code": int(lab.exit_code)} for lab in checked.labs]
    return {**as_json(checked), "labs": labs, "exit_code": int(checked.exit_code)}


def base(checked: CheckReport | LabChecked) -> str:
    """Return what was compared with: `main (4f2c9a1)`."""
    commit = checked.base.commit
    return f"{checked.base.name} ({commit[:7]})" if commit else checked.base.name


def verdict(checked: CheckReport | LabChecked) -> str:
    """Return the verdict in words."""
    broken = isinstance(checked, LabChecked) and any(c.broken for c in checked.checks)
    if checked.exit_code == ExitCode.ERROR and broken:
        return "the simulator does not get there"
    return VERDICTS[checked.exit_code]


def said(check: Check) -> str:
    """Return what stands beside a question."""
    return f"skipped: {check.text}" if check.verdict == "skipped" else check.text


def plan_line(plan: Plan) -> str:
    """Return `2 moves, 0 staged, 21.0 s`, empty where nothing moves."""
    moves = any(op.kind.carries for op in plan.operations)
    parts = [tally(plan.operations), f"{plan.staging.count} staged" if moves else "", seconds(plan.makespan)]
    return ", ".join(part for part in parts if part) if plan.operations else ""


def notable(plan: Plan) -> list[Operation]:
    """Return the operations that nobody asked for: what makes room, and what only a person can do."""
    return [op for op in plan.operations if op.reason.kind in ("in_the_way", "staged", "operator")]


def why(plan: Plan, op: Operation) -> tuple[str, str, str]:
    """Return an operation as name, motion and reason."""
    change = change_of(plan, op)
    motion, because = what(op, change), reason(op.reason, change)
    return op.address, motion, "" if because == motion else because


def drawn(lab: LabChecked) -> str:
    """Return where the pictures of a lab are, seen from where the command was started."""
    return f"Pictures: {', '.join(os.path.relpath(p.path) for p in lab.pictures)}."


def _lab(checked: CheckReport, lab: LabChecked) -> str:
    where = "" if lab.folder == "." else f" · {lab.folder}"
    head = f"{paint('bold', lab.lab)}{where} · {checked.what} against {base(lab)}"
    blocks = [head, "\n".join(line for check in lab.checks for line in _check(check)), *_changes(lab), *_plan(lab)]
    blocks += ["\n".join(line for note in lab.notes for line in wrap(f"Note: {note}.", ""))] if lab.notes else []
    if lab.pictures:
        blocks.append(drawn(lab))
    color = "red" if lab.exit_code else "green"
    word = "Refused" if lab.exit_code else "Passed"
    return "\n\n".join([*blocks, f"{paint(color, word)}: {verdict(lab)}."])


def _check(check: Check) -> list[str]:
    """Return the line of a question; what was found stands beside it, or below where that is too long."""
    found, room = said(check), max(len(title) for title in TITLES.values())
    head = f"  {paint(_COLORS[check.verdict], SIGNS[check.verdict])} {pad(TITLES[check.question], room)}"
    if width(head) + 2 + width(found) <= wide():
        return [f"{head}  {found}".rstrip()]
    return [head.rstrip(), *wrap(found, " " * 6)]


def _changes(lab: LabChecked) -> list[str]:
    found = []
    if lab.changes:
        parts = count(len({c.component for c in lab.changes}), "component")
        verb = "differs" if len(lab.changes) == 1 else "differ"
        found.append("\n".join([f"{count(len(lab.changes), 'tunable')} of {parts} {verb}:", *lines(lab.changes)]))
    elif lab.plan is not None:
        found.append("Nothing differs on the table.")
    if lab.bench:
        found.append("\n".join(wrap(f"The bench itself differs: {', '.join(lab.bench)}.", "")))
    return found


def _plan(lab: LabChecked) -> list[str]:
    if lab.plan is None or not lab.plan.operations:
        return []
    rows = [list(why(lab.plan, op)) for op in notable(lab.plan)]
    return ["\n".join([f"Plan: {plan_line(lab.plan)}.", *columns(rows, indent="  ")])]
