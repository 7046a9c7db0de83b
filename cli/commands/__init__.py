"""One file a command."""

from __future__ import annotations

import typer

from . import (
    apply,
    capture,
    catalog,
    checkout,
    commit,
    completion,
    diff,
    drift,
    fmt,
    get,
    init,
    log,
    parts,
    plan,
    render,
    show,
    sim,
    single,
    status,
    validate,
    version,
)  # fmt: skip

COMMANDS = {
    "init": init.init, "status": status.status, "plan": plan.plan, "apply": apply.apply,
    "checkout": checkout.checkout, "validate": validate.validate, "fmt": fmt.fmt, "capture": capture.capture,
    "parts": parts.parts, "commit": commit.commit, "log": log.log, "diff": diff.diff, "show": show.show,
    "drift": drift.drift, "stow": single.stow, "place": single.place, "get": get.get, "home": single.home,
    "render": render.render, "completion": completion.completion, "version": version.version,
}  # fmt: skip
LOOSE = {"do": single.do, "move": single.move, "rotate": single.rotate, "set": single.set_}


def register(app: typer.Typer) -> None:
    """Add every command to `app`."""
    for name, function in COMMANDS.items():
        app.command(name)(function)
    for name, function in LOOSE.items():
        app.command(name, context_settings=single.LOOSE)(function)
    app.add_typer(catalog.app, name="catalog")
    app.add_typer(sim.app, name="sim")
