"""What git has begun and not ended in a working tree: a merge, a cherry-pick, a revert, a rebase."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pico.diagnostics import PicoError, error
from pico.history.git import command as git

Underway = Literal["", "merge", "cherry-pick", "revert", "rebase"]

_MARKS: dict[Underway, tuple[str, ...]] = {
    "rebase": ("rebase-merge", "rebase-apply"),
    "merge": ("MERGE_HEAD",),
    "cherry-pick": ("CHERRY_PICK_HEAD",),
    "revert": ("REVERT_HEAD",),
}


def underway(own: Path) -> Underway:
    """Return what is under way, as the folder of git that belongs to a working tree shows it."""
    return next((name for name, marks in _MARKS.items() if any((own / m).exists() for m in marks)), "")


def refuse_begun(own: Path, way: str) -> None:
    """Raise PicoError where git has begun something that comes to its end before a `way` can begin."""
    begun = underway(own)
    if begun:
        ends = "git rebase --continue" if begun == "rebase" else "pico commit"
        hint = f"`{ends}` ends it, `git {begun} --abort` takes it back"
        raise PicoError(error("git-merging", f"a {begun} is under way: no {way} before it has ended", hint=hint))


def require_resolved(root: Path, own: Path) -> Underway:
    """Return what a commit would end: nothing, a merge, a cherry-pick or a revert.

    Raises PicoError that names the files in conflict, and for a rebase, which only git goes on with.
    """
    found = underway(own)
    if found == "merge" and _made(root, own):
        git.run(root, ["merge", "--quit"], doing="forget a merge that was made")
        found = underway(own)
    files = _conflicts(root, own)
    begun = f"a {found} is under way" if found else "files were merged (`git stash pop`, perhaps)"
    ended = "`git rebase --continue`" if found == "rebase" else "`pico commit`"
    if files:
        named = ", ".join(files[:5]) + (f" and {len(files) - 5} more" if len(files) > 5 else "")
        back = f"; or `git {found} --abort`" if found else ""
        hint = f"keep the values that you want in each, `git add` it, then {ended}{back}"
        raise PicoError(error("merge-conflict", f"{begun}, with conflicts in {named}", hint=hint))
    if found == "rebase":
        text = "a rebase is under way: it commits by itself what it has put on top"
        raise PicoError(error("git-rebasing", text, hint="`git rebase --continue`, or `git rebase --abort`"))
    return found


def _conflicts(root: Path, own: Path) -> list[str]:
    """Return the files of which the index has more than one side; git itself is asked for an index that only it
    reads (a split or sparse one)."""
    import pygit2

    try:
        sides = pygit2.Index(str(git.index(root, own))).conflicts
    except (pygit2.GitError, OSError, ValueError):
        listed = git.run(root, ["ls-files", "--unmerged", "-z"], doing="list the conflicts").split("\0")
        return sorted({entry.partition("\t")[2] for entry in listed if entry})
    return sorted({one.path for entry in sides or () for one in entry if one is not None})


def _made(root: Path, own: Path) -> bool:
    """Whether HEAD is the merge under way: git was killed after it had written that, and before it forgot it."""
    sides = (own / "MERGE_HEAD").read_text(encoding="ascii", errors="replace").split()
    return set(sides) <= set(git.answer(root, ["rev-parse", "HEAD^@"]).split())


def message_of(own: Path) -> str:
    """Return the message that git has prepared for what is under way, without its comments; empty for none."""
    try:
        text = (own / "MERGE_MSG").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
    return "\n".join(line for line in text.splitlines() if not line.startswith("#")).strip()
