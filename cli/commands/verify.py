"""History, 9: `pico verify`."""

from __future__ import annotations

import typer

from ..arguments import Revision
from ..session import Session
from ..views import verified as view


def verify(context: typer.Context, revision: Revision = None) -> int:
    """Check that the bench is as the manifest says, and that its expectations hold. Moves nothing.

    Says as well whether any bench ever stood as that commit (HEAD without one) says: which run led there, and whether
    that was simulated. It exits the same either way.

    Exits with 6 where an expectation fails or can't be told, with 1 where something stands elsewhere than it should.
    """
    session = Session.of(context)
    found = session.bench().verify(revision)
    session.show(view, found)
    if found.standing and not session.json:
        session.report(found.standing.diagnostics)
    return found.exit_code
