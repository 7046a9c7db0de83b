"""Commits to and from other repositories, by the user's own `git push` and `git pull`."""

from __future__ import annotations

from collections.abc import Sequence

from pico.history.git import command as git
from pico.history.repository.repository import Repository
from pico.model.record import record


@record
class Pushed:
    """A ref that was sent: `refs/heads/main`, what it is called there, and what git says of it (`4f2c9a1..8d0e1b2`)."""

    ref: str
    there: str
    summary: str


def push(repository: Repository, words: Sequence[str], *, shown: bool = False) -> tuple[Pushed, ...]:
    """Run `git push WORDS` and return what was sent, up-to-date refs included.

    `shown`: git writes its progress to standard error, and asks there. Raises PicoError with git's words.
    """
    doing, arguments = "push", ["push", "--porcelain", *words]
    said = git.run(repository.root, arguments, doing=doing, hook="pre-push", shown=shown)
    rows = [line.split("\t") for line in said.splitlines() if line.count("\t") == 2]
    pairs = [(row[1].partition(":"), row[2]) for row in rows]
    return tuple(Pushed(ref=ref, there=there, summary=summary) for (ref, _, there), summary in pairs)


def pull(repository: Repository, words: Sequence[str], *, shown: bool = False) -> str:
    """Run `git pull WORDS`, which asks for no message, and return what git says; else as `push`."""
    hook = "pre-merge-commit post-merge pre-rebase"
    return git.run(repository.root, ["pull", "--no-edit", *words], doing="pull", hook=hook, shown=shown)
