"""The runs that there are, a line each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic
from pico.model.record import as_json
from pico.model.trace.run import TRIALS, Run

from .style import columns, count, paint, plain, seconds, shorten

if TYPE_CHECKING:
    from pico.history.git.commit import Commit

COLORS = {"done": "green", "failed": "red", "interrupted": "yellow", "killed": "red"}


def text(
    found: Sequence[tuple[Run, Commit | None]],
    _: Sequence[Diagnostic] = (),
    others: Sequence[Run] | None = None,
    *,
    most: int | None = None,
) -> str:
    """Return a line a run, of the first `most`: id, what led where, evidence, outcome, seconds, commit; then those of
    others."""
    own = _own(found, most)
    if others is None:
        return own
    rows = [[*_row(run, None)[:-1], shown(run.operator)] for run in others]
    said = "What others began at this bench, and no commit here has:" if others else "Nobody else began a run here."
    return "\n".join([own, "", said, *columns(rows)] if rows else [own, "", said])


def _own(found: Sequence[tuple[Run, Commit | None]], most: int | None) -> str:
    if not found:
        return "No run here has moved anything; `pico runs list --all` looks at every branch and tag."
    head = [
        paint("dim", cell) for cell in ("run", "when (UTC)", "what", "bench", "evidence", "outcome", "took", "commit")
    ]
    rows = [_row(run, commit) for run, commit in found[:most]]
    own = sum(commit is None and run.cause.kind not in TRIALS for run, commit in found)
    last = [f"{count(own, 'run')} that no commit has yet: `pico commit` takes {'it' if own == 1 else 'them'}."]
    return "\n".join([*columns([head, *rows]), *(["", *last] if own else [])])


def _row(d: Run, commit: Commit | None) -> list[str]:
    return [
        shown(d.id),
        moment(d.started_at),
        shorten(deed(d), 26),
        shown(d.bench or ""),
        d.evidence,
        paint(COLORS[d.outcome], d.outcome) if d.outcome != "done" or not d.unmet else paint("yellow", "not met"),
        seconds(d.seconds),
        commit.label if commit else _without(d),
    ]


def _without(d: Run) -> str:
    return paint("dim", "trial") if d.cause.kind in TRIALS else paint("yellow", "not yet")


def deed(d: Run) -> str:
    """Return what a run was for: `apply e1`, `undo 2026...`, `move p2`, `recipe malus`, `malus: e1` of a step of it."""
    goal = shown(d.goal)
    if d.cause.recipe and d.cause.kind == "recipe":
        name = shown(str(d.cause.recipe).partition("@")[0])
        return f"recipe {name}" if goal in ("", name) else f"{name}: {goal}"
    if d.cause.kind in ("undo", "redo", "resume", "recover") or not d.cause.kind:
        of = f" {shown(d.cause.of)}" if d.cause.of else ""
        return f"{shown(d.cause.kind)}{of}" if d.cause.kind else goal
    return goal if d.cause.kind in ("single", "teleoperation") else f"{shown(d.cause.kind)} {goal}"


def moment(at: str) -> str:
    """Return `2026-11-21 10:11` of a time in ISO 8601."""
    return at[:16].replace("T", " ")


def shown(value: str) -> str:
    """Return what a file of somebody else says, without what would steer the terminal."""
    return "".join(c if c.isprintable() else "?" for c in plain(value))


def data(
    found: Sequence[tuple[Run, Commit | None]],
    wrong: Sequence[Diagnostic] = (),
    others: Sequence[Run] | None = None,
    *,
    most: int | None = None,
) -> dict[str, Any]:
    """Return schema `pico.runs/v1`: `runs`, each `document` with its `commit` (absent where none has it yet),
    `others` (each `document` of a run that somebody else began at the bench), and `diagnostics`."""
    runs = [{"document": as_json(run), **({"commit": commit.id} if commit else {})} for run, commit in found[:most]]
    foreign = [{"document": as_json(run)} for run in others or ()]
    return {"schema": "pico.runs/v1", "runs": runs, "others": foreign, "diagnostics": as_json(list(wrong))}
