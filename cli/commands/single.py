"""One operation at a time: `pico do` and its short forms."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Component, DryRun, Fidelity, Pairs, Speed
from ..running import execute
from ..session import Session
from ..views import plan as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.model.plan import Plan


def do(
    context: typer.Context,
    component: Component,
    primitive: Annotated[str, typer.Argument(metavar="PRIMITIVE", help="move, stow, set, home or measure.")],
    arguments: Pairs = None,
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
) -> int:
    """Run one primitive of a component, through the same checks as a plan.

    `pico do p2 move x=500 y=420 yaw=30`, `pico do p2 move slot=storage/b2`, `pico do p1 set angle=3`. The manifest
    stays as it is: `pico capture` takes the result into it.
    """
    return single(context, component, primitive, pairs(arguments), speed, dry_run, fidelity)


def move(
    context: typer.Context,
    component: Component,
    arguments: Pairs = None,
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
) -> int:
    """Move a component to a pose or a slot.

    `pico move p2 x=500 y=420 yaw=30`; what is not named stays. `pico move p2 500 420 30` is the same.
    `pico move p2 storage/b2` takes it to a slot.
    """
    return single(context, component, "move", pairs(arguments, ("x", "y", "yaw")), speed, dry_run, fidelity)


def rotate(
    context: typer.Context,
    component: Component,
    arguments: Pairs = None,
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
) -> int:
    """Turn a component about the vertical.

    Degrees: `pico rotate p2 30` turns it to yaw 30, `pico rotate p2 by=-5` from where it stands.
    """
    given = pairs(arguments, ("yaw",))
    if not given.keys() <= {"yaw", "by"} or len(given) != 1:
        raise PicoError(error("usage", "rotate takes one of `yaw=DEGREES` and `by=DEGREES`"))
    return single(context, component, "move", given, speed, dry_run, fidelity)


def stow(
    context: typer.Context,
    component: Component,
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
) -> int:
    """Put a component back into its home slot."""
    return single(context, component, "stow", {}, speed, dry_run, fidelity)


def set_(
    context: typer.Context,
    component: Component,
    arguments: Pairs = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
) -> int:
    """Set a tunable.

    `pico set p1 angle=3`, `pico set cam exposure="2 ms"`.
    """
    return single(context, component, "set", pairs(arguments), None, dry_run, fidelity)


def home(
    context: typer.Context,
    component: Component,
    tunable: Annotated[str | None, typer.Argument(metavar="TUNABLE", help="Needed where there are several.")] = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
) -> int:
    """Home the axis of a tunable."""
    return single(context, component, "home", {"tunable": tunable} if tunable else {}, None, dry_run, fidelity)


def place(
    context: typer.Context,
    component: Component,
    after: Annotated[str, typer.Option("--after", metavar="OTHER", help="The component that it follows.")],
    distance: Annotated[float, typer.Option("--distance", metavar="MM", help="Between the optical planes.")],
    speed: Speed = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
) -> int:
    """Place a component a distance after another along the beam."""
    session = Session.of(context)
    bench = session.bench(fidelity, speed, writing=not dry_run)
    return finish(session, bench, bench.place(component, after=after, distance=distance), dry_run)


def single(
    context: typer.Context,
    component: str,
    primitive: str,
    arguments: dict[str, str],
    speed: float | None,
    dry_run: bool,
    fidelity: str | None,
) -> int:
    """Plan one operation and run it."""
    session = Session.of(context)
    bench = session.bench(fidelity, speed, writing=not dry_run)
    return finish(session, bench, bench.single(component, primitive, arguments), dry_run)


def finish(session: Session, bench: Bench, plan: Plan, dry_run: bool) -> int:
    """Show and run the plan of one operation. Nobody is asked: the command named it."""
    session.show(view, plan, single=True)
    if not session.json:
        session.report(plan.diagnostics)
    if plan.errored:
        return ExitCode.IMPOSSIBLE
    if plan.denied:
        return ExitCode.DENIED
    if dry_run or not plan.operations:
        return ExitCode.DONE
    session.say("")
    return execute(session, bench, plan)


def pairs(words: list[str] | None, positional: tuple[str, ...] = ()) -> dict[str, str]:
    """Return `key=value` words as a mapping; bare words take the names of `positional` in turn.

    Raises PicoError for a word without `=` that has no name.
    """
    found: dict[str, str] = {}
    names = iter(positional)
    for word in words or []:
        key, equals, value = word.partition("=")
        if not equals:
            key, value = _named(word, names), word
        if key in found:
            raise PicoError(error("usage", f"`{key}` is given twice"))
        found[key] = value
    return found


def _named(word: str, names: Iterator[str]) -> str:
    if word.startswith("--"):
        raise PicoError(error("usage", f"no such option: {word}"))
    if "/" in word:
        return "slot"
    name = next(names, None)
    if name is None:
        raise PicoError(error("usage", f"`{word}` is no `key=value`", hint="for example `angle=3`"))
    return name
