"""What part of a lab is asked for after `--`: components, single tunables of them, files and folders of manifests."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.history.git import command as git
from pico.history.lab.folder import LabFolder
from pico.model.address import called_now, former_names, read_addresses, renaming_of
from pico.model.diff import Change


@dataclass(frozen=True, slots=True)
class Scope:
    """What was named. `parts`: for each component its tunables, None for all of them. `paths`: relative to the lab.

    Components and paths together narrow: changes of these components that stand in these files.
    """

    parts: Mapping[str, frozenset[str] | None] = field(default_factory=dict)
    paths: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.parts or self.paths)

    def keep(self, changes: Iterable[Change], held: Iterable[str] = ()) -> tuple[Change, ...]:
        """Return the changes that were asked for; `held`: the components that the files of `paths` hold."""
        files = frozenset(held)
        return tuple(c for c in changes if self._named(c) and (not self.paths or c.component in files))

    def covers(self, path: str) -> bool:
        """Return whether a file (relative to the lab) is among the paths, or none were named."""
        below = (PurePosixPath(path), *PurePosixPath(path).parents)
        return not self.paths or any(PurePosixPath(p) in below for p in self.paths)

    def _named(self, change: Change) -> bool:
        some = self.parts.get(change.component, frozenset())
        return not self.parts or some is None or change.tunable in some


def read_scope(folder: LabFolder, words: Sequence[str], at: Path, *, past: bool = False) -> Scope:
    """Return what `words` name; paths are relative to the folder `at`.

    With `past`, a component that the bench does not have now is taken as one that it had, and the former names of one
    that it has are named with it. Raises PicoError for paths
    outside the lab or that no commit has, and for names that nothing has, each with the nearest one.
    """
    parts: list[str] = []
    paths: list[str] = []
    wrong: list[Diagnostic] = []
    inventory = folder.setup.lab.inventory
    for word in words:
        if word.partition(".")[0] in inventory or not _is_path(word, at):
            parts.append(word)
            continue
        try:
            paths.append(_inside(folder, word, at))
        except PicoError as exc:
            wrong += exc.diagnostics
    parts = [called_now(renaming_of(folder.setup.lab), word) for word in parts]
    gone = [word for word in parts if past and word.partition(".")[0] not in inventory]
    try:
        named = dict(read_addresses(folder.setup, [word for word in parts if word not in gone]))
    except PicoError as exc:
        wrong += exc.diagnostics
    if wrong:
        raise PicoError(wrong)
    for word in gone:
        component, _, tunable = word.partition(".")
        named[component] = frozenset({tunable}) if tunable else None
    for name in [*named] if past else ():
        named |= dict.fromkeys(former_names(folder.setup.lab, name), named[name])
    return Scope(named, tuple(dict.fromkeys(paths)))


def unknown_parts(folder: LabFolder, scope: Scope) -> list[Diagnostic]:
    """Return an error for each component of a scope that the bench does not have now."""
    known = {*folder.setup.lab.inventory, *renaming_of(folder.setup.lab)}
    return [
        error(
            "unknown-component",
            f"the lab has no component `{name}`, and no commit that was looked at changed one",
            hint=did_you_mean(name, known) or "`pico catalog parts` lists them",
        )
        for name in scope.parts
        if name not in known
    ]


def _is_path(word: str, at: Path) -> bool:
    return "/" in word or word.endswith((".yaml", ".yml", ".md")) or word in (".", "..") or (at / word).exists()


def _inside(folder: LabFolder, word: str, at: Path) -> str:
    """Return a path relative to the lab, `.` for the lab itself."""
    absolute = (at.resolve() / word).resolve()
    if not absolute.is_relative_to(folder.root):
        hint = f"`git log -- {word}` and `git diff -- {word}` know the rest of the repository"
        raise PicoError(error("outside", f"{word} lies outside the lab {folder.root}", hint=hint))
    inside = absolute.relative_to(folder.root).as_posix()
    if not absolute.exists() and not _was_there(folder, absolute):
        files = [p.relative_to(folder.root).as_posix() for p in folder.root.rglob("*.yaml")]
        hint = did_you_mean(inside, files) or "components are named without a path"
        raise PicoError(error("no-file", f"no commit has {inside}, and it is not here either", hint=hint))
    return inside


def _was_there(folder: LabFolder, path: Path) -> bool:
    repository = folder.history()
    repository.complete()
    asked = ["rev-list", "-1", "--all", "--", f":(literal){repository.relative(path)}"]
    return bool(git.answer(repository.root, asked).strip())
