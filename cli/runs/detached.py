"""A recipe that is run beside the coordinator of its bench, with what this checkout holds, and what comes back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pico.base.plain_files import read_text
from pico.base.state_files import DETACHED
from pico.diagnostics import ExitCode, PicoError, error
from pico.disk import write_whole

from ..session import Session
from ..views import detached as view

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.edge.network.remotes import Far


@dataclass(frozen=True)
class Sent:
    """A run at a desk, and the commit that it began with."""

    run: str
    commit: str


def detach(bench: Bench, recipe: Path, given: Sequence[str], unattended: bool) -> str:
    """Have a recipe run beside the coordinator of a bench, with what this checkout holds; return the run's id. Raises
    PicoError."""
    from pico.edge.network.asking import ANSWER, ask
    from pico.history.repository.sending import send, snapshot

    far = _far(bench)
    path = recipe.resolve()
    if not path.is_relative_to(bench.root):
        hint = f"put it into {bench.root / 'recipes'}"
        raise PicoError(error("recipe", f"{recipe} is no file of this lab, and only that goes along", hint=hint))
    commit = snapshot(bench.root)
    send(bench.root, far, commit)
    words = [path.relative_to(bench.root).as_posix(), *(word for one in given for word in ("-p", one)), "-y"]
    wanted = {"words": [*words, *(["--unattended"] if unattended else [])], "bench": far.bench, "at": commit}
    run = str(ask(far.remote, "POST", f"{_desk(far)}/run", {**wanted, "detach": True}, wait=ANSWER)["run"])
    write_whole(_kept(far), "".join(f"{s.run} {s.commit}\n" for s in (*_sent(far), Sent(run, commit))).encode())
    return run


def detached(bench: Bench, word: str | None) -> Sent | None:
    """Return the run that this checkout left to the coordinator whose id begins or ends with `word`, without one the
    last whose results it has not; None where there is none."""
    if bench.far is None:
        return None
    for one in reversed(_sent(bench.far)):
        if word is None or one.run.startswith(word) or one.run.endswith(word):
            return one
    return None


def follow(session: Session, bench: Bench, sent: Sent) -> int:
    """Show what such a run says until it is over, with somebody at a terminal who answers what it asks, and have its
    commits and runs here; return its exit code."""
    from pico.edge.network.asking import ask, lines
    from pico.edge.network.session import begun
    from pico.history.repository.sending import fetch

    from .asking import at_terminal
    from .following import Following

    far, code = _far(bench), int(ExitCode.ERROR)
    at = f"{_desk(far)}/runs/{sent.run}"
    answered = at_terminal(session)
    for document in Following(session, far.remote, at).documents() if answered else lines(far.remote, f"{at}/events"):
        if "exit" in document and "schema" not in document:
            code = int(document["exit"])
        elif session.json:
            session.document(document)
        elif said := view.line(document):
            session.say(said)
    about = ask(far.remote, "GET", at)
    for run in about["runs"]:
        begun(far.folder, run)
    branch = f"detached/{sent.run}"
    commit = fetch(bench.root, far, about["branch"], branch, sent.commit)
    session.show(view, about, branch if commit else "")
    left = [one for one in _sent(far) if one != sent]
    write_whole(_kept(far), "".join(f"{s.run} {s.commit}\n" for s in left).encode())
    return code


def _far(bench: Bench) -> Far:
    assert bench.far is not None
    return bench.far


def _desk(far: Far) -> str:
    return f"/labs/{far.lab}/desk"


def _kept(far: Far) -> Path:
    return DETACHED.path(far.folder)


def _sent(far: Far) -> tuple[Sent, ...]:
    try:
        found = [line.split() for line in read_text(_kept(far), "ascii").splitlines()]
    except (OSError, UnicodeError):
        return ()
    return tuple(Sent(*words) for words in found if len(words) == 2)
