"""`pico lease`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Yes, group
from ..session import Session
from ..views import lease as view

HEADING = "The simulator, and the rest"
ORDER = 210

if TYPE_CHECKING:
    from pico.edge.network.holding import Holding
    from pico.places.bench import BenchPlace

app = group(
    help="Who has a bench on the network; and the lock of a person at the table.",
    examples=(
        "pico lease show",
        "pico lease take",
        'pico lease steal --reason "the cell is boiling"',
        "pico lease lock",
    ),
)
Wait = Annotated[float, typer.Option("--wait", metavar="SECONDS", min=0, help="Wait so long where somebody has it.")]


@app.callback()
def _group() -> None: ...


@app.command()
def show(context: typer.Context) -> None:
    """Show who has the bench, since when, and who is next.

    Examples:
      pico lease show
      pico lease show --bench shel/bench1 --json
    """
    session = Session.of(context)
    holding = _holding(session)
    session.show(view, holding.far.name, holding.show())


@app.command()
def take(context: typer.Context, wait: Wait = 0.0) -> None:
    """Have the bench until Ctrl-C, for what this checkout does meanwhile.

    A command that moves something takes the bench by itself, for as long as it lasts; this keeps others out in
    between. Leave it open in a terminal of its own. Exit code 5: somebody else has it.

    Examples:
      pico lease take
      pico lease take --wait 600
    """
    session = Session.of(context)
    holding = _holding(session)
    _hold(session, holding, holding.take(wait))


@app.command()
def release(context: typer.Context) -> None:
    """Give the bench back, and end the `pico lease take` of this checkout.

    Examples:
      pico lease release
    """
    session = Session.of(context)
    holding = _holding(session)
    had = holding.release()
    session.show(view, holding.far.name, holding.show(), released=had)


@app.command()
def steal(
    context: typer.Context,
    reason: Annotated[str, typer.Option("--reason", metavar="TEXT", help="Why; who has it is told.")],
    auto_approve: Yes = False,
) -> int:
    """Take the bench from whoever has it, and have it until Ctrl-C.

    What moves for them comes to a safe end first. It is written down with the reason, and needs the role lease:steal.

    Examples:
      pico lease steal --reason "the cell is boiling"
    """
    session = Session.of(context)
    if not reason.strip():
        hint = 'such as `--reason "the cell is boiling"`: it is told to who has the bench'
        raise PicoError(error("usage", "a bench is taken over with a reason", hint=hint))
    session.require_answer(auto_approve)
    holding = _holding(session)
    found = holding.show()
    name, holder = holding.far.name, found["holder"]
    asked = f"Take {name} from {holder['who']}?" if holder else f"Nobody has {name}. Take it?"
    if not session.confirm(asked, auto_approve):
        session.say("Nothing was taken.")
        return 1
    _hold(session, holding, holding.steal(reason))
    return 0


@app.command()
def lock(
    context: typer.Context,
    reason: Annotated[str, typer.Option("--reason", metavar="TEXT", help="Why; who is refused is told.")] = "",
) -> None:
    """Lock the bench for a person at the table: remote, queued and unattended work is refused.

    What goes on for somebody far away, or unattended, comes to a safe end. You are Git's user.name; the lock stays
    until you call `pico lease unlock`, also over reboots. It never keeps anybody from `pico stop` or from shutting a
    laser, and it is not an interlock.

    Examples:
      pico lease lock
      pico lease lock --reason "mirrors are being cleaned"
    """
    from pico.edge.guard.table_lock import lock
    from pico.places.lab import lenient

    session = Session.of(context)
    context.with_resource(lenient())
    place, person = _here(session, safety=True)
    session.say(f"{lock(place, person, reason).said}. `pico lease unlock` takes the lock off.")


@app.command()
def unlock(context: typer.Context) -> None:
    """Take the lock off that you put on with `pico lease lock`.

    Only the person who locked the bench does so, on the machine that has the bench: no remote client can. Exit code 5:
    somebody else locked it.

    Examples:
      pico lease unlock
    """
    from pico.edge.guard.table_lock import unlock

    session = Session.of(context)
    place, person = _here(session)
    found = unlock(place, person)
    session.say("The bench was not locked." if found is None else f"The bench is unlocked ({found.by}).")


def _here(session: Session, *, safety: bool = False) -> tuple[BenchPlace, str]:
    """Return the bench of this machine that a person stands at, and the name of that person."""
    from pico.history.git.command import answer

    try:
        place = session.here(session.root(safety=safety), safety=safety)
    except PicoError as exc:
        hint = "only a person at the table locks a bench, or unlocks it"
        raise PicoError(error("table-lock", exc.diagnostics[0].summary, hint=hint), ExitCode.DENIED) from exc
    person = answer(place.root, ["config", "user.name"]).strip()
    if not person:
        hint = 'say who you are: `git config --global user.name "Ada Lovelace"`'
        raise PicoError(
            error("table-lock", "a bench is locked by a person, and Git's `user.name` is not set", hint=hint)
        )
    return place, person


def _hold(session: Session, holding: Holding, token: int) -> None:
    """Have the bench until somebody ends that."""
    session.show(view, holding.far.name, holding.show())
    session.say("It is yours until Ctrl-C, or `pico lease release` in another terminal.")
    try:
        for _ in holding.renewed(token):
            pass
    except KeyboardInterrupt:
        holding.release()
        session.say("\nIt is given back.")
    except PicoError as exc:
        if not holding.show()["holder"] and exc.diagnostics[0].code == "lost":
            session.say("It was given back.")
            return
        raise


def _holding(session: Session) -> Holding:
    """Return the lease of the bench that is meant; raises PicoError where that is not on the network."""
    from pico.edge.network.holding import Holding
    from pico.edge.network.remotes import Far
    from pico.manifest.load import find_lab

    far = session.place(find_lab(session.folder))
    if not isinstance(far, Far):
        from pico.edge.guard.table_lock import notice

        text = f"the bench `{far.name}` is on this machine: it needs no lease"
        session.tell(notice(far))
        hint = "`--bench LAB/BENCH` means one on the network; `pico remote list` shows where"
        raise PicoError(error("local", text, hint=hint))
    return Holding(far)
