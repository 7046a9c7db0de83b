"""`pico token`: who is known to a coordinator, and what they may."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import group
from ..session import Session
from ..views import token as view

HEADING = "The simulator, and the rest"
ORDER = 220

if TYPE_CHECKING:
    from pico.edge.network.remotes import Remote

app = group(
    help="Tokens, and who may do what at a coordinator.",
    examples=("pico token invite anna operator@shel", "pico token list"),
)
At = Annotated[
    str | None,
    typer.Option("--remote", metavar="NAME|URL", help="At which coordinator, where the checkout knows not just one."),
]
Who = Annotated[str, typer.Argument(metavar="NAME", help="A person or a program.")]
Roles = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="ROLE[@LAB]...",
        help="viewer, operator, admin, laser:enable, lease:steal, teleop; without @LAB in all labs.",
    ),
]


@app.callback()
def _group() -> None: ...


@app.command("list")
def list_(context: typer.Context, remote: At = None) -> None:
    """List the tokens that last: your own, and all where you are an admin.

    Examples:
      pico token list
    """
    session = Session.of(context)
    session.show(view, tokens=_ask(session, remote, "GET", "/tokens"))


@app.command()
def people(context: typer.Context, remote: At = None) -> None:
    """List who is known, and what they may; for admins.

    Examples:
      pico token people
    """
    session = Session.of(context)
    session.show(view, people=_ask(session, remote, "GET", "/principals"))


@app.command()
def add(
    context: typer.Context,
    label: Annotated[str, typer.Argument(metavar="[LABEL]", help="What it is for.")] = "",
    role: Annotated[
        list[str] | None,
        typer.Option("--role", metavar="ROLE[@LAB]", help="It carries this alone; may be given again."),
    ] = None,
    days: Annotated[float, typer.Option("--days", metavar="N", min=0.001, max=366, help="How long it lasts.")] = 30.0,
    of: Annotated[str | None, typer.Option("--of", metavar="NAME", help="Of somebody else, as an admin.")] = None,
    remote: At = None,
) -> None:
    """Make a token, for a program say, that may no more than you; it is shown once.

    Examples:
      pico token add "night runs" --role operator@shel --days 7
    """
    session = Session.of(context)
    wanted = {"principal": of, "days": days, "label": label, "scope": role}
    session.show(view, made=_ask(session, remote, "POST", "/tokens", wanted), url=_meant(session, remote).url)


@app.command()
def invite(context: typer.Context, name: Who, roles: Roles = None, remote: At = None) -> None:
    """Make a code by which somebody logs in once, within two days; with roles, these are what they may.

    Examples:
      pico token invite anna operator@shel lease:steal@shel
    """
    session = Session.of(context)
    if roles:
        _ask(session, remote, "PUT", f"/principals/{_word(name)}", {"rights": roles})
    made = _ask(session, remote, "POST", "/tokens", {"kind": "code", "principal": name, "days": 2})
    session.show(view, made=made, url=_meant(session, remote).url)


@app.command()
def role(context: typer.Context, name: Who, roles: Roles = None, remote: At = None) -> None:
    """Say what somebody may from now on, also with the tokens that they have; nothing where no role is named.

    Examples:
      pico token role anna operator@shel teleop@shel
    """
    session = Session.of(context)
    wanted = {"rights": roles or [], "disabled": not roles}
    session.show(view, people=[_ask(session, remote, "PUT", f"/principals/{_word(name)}", wanted)])


@app.command()
def revoke(
    context: typer.Context,
    token: Annotated[str, typer.Argument(metavar="ID", help="As `pico token list` shows it.")],
    remote: At = None,
) -> None:
    """End a token at once.

    Examples:
      pico token revoke 3f7c91aa02bd
    """
    session = Session.of(context)
    _ask(session, remote, "DELETE", f"/tokens/{_word(token)}")
    session.say(f"Token {token} lets nobody in any more.")


@app.command()
def enrol(
    context: typer.Context,
    bench: Annotated[str, typer.Argument(metavar="LAB/BENCH", help="What it is to be called.")],
    remote: At = None,
) -> None:
    """Make a code by which the edge of a bench is enrolled, once.

    Examples:
      pico token enrol shel/bench1
    """
    session = Session.of(context)
    made = _ask(session, remote, "POST", "/enrolments", {"bench": bench})
    session.show(view, enrolment=made, url=_meant(session, remote).url)


@app.command()
def audit(
    context: typer.Context,
    since: Annotated[int, typer.Option("--since", metavar="N", min=0, help="What came after entry N.")] = 0,
    remote: At = None,
) -> int:
    """Show who did what at a coordinator, for admins; exit code 1 where entries were changed or are missing.

    Examples:
      pico token audit --since 120
    """
    session = Session.of(context)
    found = _ask(session, remote, "GET", f"/audit?since={since}")
    session.show(view, audit=found)
    return ExitCode.DONE if found["broken"] is None else ExitCode.ERROR


def _word(name: str) -> str:
    from urllib.parse import quote

    return quote(name, safe="")


def _ask(session: Session, remote: str | None, method: str, path: str, body: Any = None) -> Any:
    from pico.edge.network.asking import ask

    return ask(_meant(session, remote), method, path, body)


def _meant(session: Session, said: str | None) -> Remote:
    """Return the coordinator that is meant: by its name or address, else the only one that the checkout knows, else the
    only one that there is a token for. Raises PicoError."""
    from pico.edge.network import remotes
    from pico.edge.network.tokens import places
    from pico.manifest.load import find_lab

    try:
        known = dict(remotes.known(find_lab(session.folder)).named)
    except PicoError:  # an admin needs no lab
        known = {}
    if said is not None:
        if said in known:
            return known[said]
        url = remotes.address(said)
        return next((one for one in known.values() if one.url == url), remotes.Remote(url))
    found = list(known.values()) or [remotes.Remote(url) for url in places()]
    if len(found) != 1:
        text = "which coordinator?" if found else "no coordinator is known here"
        hint = "`--remote NAME|URL` says which" if found else "`pico login URL`, then `--remote URL`"
        raise PicoError(error("remote", text, hint=hint))
    return found[0]
