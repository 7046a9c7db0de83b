"""Which commit a change is compared with: one that is named, that continuous integration names, or where its branch
began."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pico.diagnostics import PicoError, error
from pico.history.git.partial import open_handle
from pico.history.repository.repository import Repository
from pico.model.record import record

_DEFAULTS = ("origin/main", "origin/master", "main", "master")
_WHOLE = "fetch the whole history: `fetch-depth: 0` at GitHub, `GIT_DEPTH: 0` at GitLab, `git fetch --unshallow` here"


@record
class ComparisonBase:
    """The commit that a change is compared with, None for nothing at all, and what it is called."""

    commit: str | None = None
    name: str = ""


def comparison_base(
    repository: Repository, revision: str | None = None, environment: Mapping[str, str] | None = None, *, edited: bool
) -> ComparisonBase:
    """Return what to compare with: where HEAD left `revision`, else the branch that continuous integration merges into
    (by `environment`), else the default branch; the commit before where HEAD is on that and nothing was `edited`.

    Raises PicoError for a revision that there is not, and for a clone that does not reach back far enough.
    """
    handle = _handle(repository)
    head = repository.head().commit
    told = (revision, revision) if revision else _told(handle, environment or {})
    wanted, name = told or (_default(handle, environment or {}),) * 2
    if wanted is None or name is None:
        return _before(repository, head, edited)
    goal = _resolved(repository, handle, wanted, revision)
    if head is None:
        return ComparisonBase(commit=goal, name=name)
    common = handle.merge_base(head, goal)
    if common is None and handle.is_shallow:
        text = f"this clone holds only the last commits: where HEAD left {name} is not among them"
        raise PicoError(error("shallow", text, hint=_WHOLE))
    if revision is None and str(common) == head and not edited:
        return _before(repository, head, edited)
    if common is None or str(common) == goal:
        return ComparisonBase(commit=goal, name=name)
    return ComparisonBase(commit=str(common), name=f"where it left {name}")


def _before(repository: Repository, head: str | None, edited: bool) -> ComparisonBase:
    """Return HEAD where something was edited since, else the commit before it."""
    if head is None:
        return ComparisonBase(name="nothing: no commit yet")
    if edited:
        return ComparisonBase(commit=head, name="HEAD")
    parents = repository.resolve(head).parents
    if parents:
        return ComparisonBase(commit=repository.resolve(parents[0]).id, name="the commit before")
    if _handle(repository).is_shallow:
        raise PicoError(error("shallow", "this clone holds the last commit, and not the one before", hint=_WHOLE))
    return ComparisonBase(name="nothing: the first commit")


def _resolved(repository: Repository, handle: Any, name: str, revision: str | None) -> str:
    try:
        return repository.resolve(name).id
    except PicoError:
        if revision is not None and not handle.is_shallow:
            raise
        text = f"the change is to be compared with `{name}`, which this clone does not have"
        raise PicoError(error("shallow", text, hint=_WHOLE)) from None


def _told(handle: Any, environment: Mapping[str, str]) -> tuple[str, str] | None:
    """Return the revision that GitHub or GitLab merges into, as this clone has it, and what it is called."""
    found = list(_candidates(environment))
    return next((one for one in found if _known(handle, one[0])), found[0] if found else None)


def _candidates(environment: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield what may name it, the surest first: GitLab fetches no branch, but names commits."""
    target = environment.get("CI_MERGE_REQUEST_TARGET_BRANCH_NAME", "")
    if commit := environment.get("CI_MERGE_REQUEST_TARGET_BRANCH_SHA"):
        yield commit, target or commit
    for branch in (environment.get("GITHUB_BASE_REF"), target):
        if branch:
            yield from ((name, name) for name in (f"origin/{branch}", branch))
    if commit := environment.get("CI_MERGE_REQUEST_DIFF_BASE_SHA"):
        yield commit, target or commit


def _default(handle: Any, environment: Mapping[str, str]) -> str | None:
    """Return the default branch: what origin's HEAD names, else one called as most are."""
    if "refs/remotes/origin/HEAD" in handle.references:
        target = handle.references["refs/remotes/origin/HEAD"].target
        if isinstance(target, str) and _known(handle, name := target.removeprefix("refs/remotes/")):
            return name
    branch = environment.get("CI_DEFAULT_BRANCH")
    names = (*([f"origin/{branch}"] if branch else []), *_DEFAULTS)
    return next((name for name in names if _known(handle, name)), None)


def _known(handle: Any, name: str) -> bool:
    import pygit2

    try:
        return bool(handle.revparse_single(name).peel(pygit2.Commit))
    except (KeyError, ValueError, pygit2.GitError):
        return False


def _handle(repository: Repository) -> Any:
    return open_handle(repository.root)
