"""Whether the report of a commissioning counts: what is missing of it, what has aged, what is another bench since."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime, timedelta

from pico.base import clock
from pico.diagnostics import Diagnostic, error
from pico.model.commissioning import CODE, STEPS, Basis, Commissioning, changed


def why_not(
    report: Commissioning | None, bench: str, basis: Basis, now: str, calibration: str | None = None
) -> tuple[str, ...]:  # fmt: skip
    """Return in words why a report does not count for a bench `now` (ISO 8601); empty where it does. All that is wrong
    at once: steps that were not done or did not pass, those that are too old, and what was changed since.
    `calibration`: the digest of the bench's calibration, empty without one; None if that does not matter."""
    if report is None:
        return ("it was never commissioned",)
    if report.bench != bench:
        return (f"the report is of the {report.bench} bench, and counts for that alone",)
    return (*changed(report, basis), *_undone(report), *recalibrated(report, calibration), *_aged(report, now))


def recalibrated(report: Commissioning, calibration: str | None) -> Iterator[str]:
    """Yield in words that the calibration is not the one with which the bench was commissioned, if so; `calibration`:
    see `why_not`."""
    then = report.steps["calibration"].data.get("digest") if report.passed("calibration") else None
    if calibration is not None and then and calibration != then:
        now = f"{calibration[:19]} now" if calibration else "gone"
        yield f"the calibration was changed since: {str(then)[:19]} was commissioned, and it is {now}"


def until(report: Commissioning) -> datetime | None:
    """Return until when a report counts by its age, None where nothing was done yet."""
    done = [clock.parse(step.at) for name, step in report.steps.items() if name in STEPS]
    return min(done) + timedelta(days=report.days) if done else None


def refusal(bench: str, laser: str, why: tuple[str, ...]) -> Diagnostic:
    """Return that a laser above class 2 stays shut, for its bench is not commissioned, and what is to be done."""
    words = "--backend hardware" + (" --emulate" if bench == "emulated" else "")
    text = f"{laser} stays shut: this {bench} bench is not commissioned: {why[0]}"
    hint = f"`pico {words} commission` walks through what is to be done; `--list` shows what was"
    return error(CODE, text, detail="; ".join(why[1:]), hint=hint, address=laser)


def _undone(report: Commissioning) -> Iterator[str]:
    open_ = [step for step in STEPS if step not in report.steps]
    if open_:
        yield f"not done: {', '.join(open_)}"
    for step in STEPS:
        if step in report.steps and not report.passed(step):
            how = "goes on" if report.steps[step].outcome == "begun" else "failed"
            yield f"{step} {how}: {report.steps[step].told}"


def _aged(report: Commissioning, now: str) -> Iterator[str]:
    at, days = clock.parse(now), timedelta(days=report.days)
    for name in STEPS:
        done = clock.parse(report.steps[name].at) if name in report.steps else at
        if at > done + days:
            yield f"{name} was done on {done:%Y-%m-%d}, and counts for {report.days:g} days"
        elif done > at + timedelta(days=1):
            yield f"{name} is dated {done:%Y-%m-%d}, which is to come"
