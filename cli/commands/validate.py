"""`pico validate`."""

from __future__ import annotations

import typer

from ..session import Session
from ..views import validation as view


def validate(context: typer.Context) -> int:
    """Check the manifests.

    All errors at once, each with its place. Asks neither the bench nor Git.
    """
    from pico.manifest.folders import check_folder

    session = Session.of(context)
    checked = check_folder(session.folder)
    if not session.json:
        session.report(checked.diagnostics)
    session.show(view, checked)
    return checked.exit_code
