"""`pico teleop`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from ..arguments import Fidelity, LockTimeout, Yes
from ..session import Session
from ..views import steered_from_elsewhere as begun
from ..views import teleop as view

HEADING = "One operation at a time"
ORDER = 90

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.bench.teleoperation import Teleoperation


def teleop(
    context: typer.Context,
    component: Annotated[str, typer.Argument(metavar="COMPONENT[.TUNABLE]", help="What is to be steered.")],
    step: Annotated[str | None, typer.Option("--step", metavar="SIZE", help='To begin with: "0.1 mm".')] = None,
    show: Annotated[
        str | None, typer.Option("--show", metavar="MEASURABLE", help="What stands beside it: cam.centroid.")
    ] = None,
    begin: Annotated[
        bool, typer.Option("--begin", help="Only begin it: who says frames to its run steers, such as the page.")
    ] = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Steer a component by the keys of this terminal.

    What motors set of it, one TUNABLE, or `pose`: an arm then holds it 3 mm above its place. A press is one small
    step, checked before it is made; a key that is held goes on, where the terminal reports releases (kitty, foot,
    WezTerm, Ghostty). Let go, or close the terminal: it stops within 0.2 s. q ends; `pico undo` goes back.

    Examples:
      pico teleop p2 --show cam.centroid
      pico teleop ly_150.stage_y --step "5 um"
      pico teleop p2.pose
    """
    session = Session.of(context)
    _require_alone(begin, step, show)
    bench = session.bench(fidelity, None, writing=True)
    name, _, tunable = component.partition(".")
    jog = bench.teleop(name, tunable or None)
    if begin:
        return _begin(session, bench, jog, auto_approve)
    return _teleop(session, bench, jog, _shown(bench, show), _step(jog, step), auto_approve)


def _begin(session: Session, bench: Bench, jog: Teleoperation, yes: bool) -> int:
    """Begin it, and leave it to who says frames to its run."""
    from ..runs.approving import declined, show

    if jog.plan.errored or jog.plan.denied:
        return int(show(session, bench, jog.plan, yes, single=True))
    if code := declined(session, bench, jog.plan, yes):
        return int(code)
    jog.leave(lambda: session.show(begun, jog))
    return 0


def _teleop(
    session: Session, bench: Bench, jog: Teleoperation, shown: tuple[str, str] | None, step: float | None, yes: bool
) -> int:
    from ..runs.approving import declined, show
    from ..runs.steering import steer

    shows = jog.plan.errored or jog.plan.denied or (jog.operation.robot and not session.json)
    if shows and (code := show(session, bench, jog.plan, yes, single=True)):
        return int(code)
    if jog.operation.robot and (code := declined(session, bench, jog.plan, yes)):
        return int(code)
    steer(session, bench, jog, step, shown)
    session.show(view, jog, code=int(jog.report.exit_code))
    session.tell(jog.report.diagnostics)
    return int(jog.report.exit_code)


def _require_alone(begin: bool, step: str | None, show: str | None) -> None:
    """Raise PicoError where nobody sits at the keys that are to steer, and for what only those need."""
    from pico.diagnostics import PicoError, error

    if begin:
        if step or show:
            raise PicoError(error("usage", "--begin goes with neither --step nor --show: who steers chooses"))
        return
    if sys.stdin is None or not sys.stdin.isatty():
        hint = 'from a script: `with bench.teleop("p2", "pose") as jog: jog.step("x", 0.5)`'
        raise PicoError(error("usage", "standard input is no terminal: nobody can press a key here", hint=hint))


def _shown(bench: Bench, address: str | None) -> tuple[str, str] | None:
    """Return a measurable by component and name; raises PicoError for one that there is not."""
    from pico.diagnostics import PicoError, did_you_mean, error

    if address is None:
        return None
    known = bench.wait(bench.edge.describe()).measurables
    if address not in known:
        hint = did_you_mean(address[:60], known) or "`pico get COMPONENT` shows what there is"
        raise PicoError(error("unmeasured", f"nothing measures {address[:60]} here", hint=hint))
    component, _, measurable = address.partition(".")
    return component, measurable


def _step(jog: Teleoperation, text: str | None) -> float | None:
    """Return a step in the unit of what is steered first; raises PicoError for one of another kind."""
    from pico.diagnostics import PicoError, error
    from pico.model.quantities import QuantityError, convert

    if text is None:
        return None
    one = next(iter(jog.known.values()))
    try:
        found = float(text) if text.replace(".", "", 1).isdigit() else convert(text, one.unit)
    except QuantityError as exc:
        hint = f'for example --step "{one.longest:g} {one.unit}"'
        raise PicoError(error("unit", f"--step {text[:40]}: {exc}", hint=hint)) from exc
    if not 0 < found <= one.longest * (1 + 1e-9):
        hint = f"the longest is {one.longest:g} {one.unit}; hold a key to go farther"
        raise PicoError(error("step", f"a step of {found:g} {one.unit} is more than 0.15 s of motion", hint=hint))
    return found
