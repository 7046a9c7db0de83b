"""The bisection that git keeps: its ends, its verdicts and its log. Nothing is checked out.

All of it is Git's own (`git bisect log`, `replay`, `visualize` and `reset` work); what git has no word for (the
expectation, what a trial took) are comments in its log, which git passes over.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from pico.diagnostics import PicoError, error
from pico.disk import writing
from pico.history.git import command as git
from pico.history.git.partial import open_handle
from pico.history.git.shallow import cut_off

Verdict = Literal["good", "bad", "skip"]
NOTE = "# pico: "
HEAD = "BISECT_HEAD"
"""The commit under trial: what `git bisect good` without a name is about."""


@dataclass(frozen=True)
class Ends:
    """The commits that were judged: the last bad one, all good and all skipped ones."""

    bad: str | None
    good: tuple[str, ...]
    skipped: frozenset[str]


class GitBisect:
    """The bisection under way in the working tree `root`. `GitBisect.under_way` finds it, `GitBisect.start` begins
    one."""

    def __init__(self, root: Path) -> None:
        self.root = root

    @classmethod
    def under_way(cls, root: Path) -> GitBisect | None:
        """Return the bisection that git knows of, or None."""
        found = cls(root)
        return found if found._path("BISECT_START").exists() else None

    @classmethod
    def start(cls, root: Path, bad: str, good: str) -> GitBisect:
        """Begin one between two commit ids; files stay as they are. Raises PicoError in git's words."""
        found = cls(root)
        found._git("start", "--no-checkout", bad, good, doing="begin to bisect")
        return found

    @property
    def detached_from_files(self) -> bool:
        """Whether it leaves the files alone, as one begun with `--no-checkout` does."""
        return self._path(HEAD).exists()

    def ends(self) -> Ends:
        """Return what was judged so far."""
        bad_term, good_term = self.terms()
        listed = self._run("for-each-ref", "--format=%(objectname) %(refname:lstrip=2)", "refs/bisect")
        bad, good, skipped = None, [], set()
        for line in listed.splitlines():
            commit, _, name = line.partition(" ")
            if name == bad_term:
                bad = commit
            elif name.startswith(f"{good_term}-"):
                good.append(commit)
            elif name.startswith("skip-"):
                skipped.add(commit)
        return Ends(bad, tuple(good), frozenset(skipped))

    def terms(self) -> tuple[str, str]:
        """Return the words for bad and good, which the user may have chosen."""
        path = self._path("BISECT_TERMS")
        words = path.read_text(encoding="utf-8").split() if path.exists() else []
        return (words[0], words[1]) if len(words) == 2 else ("bad", "good")

    def suspects(self, ends: Ends) -> list[tuple[str, tuple[str, ...]]]:
        """Return the commits that may be the first bad one, parents first, each with its parents; the last is bad."""
        if ends.bad is None:
            return []
        spoken = ["rev-list", "--topo-order", "--reverse", "--parents", ends.bad, *(f"^{g}" for g in ends.good)]
        lines = [line.split() for line in self._run(*spoken).splitlines()]
        return [(commit, tuple(parents)) for commit, *parents in lines]

    def unproven(self, ends: Ends) -> list[str]:
        """Return the forks of good commits that are no ancestors of the bad one: they must be good, too, for else what
        is bad may have been mended in between."""
        found: list[str] = []
        for good in ends.good:
            forks = git.answer(self.root, ["merge-base", "--all", str(ends.bad), good]).split()
            found += [f for f in forks if f not in ends.good and f not in ends.skipped and f not in found]
        return found

    def tell(self, verdict: Verdict, commits: Sequence[str]) -> str:
        """Tell git a verdict and return what it says; that nothing is left to try is no error."""
        bad_term, good_term = self.terms()
        word = {"good": good_term, "bad": bad_term}.get(verdict, verdict)
        return self._git(word, *commits, doing=f"take note of a {word} commit", ends=(0, 2, 3))

    def point(self, commit: str) -> None:
        """Say which commit is under trial: it is what `git bisect good` is then about."""
        self._run("update-ref", "--no-deref", HEAD, commit)

    def pointed(self) -> str | None:
        """Return the commit under trial."""
        return git.answer(self.root, ["rev-parse", "--verify", "--quiet", HEAD]).strip() or None

    def began_at(self) -> str:
        """Return the branch, or else the commit, that was checked out when it began."""
        return self._path("BISECT_START").read_text(encoding="utf-8").strip()

    def note(self, what: Mapping[str, Any]) -> None:
        """Append a comment to git's log: on the disk when this returns."""
        import os

        line = NOTE + json.dumps(what, ensure_ascii=False, sort_keys=True) + "\n"
        path = self._path("BISECT_LOG")
        with writing(path), path.open("a", encoding="utf-8") as log:
            log.write(line)
            log.flush()
            os.fsync(log.fileno())

    def notes(self) -> list[dict[str, Any]]:
        """Return the comments, oldest first; one that can't be read is passed over."""
        found = []
        for line in self.log().splitlines():
            if line.startswith(NOTE):
                try:
                    found.append(json.loads(line.removeprefix(NOTE)))
                except ValueError:
                    continue
        return [one for one in found if isinstance(one, dict)]

    def log(self) -> str:
        """Return git's own log."""
        path = self._path("BISECT_LOG")
        return path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""

    def reset(self) -> str:
        """End it; files and bench stay as they are."""
        return self._git("reset", doing="end the bisection")

    def _path(self, name: str) -> Path:
        return self._folder / name

    @cached_property
    def _folder(self) -> Path:
        """Git's folder of this working tree."""
        return Path(self._run("rev-parse", "--absolute-git-dir").removesuffix("\n"))

    def _run(self, *arguments: str) -> str:
        return git.run(self.root, arguments, doing="bisect")

    def _git(self, *arguments: str, doing: str, ends: Sequence[int] = (0,)) -> str:
        return git.run(self.root, ["bisect", *arguments], doing=doing, ends=ends)


def require_order(root: Path, bad: str, good: str, names: tuple[str, str]) -> None:
    """Raise PicoError where nothing can lie between a bad and a good commit; `names` is how the user calls them."""
    if bad == good:
        raise PicoError(error("bisect", f"{names[0]} and {names[1]} are the same commit", hint="name a good one"))
    forks = git.answer(root, ["merge-base", bad, good]).split()
    if bad in forks:
        text = f"{names[0]} comes before {names[1]}: what is bad there was mended later"
        raise PicoError(error("bisect", text, hint=f"the other way around? `pico bisect start {names[1]} {names[0]}`"))
    if not forks:
        if git.answer(root, ["rev-parse", "--is-shallow-repository"]).strip() == "true":
            what = f"does not reach back to a commit that {names[0]} and {names[1]} have in common"
            raise PicoError(cut_off(open_handle(root), what))
        text = f"{names[0]} and {names[1]} have no history in common"
        raise PicoError(error("bisect", text, hint="name a good ancestor"))
