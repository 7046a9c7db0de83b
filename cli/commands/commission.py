"""`pico commission`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, get_args

import typer

from pico.backends.devices import EMULATED
from pico.diagnostics import Diagnostic, ExitCode, PicoError, did_you_mean, error
from pico.model.commissioning import CODE, DAYS, STEPS, Step

from ..arguments import LockTimeout, Yes
from ..session import Session
from ..views import commission as view

HEADING = "The simulator, and the rest"
ORDER = 160

Only = Annotated[list[str] | None, typer.Option("--only", metavar="STEP", help="Do this step; may be given again.")]
Listed = Annotated[bool, typer.Option("--list", help="Show how it stands, and do nothing.")]
Repeats = Annotated[int, typer.Option("--repeats", metavar="N", min=1, help="Pick-and-places a part type.")]
Hours = Annotated[float, typer.Option("--drift-hours", metavar="H", min=0, help="How long drift is looked for.")]
Days = Annotated[
    float | None, typer.Option("--valid-for", metavar="DAYS", help=f"How long it counts; else {DAYS:g} days.")
]


def commission(
    context: typer.Context, only: Only = None, listed: Listed = False, repeats: Repeats = 30, drift_hours: Hours = 12.0,
    valid_for: Days = None, auto_approve: Yes = False, lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Walk through a new bench with a person, and keep a report of it.

    Without a report that counts no laser above class 2 is armed on `--backend hardware`; one of `--emulate` counts for
    the emulated bench alone. What passed is kept; call it again to go on, and after --drift-hours for the last look.
    --yes never says that a hand is on the stop of a real bench. Exit code 2: not at its end yet, 1: a step failed.

    Examples:
      pico commission --backend hardware
      pico commission --backend hardware --list
      pico commission --emulate --repeats 2 --drift-hours 0 --yes
    """
    from pico.bench.commissioning.walk import Walk, standing_by_file

    session = Session.of(context)
    steps = _steps(only)
    if valid_for is not None and not 0 < valid_for <= 366:
        raise PicoError(error("usage", f"--valid-for is {valid_for:g} days", hint="above 0, to 366"))
    if not listed:
        session.require_answer(auto_approve)
    bench = session.bench(writing=not listed)
    if listed and (standing := standing_by_file(bench)) is not None:
        session.show(view, standing)
        text = "another process serves this bench: whether its devices are those of the report was not asked"
        session.tell([Diagnostic("note", CODE, text)])
        return ExitCode.DONE
    walk = Walk(bench, Person(session, auto_approve, bench.backend_name), repeats=repeats, hours=drift_hours)
    if listed:
        session.show(view, walk.standing())
        return ExitCode.DONE
    failed = False
    for done in walk.walk(steps or walk.todo(), valid_for):
        session.say(view.line(done))
        session.tell(done.diagnostics)
        failed |= done.result.outcome == "failed"
    standing = walk.standing()
    session.show(view, standing, after=True)
    return ExitCode.ERROR if failed else ExitCode.CHANGES if standing.why else ExitCode.DONE


def _steps(only: list[str] | None) -> tuple[Step, ...]:
    known = get_args(Step)
    wrong = [name for name in only or () if name not in known]
    if wrong:
        hint = did_you_mean(wrong[0][:40], known) or f"steps: {', '.join(known)}"
        raise PicoError(error("usage", f"there is no step `{wrong[0][:40]}`", hint=hint))
    return tuple(step for step in STEPS if step in (only or ()))


@dataclass(frozen=True)
class Person:
    """Who sits at the terminal."""

    session: Session
    auto_approve: bool
    name: str
    """The device of the bench."""

    def say(self, text: str) -> None:
        self.session.say(text)

    def confirm(self, question: str, *, by_person: bool = False) -> bool:
        """Ask; what only a person can know of a real bench `--yes` does not answer."""
        return self.session.confirm(question, self.auto_approve, by_person=by_person and self.name != EMULATED)
