"""What history is made of, as data."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime


@dataclass(frozen=True, slots=True)
class Commit:
    """One commit, written at `time`. `refs`: the tags, then the local, then the remote branches that point at it."""

    id: str
    parents: tuple[str, ...]
    summary: str
    message: str
    author: str
    time: datetime
    refs: tuple[str, ...] = ()

    @property
    def short(self) -> str:
        """The first seven characters of the id."""
        return self.id[:7]

    @property
    def label(self) -> str:
        """What to call it: a tag or branch at it, else the short id."""
        return self.refs[0] if self.refs else self.short


@dataclass(frozen=True, slots=True)
class Head:
    """What is checked out. No `commit` where nothing was committed yet, no `branch` where HEAD is detached."""

    commit: str | None
    branch: str | None
    label: str
