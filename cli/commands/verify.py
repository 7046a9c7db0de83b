"""`pico verify`."""

from __future__ import annotations

import typer

from ..arguments import Revision
from ..session import Session
from ..views import verified as view


def verify(context: typer.Context, revision: Revision = None) -> int:
    """Check that the bench is as the manifest says, and that its expectations hold. Moves nothing.

    Exits with 6 where an expectation fails or can't be told, with 1 where something stands elsewhere than it should.
    """
    session = Session.of(context)
    found = session.bench().verify(revision)
    session.show(view, found)
    return found.exit_code
