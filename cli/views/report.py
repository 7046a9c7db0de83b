"""What became of a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.diagnostics import ExitCode
from pico.model.record import as_json
from pico.model.trace.expectation import Expected
from pico.model.trace.report import BEYOND_TRIM, GoalEnd, RunReport

from .by_light import excepted, stays, unfound
from .diff import brief
from .style import count, listed, paint, seconds, wrap
from .unread import in_known, unread

_CAPTURE = "The manifest is unchanged; `pico capture` updates it."


def text(report: RunReport, *, after: str = "", undoing: bool = False, again: str = "") -> str:
    """Return the tally, and whether the bench now equals what was wanted; `after`: what to do once it is done;
    `undoing`: the same command again would undo this one; `again`: that command."""
    total = report.done + report.failed + report.unknown + report.skipped
    parts = [f"{report.done} of {count(total, 'operation')} done"]
    back = sum(d.code == "put-back" for d in report.diagnostics)
    parts += [f"{back} put back or left"] if back else []
    parts += [f"{report.failed - back} failed"] if report.failed > back else []
    parts += [f"{report.unknown} with unknown outcome"] if report.unknown else []
    parts += [f"{report.skipped} not started"] if report.skipped else []
    head = {
        "done": paint("green", "Done"),
        "failed": paint("red", "Failed"),
        "interrupted": paint("yellow", "Interrupted"),
    }
    took = f"{seconds(report.seconds)} {report.clock}, {seconds(report.wall)} here"
    said = ", ".join(parts) if total > report.done else f"{count(total, 'operation')}"
    paused = report.put_off and not (report.failed or report.unknown)
    ended = paint("yellow", "Stopped after one motion") if paused else head[report.outcome]
    lines = [f"{ended}: {said} · {took}{off(report)}"]
    lines += [*goals(report.goals or (), report.aligning), *expectations(report.expectations)]
    ending = [*_bench(report, undoing, again), *([after] if after and report.exit_code == ExitCode.DONE else [])]
    return "\n".join(lines + [part for line in ending for part in wrap(line, "")])


def off(report: RunReport) -> str:
    """Return ` · placed within 0.11 mm, 0.03°`, empty where nothing was placed."""
    found = report.off
    return f" · placed within {float(found['mm']):.2f} mm, {float(found['deg']):.2f}°" if found else ""


def goals(found: Sequence[GoalEnd], took: float | None) -> list[str]:
    """Return `2 of 2 goals met, alignment 8.1 s.`, and why each of the others is not."""
    if not found:
        return []
    lines = []
    for one in found:
        if not one.met:
            lines += wrap(f"{paint('red', '✗')} {one.goal}: not met{': ' if one.why else ''}{one.why}", "  ")
    met = sum(one.met for one in found)
    return [*lines, f"{met} of {count(len(found), 'goal')} met, alignment {seconds(took or 0.0)}."]


def expectations(found: Sequence[Expected]) -> list[str]:
    """Return `3 of 3 expectations hold.`, and lines for each that does not, or of which nobody knows."""
    if not found:
        return []
    lines = []
    for one in found:
        if not one.holds:
            verb = "fails" if one.holds is False else "is unknown, which is a failure"
            verb = verb if one.failed else "is not assured"
            mark = paint("red", "✗") if one.failed else paint("yellow", "?")
            said = f"{one.message}: " if one.message else ""
            lines += wrap(f"{mark} {said}`{one.that}` {verb}{': ' if one.why else ''}{one.why}", "  ")
    holding = sum(bool(one.holds) for one in found)
    verb = "holds" if len(found) == 1 else "hold"
    doubtful = sum(not one.assured for one in found)
    rest = f", {doubtful} {'is' if doubtful == 1 else 'are'} not assured" if doubtful else ""
    return [*lines, f"{holding} of {count(len(found), 'expectation')} {verb}{rest}."]


def _bench(report: RunReport, undoing: bool, again: str) -> list[str]:
    if not report.put_off and report.reached and (report.whole or report.scope or report.outcome == "done"):
        if report.whole:
            unknown = report.unread or ()
            return [
                unfound(report.goal, report.by_light or ())
                or f"The bench equals {report.goal}{in_known(unknown)}{excepted(report.excepted or ())}.",
                *([unread(unknown)] if unknown else []),
            ]
        if report.scope:
            return [_partial(report)]
        if report.measurements or report.read:
            return [f"`pico runs show {report.run}` shows what was measured."]
        said = stays(report.by_light or ()) or _CAPTURE
        return [said, *(_in_hand(robot, part) for robot, part in report.held.items())]
    lines = []
    if report.remaining:
        lines.append(f"Still to do for {report.goal}: {brief(report.remaining)}.")
    away = [name for name in report.absent if name not in report.held.values()]
    if away:
        lines.append(f"Not seen where it should stand: {listed(away)}.")
    lines += [_in_hand(robot, part) for robot, part in report.held.items()]
    return [*lines, *_goes_on(report, bool(away), undoing, again)]


def _goes_on(report: RunReport, away: bool, undoing: bool, again: str) -> list[str]:
    """Return how to go on after a run that left something to do."""
    if report.put_off:
        command = "pico resume" if undoing else again or "pico apply"
        lets = "`pico commission --only motion` lets plans run whole"
        return [f"{count(report.put_off, 'operation')} left: continue with `{command}`. {lets}."]
    if report.outcome == "interrupted":
        return ["Continue with `pico resume`; go back with `pico undo`."]
    if undoing:
        return ["Continue with `pico resume`: another `pico undo` would take back this one."]
    found = {d.address for d in report.diagnostics if d.code == BEYOND_TRIM}
    if report.remaining and not away and {f"{c.component}.{c.tunable}" for c in report.remaining} <= found:
        return []  # the same command would take it back, and light would find it again
    return ["Continue with the same command: it plans from what is observed now. `pico undo` goes back."]


def _in_hand(robot: str, part: str) -> str:
    """Return what becomes of a component that a run left in a gripper."""
    return f"{robot} still holds {part}: the next plan sets it down first; `pico recover` does only that."


def _partial(report: RunReport) -> str:
    if not report.left:
        return f"As asked, {report.scope}: nothing else differs from {report.goal}."
    verb = "differs" if len(report.left) == 1 else "differ"
    return f"As asked, {report.scope}. The bench does not equal {report.goal}: {listed(report.left)} still {verb}."


def data(report: RunReport, **_: Any) -> dict[str, Any]:
    """Return schema `pico.report/v1`: outcome, tally, seconds, `remaining` changes, diagnostics."""
    found: dict[str, Any] = as_json(report)
    return found
