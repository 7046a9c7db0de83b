"""`pico show`."""

from __future__ import annotations

import typer

from pico.model.plan import Plan

from ..arguments import PlanOrRevision
from ..session import Session
from ..terminal.paging import paged
from ..views import plan as plan_view
from ..views import revision as revision_view

HEADING = "History"
ORDER = 50


def show(context: typer.Context, what: PlanOrRevision = None) -> None:
    """Show a revision or a saved plan.

    Of a revision (HEAD without an argument): what it changed, its runs and what proves it, and the state that it
    holds. `REV:COMPONENT`: that component alone, with what was noted on it. Text of files: `git show REV:FILE`.

    Examples:
      pico show e1
      pico show e1:p2
    """
    session = Session.of(context)
    history = session.history()
    found = history.find(what or "HEAD", folder=session.folder)
    if isinstance(found, Plan):
        session.show(plan_view, found, goal=history.goal_name(found), next_step=f"Apply with `pico apply {what}`.")
        return
    shown = history.show(found)
    with paged(session):
        session.show(revision_view, shown)
