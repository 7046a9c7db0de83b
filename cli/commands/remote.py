"""`pico remote`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..arguments import group
from ..session import Session
from ..views import remote as view

HEADING = "The simulator, and the rest"
ORDER = 170

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
    str, typer.Option("--default", metavar="LAB/BENCH", help="Choose this bench, as `pico bench use` does.")
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
    from pico.places.choice import write_choice

    session = Session.of(context)
    root = find_lab(session.folder)
    one = remotes.Remote(remotes.address(url), _pem(session.folder / certificate) if certificate else "")
    known = remotes.added(remotes.known(root), name, one)
    word = "/".join(remotes.named(known, default)) if default else ""
    remotes.keep(root, known)
    if word:
        write_choice(root, word)
    _show(session, root)


@app.command("list")
def list_(context: typer.Context) -> None:
    """List the coordinators, and the bench that commands mean if they name none.

    Examples:
      pico remote list
    """
    from pico.manifest.load import find_lab

    session = Session.of(context)
    _show(session, find_lab(session.folder))


@app.command()
def remove(context: typer.Context, name: Name) -> None:
    """Know a coordinator no more; tokens stay.

    Examples:
      pico remote remove lab
    """
    from pico.backends.devices import SIMULATOR
    from pico.edge.network import remotes
    from pico.manifest.load import find_lab
    from pico.places.choice import read_choice, write_choice

    session = Session.of(context)
    root = find_lab(session.folder)
    remotes.keep(root, remotes.removed(remotes.known(root), name))
    if read_choice(root).startswith(f"{name}/"):
        write_choice(root, SIMULATOR)
    _show(session, root)


def _show(session: Session, root: Path) -> None:
    from pico.edge.network import remotes
    from pico.edge.network.tokens import token_of

    known = remotes.known(root)
    tokens = {name for name, one in known.named.items() if token_of(one.url)}
    session.show(view, known, tokens, session.place(root))


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
