"""What became of a check as a report for a pull request; short enough for a comment."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

from pico.bench.checking.verdict import TITLES, CheckReport, LabChecked
from pico.model.diff import Change
from pico.model.plan import Plan

from . import diagnostics
from .check import SIGNS, base, drawn, notable, plan_line, said, verdict, why
from .diff import poses_first
from .diff import said as motion
from .markdown import fenced, prose, table
from .style import count, place, plain, seconds

MARK = "<!-- pico check -->"
"""The first line, by which a comment is found again."""
LIMIT = 60_000
"""Characters of a report; GitHub takes 65,536 in a comment."""
_ROWS = (200, 60, 20, 8, 3, 1)
_FINDING = 1500


def report(checked: CheckReport, folder: Path | None = None, limit: int = LIMIT) -> str:
    """Return the report, at most `limit` characters. `folder`: where it is written, so that pictures are shown; without
    one they are only named."""
    texts: list[str] = []
    for rows in _ROWS:
        texts = [_head(checked), *(_lab(checked, lab, folder, rows) for lab in checked.labs), *_alike(checked)]
        if len("\n\n".join(texts)) <= limit:
            break
    kept = texts
    while len("\n\n".join(kept)) > limit - 100 and len(kept) > 1:
        kept = kept[:-1]
    more = len(checked.labs) + 1 - len(kept)
    return "\n\n".join([*kept, *([f"… and {count(more, 'lab')} more."] if more > 0 else [])]) + "\n"


def _head(checked: CheckReport) -> str:
    sign = SIGNS["failed" if checked.exit_code else "passed"]
    title = prose(", ".join(lab.lab for lab in checked.labs) or "no lab differs")
    words = f": {verdict(checked.labs[0] if len(checked.labs) == 1 else checked)}" if checked.labs else ""
    return f"{MARK}\n## {sign} {title}{words}\n\n{prose(checked.what)} against {prose(base(checked))}."


def _alike(checked: CheckReport) -> list[str]:
    return [prose(f"As before, and not checked: {', '.join(checked.alike)}.")] if checked.alike else []


def _lab(checked: CheckReport, lab: LabChecked, folder: Path | None, rows: int) -> str:
    several = len(checked.labs) > 1
    where = "" if lab.folder == "." else f" ({prose(lab.folder)})"
    blocks = [f"### {prose(lab.lab)}{where}: {verdict(lab)}"] if several else []
    checks = [[SIGNS[c.verdict], TITLES[c.question], prose(said(c))] for c in lab.checks]
    blocks.append("\n".join(table(["", "check", "found"], checks)))
    blocks += _changes(lab, rows) + _plan(lab.plan, rows) + _findings(lab, rows)
    blocks += [f"Note: {prose(note)}." for note in lab.notes]
    return "\n\n".join([*blocks, *_pictures(lab, folder)])


def _changes(lab: LabChecked, rows: int) -> list[str]:
    blocks = []
    if lab.changes:
        ordered = poses_first(lab.changes)
        cells = [_change(change) for change in ordered[:rows]]
        lines = table(["component", "tunable", "before", "after", "motion"], cells)
        blocks.append("\n".join(["**On the table**", "", *lines, *_more(ordered, rows, "tunable")]))
    elif lab.plan is not None:
        blocks.append("Nothing differs on the table.")
    if lab.bench:
        blocks.append(f"**The bench itself** differs: {prose(', '.join(lab.bench), 1000)}.")
    return blocks


def _change(change: Change) -> list[str]:
    before, after = (place(v) if v is not None else "" for v in (change.before, change.after))
    return [prose(cell, 120) for cell in (change.component, change.tunable, before, after, motion(change))]


def _plan(plan: Plan | None, rows: int) -> list[str]:
    if plan is None or not plan.operations:
        return []
    lines = [f"**Plan**: {plan_line(plan)}."]
    rest = notable(plan)
    lines += [f"- {' '.join(prose(word, 120) for word in why(plan, op) if word)}" for op in rest[:rows]]
    lines += _more(rest, rows, "operation")
    cells = [
        [str(number), *(prose(word, 120) for word in why(plan, op)), seconds(op.seconds)]
        for number, op in enumerate(plan.operations[:rows], 1)
    ]
    summary = f"<details><summary>{count(len(plan.operations), 'operation')}</summary>"
    whole = table(["", "component", "motion", "why", "time"], cells)
    return [
        "\n".join(lines),
        "\n".join([summary, "", *whole, *_more(plan.operations, rows, "operation"), "", "</details>"]),
    ]


def _findings(lab: LabChecked, rows: int) -> list[str]:
    found = sorted(lab.diagnostics, key=lambda d: ("error", "warning", "note").index(d.severity))
    if not found:
        return []
    texts = [plain(diagnostics.text([d])) for d in found[:rows]]
    block = fenced("\n\n".join(t if len(t) <= _FINDING else f"{t[:_FINDING]}\n…" for t in texts))
    return ["\n".join(["**Findings**", "", block, *_more(found, rows, "finding")])]


def _pictures(lab: LabChecked, folder: Path | None) -> list[str]:
    if not lab.pictures:
        return []
    if folder is None:
        return [prose(drawn(lab))]
    links = [f"![{p.title}]({quote(os.path.relpath(p.path, folder))})" for p in lab.pictures]
    return ["\n".join(table([f"**{p.title}**" for p in lab.pictures], [links]))]


def _more(found: Sequence[object], rows: int, noun: str) -> list[str]:
    more = len(found) - rows
    return ["", f"… and {count(more, f'more {noun}')}."] if more > 0 else []
