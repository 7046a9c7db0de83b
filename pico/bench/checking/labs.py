"""Which labs of a repository are checked, against what, and all of them together."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from pico.bench.checking.candidate import Candidate, Origin, in_folder, in_memory, origin
from pico.bench.checking.questions import CheckRecipes
from pico.bench.checking.steps import check_lab, with_recipes
from pico.bench.checking.verdict import CheckReport, LabChecked
from pico.diagnostics import PicoError, did_you_mean, error
from pico.history.repository.comparison_base import ComparisonBase, comparison_base
from pico.history.repository.repository import Repository
from pico.manifest.load import find_lab, labs_below


def check(
    path: Path,
    revision: str | None = None,
    *,
    merging: str | None = None,
    fidelity: str = "kinematic",
    pictures: Path | None = None,
    environment: Mapping[str, str] | None = None,
    recipes: CheckRecipes | None = None,
) -> CheckReport:
    """Check the lab that `path` lies in, or every lab below it that differs from the base, and return what was found.

    `revision`: what to compare with, see `comparison_base`. `merging`: check what HEAD would be once this
    revision is merged into it, instead of the files as they are, against that revision where no other is named.
    `pictures`: the folder for pictures of what changes. `recipes`: what reads the recipes of a lab; without it they are
    not asked about. Raises PicoError where there is no lab or no such revision,
    and for a merge with conflicts.
    """
    if fidelity not in ("kinematic", "physics"):
        known = ["kinematic", "physics"]
        raise PicoError(error("fidelity", f"there is no fidelity `{fidelity}`", hint=did_you_mean(fidelity, known)))
    roots, alone = _roots(path)
    repository = Repository.discover(roots[0])
    edited = bool(repository and any(repository.changed(root) for root in roots)) and not merging
    base = _base(repository, revision, environment, edited, merging)
    what = _what(repository, edited, merging)
    labs: list[LabChecked] = []
    alike: list[str] = []
    for root in roots:
        candidate, before = _candidate(repository, root, merging), origin(repository, base, root)
        if not alone and _same(candidate, before):
            alike.append(_shown(repository, root))
            continue
        found = check_lab(candidate, before, what=what, fidelity=fidelity, folder=_shown(repository, root))
        if recipes is not None:
            found = with_recipes(found, candidate, recipes, partial(_known, repository))
        labs.append(_drawn(candidate, before, found, pictures, labs))
    return CheckReport(what=what, base=base, labs=tuple(labs), alike=tuple(alike))


def _known(repository: Repository | None, revision: str) -> bool:
    """Return whether there is a revision of this name."""
    try:
        return repository is not None and bool(repository.resolve(revision))
    except PicoError:
        return False


def _roots(path: Path) -> tuple[list[Path], bool]:
    """Return the folders of the labs, and whether it is the one that `path` lies in."""
    try:
        return [find_lab(path)], True
    except PicoError:
        roots = labs_below(path)
        if not roots:
            raise
        return roots, False


def _base(
    repository: Repository | None,
    revision: str | None,
    environment: Mapping[str, str] | None,
    edited: bool,
    merging: str | None,
) -> ComparisonBase:
    if repository is None:
        if named := revision or merging:
            raise PicoError(error("git-none", f"this lab is in no Git repository, so there is no revision `{named}`"))
        return ComparisonBase(name="nothing: no Git repository")
    if merging and revision is None:
        return ComparisonBase(commit=repository.resolve(merging).id, name=merging)
    return comparison_base(repository, revision, os.environ if environment is None else environment, edited=edited)


def _what(repository: Repository | None, edited: bool, merging: str | None) -> str:
    label = repository.head().label if repository else "the manifest"
    if merging:
        return f"{label} merged with {merging}"
    return f"{label} with edits" if edited else label


def _candidate(repository: Repository | None, root: Path, merging: str | None) -> Candidate:
    if merging is None or repository is None:
        return in_folder(root, repository)
    from pico.history.merge.preview import merged_files

    return in_memory(root, merged_files(repository, root, merging))


def _same(candidate: Candidate, before: Origin) -> bool:
    names = {str(Path(path).resolve().relative_to(candidate.root)): data for path, data in candidate.files.items()}
    return names == dict(before.files)


def _shown(repository: Repository | None, root: Path) -> str:
    return (repository.relative(root) or ".") if repository else "."


def _drawn(
    candidate: Candidate, before: Origin, found: LabChecked, pictures: Path | None, others: Sequence[LabChecked]
) -> LabChecked:
    if pictures is None or found.plan is None:
        return found
    from pico.bench.checking.before_after import draw

    alike = sum(lab.lab == found.lab for lab in others)
    stem = f"{found.lab}-{alike + 1}" if alike else found.lab
    return replace(found, pictures=draw(candidate, before, found, pictures, stem))
