"""`pico look`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode
from pico.model.request import require_component

from ..session import Session
from ..terminal.waiting import waiting
from ..views import find, scan

HEADING = "The simulator, and the rest"
ORDER = 50

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.bench.bench import Bench

Part = Annotated[
    str | None, typer.Argument(metavar="COMPONENT", help="Where this one is; without it, where every part is.")
]
Picture = Annotated[Path | None, typer.Option("--picture", metavar="PNG", help="What a camera sees, names drawn in.")]


def look(context: typer.Context, component: Part = None, picture: Picture = None) -> int:
    """Look through the cameras: where parts are, and how surely.

    Of a component its pose, the nearest hole of the table and its slot. Moves nothing and writes nothing into the
    manifests. Exits with 1 where nobody sees the component, and where cameras are dark or have moved or a part can't
    be told from another.

    Examples:
      pico look
      pico look p2 --picture p2.png
    """
    session = Session.of(context)
    bench = session.bench()
    if component is not None:
        require_component(bench.setup, component)
    with waiting("Looking"):
        seen = bench.cameras.scan()
    return _all(session, bench, seen, picture) if component is None else _one(session, bench, seen, component, picture)


def _all(session: Session, bench: Bench, seen: Look, picture: Path | None) -> int:
    session.show(scan, bench.setup, seen)
    session.tell(seen.observation.problems)
    session.draw(picture, "what the cameras see", lambda path: bench.cameras.picture(seen, out=path))
    wrong = any(problem.severity == "error" for problem in seen.observation.problems)
    return ExitCode.ERROR if wrong else ExitCode.DONE


def _one(session: Session, bench: Bench, seen: Look, part: str, picture: Path | None) -> int:
    from pico.bench.cameras import problems_of

    found, problems = seen.observation.components[part], problems_of(seen, part)
    session.show(find, bench.setup, part, found, problems)
    session.tell([p for p in problems if p.severity != "note"])
    if found.pose is not None:
        draw = partial(bench.cameras.picture, seen, component=part)
        session.draw(picture, f"what is around {part}", lambda path: draw(out=path))
    wrong = found.pose is None or any(p.severity == "error" for p in problems)
    return ExitCode.ERROR if wrong else ExitCode.DONE
