"""Shallow clones (`git clone --depth 1`): which commits lack their parents there, and the command that fetches them."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

from pico.diagnostics import Diagnostic, error

_FETCH = "git fetch --unshallow --tags"


def boundary(common: Path) -> frozenset[str]:
    """Return the ids of the commits whose parents a clone does not have; none of a clone that is whole. `common`: the
    folder of Git's own files that all worktrees share."""
    try:
        return frozenset((common / "shallow").read_text(encoding="utf-8").split())
    except OSError:
        return frozenset()


def fetching(handle: Any) -> str:
    """Return the command that makes a shallow clone whole, with the branches that it was told to leave out."""
    single = None
    with suppress(KeyError, IndexError):
        remote = handle.remotes[0]
        single = remote.name if not any("*" in spec for spec in remote.fetch_refspecs) else None
    return f"git remote set-branches {single} '*' && {_FETCH}" if single else _FETCH


def lacking_parents(handle: Any) -> str:
    """Return why it is unknown what a commit at the boundary of a shallow clone changed."""
    return f"changes unknown: this clone is shallow and lacks the commit before (`{fetching(handle)}`)"


def cut_off(handle: Any, what: str) -> Diagnostic:
    """Return the error for something that a shallow clone lacks; `what`: the rest of a sentence, such as "it does not
    have `C1`"."""
    hint = f"`{fetching(handle)}` fetches the whole history; then run the command again"
    return error("shallow", f"this clone is shallow (made with `--depth`), and {what}", hint=hint)
