"""The simulator, and the rest, 15: `pico remote`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..arguments import group
from ..session import Session
from ..views import remote as view

if TYPE_CHECKING:
    from pico.edge.network.remotes import Remotes

app = group(
    help="The coordinators that this checkout knows, by name.",
    examples=("pico remote add lab https://lab.example --default shel/bench1", "pico remote list"),
)
Name = Annotated[str, typer.Argument(metavar="NAME", help="What it is called here, such as `lab`.")]
Certificate = Annotated[
    Path | None,
    typer.Option("--certificate", metavar="FILE", help="Its certificate (PEM), where it signed that itself."),
]
Default = Annotated[
    str, typer.Option("--default", metavar="LAB/BENCH", help="The bench that is meant where none is said.")
]


@app.callback()
def _group() -> None: ...


@app.command()
def add(
    context: typer.Context,
    name: Name,
    url: Annotated[str, typer.Argument(metavar="URL", help="Such as https://lab.example.")],
    certificate: Certificate = None,
    default: Default = "",
) -> None:
    """Know a coordinator by a name.

    As git's remotes: kept beside the history, never in a commit. Its benches are then called LAB/BENCH in `--bench`.

    Examples:
      pico remote add lab https://lab.example
      pico remote add lab https://192.168.1.20:8700 --certificate lab.pem
    """
    from pico.edge.network import remotes
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    one = remotes.Remote(remotes.address(url), _pem(session.folder / certificate) if certificate else "")
    known = remotes.added(remotes.known(root), name, one)
    if default:
        known = replace(known, default="/".join(remotes.named(known, default)))
    remotes.keep(root, known)
    _show(session, known)


@app.command("list")
def list_(context: typer.Context) -> None:
    """List the coordinators, and the bench that is meant where none is said.

    Examples:
      pico remote list
    """
    from pico.edge.network import remotes
    from pico.manifest.load import find_lab

    session = Session.of(context)
    _show(session, remotes.known(find_lab(session.folder)))


@app.command()
def remove(context: typer.Context, name: Name) -> None:
    """Know a coordinator no more; tokens stay.

    Examples:
      pico remote remove lab
    """
    from pico.edge.network import remotes
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    known = remotes.removed(remotes.known(root), name)
    remotes.keep(root, known)
    _show(session, known)


def _show(session: Session, known: Remotes) -> None:
    from pico.edge.network.tokens import token_of

    session.show(view, known, {name for name, one in known.named.items() if token_of(one.url)})


def _pem(path: Path) -> str:
    """Return the certificate in a file; raises PicoError for what is none."""
    import ssl

    from pico.diagnostics import PicoError, error

    try:
        text = path.read_text(encoding="ascii")
        ssl.PEM_cert_to_DER_cert(text[text.index("-----BEGIN CERTIFICATE") :].strip())
    except (OSError, ValueError) as exc:
        hint = "PEM: it begins with -----BEGIN CERTIFICATE-----; the one that `pico serve --certificate` has"
        raise PicoError(error("certificate", f"{path} is no certificate: {exc}", hint=hint)) from exc
    return text
