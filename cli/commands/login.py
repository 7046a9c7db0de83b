"""`pico login`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..session import Session
from ..views import login as view

HEADING = "The simulator, and the rest"
ORDER = 200

if TYPE_CHECKING:
    from pico.edge.network.remotes import Remote


def login(
    context: typer.Context,
    where: Annotated[str, typer.Argument(metavar="URL", help="A coordinator's address, or the name of a remote.")],
    code: Annotated[
        str | None, typer.Option("--code", metavar="CODE", help="The one-time code that an admin made for you.")
    ] = None,
    certificate: Annotated[
        Path | None,
        typer.Option("--certificate", metavar="FILE", help="Its certificate (PEM), where it signed that itself."),
    ] = None,
) -> None:
    """Be known to a coordinator from now on.

    By a one-time code, else by a token, which is asked for (or read from standard input). The token is kept for you
    alone in your own configuration, not in a checkout; the certificate, too. What runs by itself has one in PICO_TOKEN.

    Examples:
      pico login https://lab.example --code 3f7c-91aa
      pico login lab < token
    """
    from pico.edge.network.asking import ask
    from pico.edge.network.tokens import keep_certificate, keep_token

    session = Session.of(context)
    remote = _meant(session, where, certificate)
    token = _exchanged(remote, code.strip()) if code else _asked(remote.url)
    me = ask(remote, "GET", "/whoami", token=token)
    keep_token(remote.url, token)
    if remote.certificate:
        keep_certificate(remote.url, remote.certificate)
    session.show(view, remote.url, me)


def _exchanged(remote: Remote, code: str) -> str:
    """Return the token that a one-time code is good for; raises PicoError."""
    import platform

    from pico.diagnostics import ExitCode, PicoError, error
    from pico.edge.network.asking import ask

    label = f"pico login on {platform.node()}"[:200]
    try:
        return str(ask(remote, "POST", "/login", {"code": code, "label": label})["secret"])
    except PicoError as exc:
        if exc.exit_code is not ExitCode.DENIED:
            raise
        text = f"{remote.url} does not take this code: it was used already, is over, or is mistyped"
        hint = "a code is good for one login; an admin makes another: `pico token invite NAME ROLE@LAB`"
        raise PicoError(error("token", text, hint=hint), ExitCode.DENIED) from exc


def _meant(session: Session, where: str, certificate: Path | None) -> Remote:
    """Return the coordinator of an address, or of a remote of the checkout around; raises PicoError."""
    from pico.diagnostics import PicoError
    from pico.edge.network import remotes
    from pico.manifest.load import find_lab

    try:
        known = dict(remotes.known(find_lab(session.folder)).named)
    except PicoError:  # no lab is needed to log in
        known = {}
    if where in known:
        return known[where]
    url = remotes.address(where)
    if certificate is not None:
        from .remote import _pem

        return remotes.Remote(url, _pem(session.folder / certificate))
    return next((one for one in known.values() if one.url == url), remotes.Remote(url))


def _asked(url: str) -> str:
    from pico.diagnostics import PicoError, error

    if sys.stdin is not None and sys.stdin.isatty():
        from getpass import getpass

        found = getpass(f"Token for {url}: ").strip()
    else:
        found = sys.stdin.readline().strip() if sys.stdin is not None else ""
    if not found:
        raise PicoError(error("token", "no token was given", hint="an admin makes one: `pico token`"))
    return found
