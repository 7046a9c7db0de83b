"""A commit made as an object, which no branch has yet: hooks run, and it is signed, as in `git commit`."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from pico.diagnostics import PicoError, error
from pico.history.git import command as git
from pico.history.writing.locked_git import LockedGit


@dataclass(frozen=True)
class NewCommit:
    """A commit to be made: its tree and message, whom it merges, and whose change it is where not of who commits.

    `name`: what to call it where it can't be made.
    """

    tree: str
    message: str
    merges: tuple[str, ...] = ()
    author: tuple[str, datetime] | None = None
    name: str = ""

    @property
    def doing(self) -> str:
        """Completes "git did not ..."."""
        return f"commit {self.name}".strip()


def make(under: LockedGit, step: NewCommit, parent: str) -> str:
    """Make a commit on `parent`, and return its id; the index of `under`, and the files, are as it shall have them.

    A hook may change index and message, and refuse: raises PicoError with its words, or with git's.
    """
    if not (step.merges and under.hook("pre-merge-commit", doing=step.doing)):
        under.hook("pre-commit", doing=step.doing)
    tree = under.git("write-tree", doing=step.doing).strip()
    message = _message(under, step)
    if not message.strip():
        raise PicoError(error("message", "a hook left nothing of the message", hint="a commit needs one"))
    sign = git.answer(under.at.root, ["config", "--type=bool", "commit.gpgSign"]).strip() == "true"
    above = [word for one in (parent, *step.merges) for word in ("-p", one)]
    words = ["commit-tree", *(["-S"] if sign else []), *above, tree]
    return under.git(*words, doing=step.doing, stdin=message, extra=_author(step)).strip()


def _message(under: LockedGit, step: NewCommit) -> str:
    """Return the message as the hooks leave it, cleaned up as git does where no editor was open."""
    path = under.at.own / "COMMIT_EDITMSG"
    path.write_text(step.message, encoding="utf-8")
    under.hook("prepare-commit-msg", str(path), "merge" if step.merges else "message", doing=step.doing)
    under.hook("commit-msg", str(path), doing=step.doing)
    said = path.read_text(encoding="utf-8", errors="surrogateescape")
    return under.git("stripspace", doing="read the message", stdin=said)


def _author(step: NewCommit) -> dict[str, str]:
    if step.author is None:
        return {}
    name, _, mail = step.author[0].rpartition(" <")
    when = step.author[1].isoformat()
    return {"GIT_AUTHOR_NAME": name, "GIT_AUTHOR_EMAIL": mail.removesuffix(">"), "GIT_AUTHOR_DATE": when}
