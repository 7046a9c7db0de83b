"""`pico sim`: the hand of somebody in the simulated laboratory."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..arguments import Component, Seed, group
from ..session import Session
from ..views import hidden
from ..views import simulated as said

HEADING = "The simulator, and the rest"
ORDER = 10

if TYPE_CHECKING:
    from pico.backends.world import World
    from pico.bench.bench import Bench

app = group(
    help="Act on the simulated world; alone, list its hidden changes.",
    examples=("pico sim nudge p2 --dx 5", "pico sim faults drop=0.05 seed=3", "pico sim reset", "pico sim"),
    alone=True,
)


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        _show_hidden(context)


def _finite(value: float) -> float:
    if not math.isfinite(value):
        raise typer.BadParameter(f"{value} is no length and no angle")
    return value


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


Dx = Annotated[float, typer.Option("--dx", help="Millimeters to the right.", callback=_finite)]
Dy = Annotated[float, typer.Option("--dy", help="Millimeters away from you.", callback=_finite)]
Dz = Annotated[float, typer.Option("--dz", help="Millimeters up.", callback=_finite)]
Dyaw = Annotated[float, typer.Option("--dyaw", help="Degrees counter-clockwise.", callback=_finite)]


@app.command()
def reset(context: typer.Context, seed: Seed = None) -> None:
    """Put every part of the simulated bench home, as in a new world.

    Examples:
      pico sim reset
      pico sim reset --seed 7
    """
    _act(context, lambda sim: sim.reset(seed), "every part of the simulated bench is at home")


@app.command()
def nudge(
    context: typer.Context,
    name: Component,
    dx: Dx = 0.0,
    dy: Dy = 0.0,
    dyaw: Dyaw = 0.0,
) -> None:
    """Push a component, as somebody bumping the table would.

    One that was taken off the table is put to its home first.

    Examples:
      pico sim nudge p2 --dx 5
    """
    session = Session.of(context)
    bench = session.bench()
    hand = _out_of(bench, name)
    pose = bench.sim.nudge(name, dx=dx, dy=dy, dyaw=dyaw)
    session.show(said, f"{name} now stands at {pose}{hand}", pose=pose)


@app.command()
def bump(
    context: typer.Context,
    camera: Annotated[
        str | None, typer.Argument(help="The camera; where none is named, all at the table move as one.")
    ] = None,
    dx: Dx = 0.0,
    dy: Dy = 0.0,
    dz: Dz = 0.0,
    dyaw: Dyaw = 0.0,
) -> None:
    """Push a camera, as somebody bumping its post would.

    It keeps looking from there until a reset.

    Examples:
      pico sim bump left --dx 3
    """
    moved = f"{camera or 'every camera at the table'} moved by ({dx:g}, {dy:g}, {dz:g}) mm, {dyaw:g} deg"
    shift, turn = (dx, dy, dz), (0.0, 0.0, dyaw)
    _act(context, lambda sim: sim.bump(camera, shift=shift, turn=turn), f"{moved}; its calibration is as before")


@app.command()
def remove(context: typer.Context, name: Component) -> None:
    """Take a component off the simulated table: it is then missing.

    Examples:
      pico sim remove p2
    """
    hand = _out_of(Session.of(context).bench(), name)
    _act(context, lambda sim: sim.remove(name), f"{name} is off the table{hand}; `pico sim nudge {name}` puts it home")


@app.command("slip", context_settings={"ignore_unknown_options": True})
def slip(
    context: typer.Context,
    address: Annotated[str, typer.Argument(metavar="COMPONENT.TUNABLE", help="For example p1.angle.")],
    by: Annotated[float, typer.Argument(metavar="BY", help="In its unit.", callback=_finite)],
) -> None:
    """Let a mount slip: an axis then reads another value than light finds.

    Nothing that is read tells of it, and homing does not bring it back; a second slip adds to the first, and
    `pico sim upset p1 --clear` takes it back.

    Examples:
      pico sim slip p1.angle 2.1
    """
    session = Session.of(context)
    bench = session.bench()
    component, _, tunable = address.partition(".")
    bench.sim.slip(component, tunable, by)
    unit = bench.setup.type_of(component).tunables[tunable].unit
    session.show(said, f"{address} truly is {by:g} {unit} more than before, and reads the same; light alone tells")


@app.command("upset", context_settings={"ignore_unknown_options": True})
def upset(
    context: typer.Context,
    name: Annotated[str | None, typer.Argument(metavar="COMPONENT", help="A component of the inventory.")] = None,
    by: Annotated[
        list[str] | None, typer.Argument(metavar="WHAT=BY", help="For example up=0.1 loss=20%.", show_default=False)
    ] = None,
    clear: Annotated[
        bool, typer.Option("--clear", help="Undo its disturbances and slips; those of all parts if none is named.")
    ] = False,
) -> None:
    """Disturb a part in a way that no overhead camera sees; without arguments, show what is hidden.

    Displaced along its own axes: ahead, left, up [mm]; turned about them: roll, pitch, yaw [deg]; dirty: loss, a share
    of its light. Of a laser power; of a lens focal_length [mm]; of a wave plate retardance [waves]; of a polarizer
    leak, a share of what it should stop; of a detector gain, and dark, what it reads without light. A power or a gain
    is a factor, or a change in percent. optic: the type whose optic stands in its mount instead of its own. It adds to
    earlier disturbances; a focal length and an optic replace them.

    Examples:
      pico sim upset lx_100 up=0.08
      pico sim upset laser power=-30%
      pico sim upset lx_100 focal_length=150
      pico sim upset lx_100 optic=plano_convex_125
      pico sim upset --clear
    """
    from pico.optics.upsets import parse

    if clear:
        _clear(context, name, by or ())
    elif name is None or not by:
        _show_hidden(context, name)
    else:
        given = parse(by)
        said_so = ", ".join(by)
        _act(context, lambda sim: sim.upset(name, **given), f"{name}: {said_so}; no camera over the bench sees it")


def _clear(context: typer.Context, name: str | None, by: Sequence[str]) -> None:
    from pico.diagnostics import PicoError, error

    if by:
        hint = "`pico sim upset NAME --clear` undoes all disturbances of a part"
        raise PicoError(error("usage", "--clear takes no WHAT=BY", hint=hint))
    session = Session.of(context)
    had = session.bench().sim.clear(name)
    whose = ", ".join(had)
    session.show(
        said, f"{whose} as before: nothing is hidden of it" if had else "nothing was hidden, so nothing changed"
    )


def _show_hidden(context: typer.Context, name: str | None = None) -> None:
    from pico.model.request import require_component

    session = Session.of(context)
    bench = session.bench()
    if name is not None:
        require_component(bench.setup, name)
    found = {one: by for one, by in bench.sim.hidden().items() if name in (None, one)}
    session.show(hidden, bench.setup, found)


@app.command()
def wait(
    context: typer.Context,
    how_long: Annotated[str, typer.Argument(metavar="TIME", help="For example 8h, '8 h' or 300 (seconds).")],
) -> None:
    """Let time pass on the bench's clock: light drifts meanwhile, where the lab has an environment.

    Examples:
      pico sim wait '8 h'
    """
    from pico.diagnostics import PicoError, error
    from pico.model.quantities import QuantityError, convert

    try:
        seconds = _finite(float(convert(f"{how_long} s" if _is_number(how_long) else how_long, "s")))
    except (QuantityError, ValueError) as exc:
        raise PicoError(error("usage", f"`{how_long[:40]}` is no time: {exc}", hint="for example '8 h'")) from None
    if seconds < 0:
        raise PicoError(error("usage", "time passes one way only", hint="for example '8 h'"))
    _act(context, lambda sim: sim.wait(seconds), f"{seconds:g} s later on the bench's clock")


@app.command()
def view(context: typer.Context) -> None:
    """Open MuJoCo's own viewer on the bench; needs a display.

    It follows what moves.

    Examples:
      pico sim view
    """
    from pico.drawing.viewer import require_display

    require_display()
    Session.of(context).bench().pictures.view()


@app.command()
def person(
    context: typer.Context,
    where: Annotated[
        Literal["here", "away"],
        typer.Argument(metavar="here|away", help="Whether somebody is at the table from now on."),
    ],
) -> None:
    """Let somebody step up to the simulated table, or go away.

    Policies ask about it, and nothing heals meanwhile.

    Examples:
      pico sim person here
    """
    here = where == "here"
    _act(context, lambda sim: sim.person(here), f"{'somebody' if here else 'nobody'} is at the table")


@app.command(name="power-cycle")
def power_cycle(context: typer.Context) -> None:
    """Switch the simulated bench off and on.

    Axes that must be homed then stand nobody knows where, and the next plan homes them first; electronics are dark and
    closed.

    Examples:
      pico sim power-cycle
    """
    _act(context, lambda sim: sim.power_cycle(), "the power was off; the next plan homes what must be homed")


@app.command()
def faults(
    context: typer.Context,
    words: Annotated[
        list[str] | None, typer.Argument(metavar="KIND=RATE...", help="For example drop=0.05 seed=3; or off.")
    ] = None,
) -> None:
    """Let things go wrong on the simulated bench.

    Drop, slip, jam, camera, timeout, reading, slow, stick (an axis, for good), frame, beam, flood (of light), or all.
    A rate is a share of the operations, from 0 to 1. Without an argument it says what is in force.

    Examples:
      pico sim faults drop=0.05 seed=3
      pico sim faults off
    """
    session = Session.of(context)
    found = session.bench().sim.faults(words or ())
    rates = ", ".join(f"{kind} {100 * rate:g} %" for kind, rate in found["rates"].items() if rate)
    session.show(said, f"faults: {rates} of the operations, seed {found['seed']}" if rates else "nothing goes wrong")


def _out_of(bench: Bench, name: str) -> str:
    """Return from whose gripper a part is taken now, in words; empty where none holds it."""
    from pico.bench.cut_short import hand_on

    robot = hand_on(bench, name)
    return f", taken out of the gripper of {robot}, which is open now" if robot else ""


def _act(context: typer.Context, act: Callable[[World], object], text: str) -> None:
    """Do something to the simulated world, and say what."""
    session = Session.of(context)
    act(session.bench().sim)
    session.show(said, text)
