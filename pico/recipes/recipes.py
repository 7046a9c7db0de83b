"""Recipes of one lab: found by name, checked, run on its bench, and taken up again."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.base import clock
from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, warning
from pico.manifest.text.source import Source
from pico.recipes.doing import Doing
from pico.recipes.log import About, Log, logs
from pico.recipes.parameters import given_values
from pico.recipes.reader import Able
from pico.recipes.reading import FOLDER, read_recipe
from pico.recipes.recipe import Parameter, Recipe, paths_of
from pico.recipes.running import Outcome, Watching, run_recipe
from pico.recipes.taken_up import otherwise
from pico.recipes.unattended import asking, waiting

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.recipes.ahead import Foreseen

MOST_LISTED = 20
"""Runs of recipes that are looked through for those that can go on."""


@dataclass(frozen=True)
class Listed:
    """A recipe of a lab in a list: `parameters` in words, and as they are (`inputs`); `wrong` where it has mistakes;
    `asks`: the steps that wait for a person, `steered` those of them that want the keys of a terminal."""

    name: str
    title: str
    parameters: str
    wrong: bool
    inputs: tuple[Parameter, ...] = ()
    asks: tuple[str, ...] = ()
    steered: tuple[str, ...] = ()


class Recipes:
    """Recipes on one bench."""

    def __init__(self, bench: Bench, past: Mapping[str, str] | None = None) -> None:
        """`past`: texts of recipes by path, as they were once, instead of those in the files."""
        self.bench = bench
        self.texts: dict[str, bytes] = {}
        self.kept: Mapping[str, str] = past or {}
        self.past = past is not None
        self.broken: list[Diagnostic] = []

    def names(self) -> tuple[str, ...]:
        """Return the recipes of the lab by name: files of its folder `recipes`, without their ending."""
        return tuple(sorted(p.stem for p in (self.bench.root / FOLDER).glob("*.yaml")))

    def path(self, word: str, beside: str = "") -> Path:
        """Return the file of a recipe: a path, or the name of one of the lab; of one that another one calls, also from
        the folder of that. Raises PicoError where there is none."""
        folders = [Path(beside).parent] if beside else [Path()]
        for folder in (*folders, self.bench.root / FOLDER):
            for name in (word, f"{word}.yaml"):
                if (folder / name).is_file() or str((folder / name).resolve()) in self.kept:
                    return folder / name
        known = self.names()
        hint = did_you_mean(word[:40], known) or f"a path, or a file in `{FOLDER}/` of the lab"
        raise PicoError(error("no-recipe", f"there is no recipe `{word[:60]}`", hint=hint))

    def check(self, word: str) -> tuple[Recipe | None, tuple[Diagnostic, ...]]:
        """Return a recipe, and all that is wrong with it on this bench; nothing moves. Raises PicoError where there is
        none of that name, or it can't be read."""
        path = self.path(word)
        made, found = read_recipe(Source(str(path), self._text(path).decode("utf-8", "replace")), self.bench.setup,
                                  self._fetch, self._able())  # fmt: skip
        return made, tuple(found)

    def read(self, word: str) -> Recipe:
        """Return a recipe that is right; raises PicoError with all that is wrong with it."""
        recipe, found = self.check(word)
        if found or recipe is None:
            raise PicoError(found)
        return recipe

    def listed(self) -> tuple[Listed, ...]:
        """Return the recipes of the lab with what they are about."""
        found = []
        for name in self.names():
            recipe, wrong = self.check(name)
            parameters = (
                ", ".join(f"{p.name} [{p.unit}]" if p.unit else p.name for p in recipe.parameters.values())
                if recipe
                else ""
            )
            inputs = tuple(recipe.parameters.values()) if recipe else ()
            asks, steered = (waiting(recipe), waiting(recipe, "keys")) if recipe else ((), ())
            title = recipe.title if recipe else ""
            found.append(Listed(name, title, parameters, bool(wrong) or recipe is None, inputs, asks, steered))
        return tuple(found)

    def arguments(self, recipe: Recipe, given: Mapping[str, str]) -> dict[str, Any]:
        """Return the values of all parameters, of those given as a person writes them; raises PicoError."""
        return given_values(recipe.parameters, given)

    def ahead(self, recipe: Recipe, arguments: Mapping[str, Any], log: Log | None = None) -> Foreseen:
        """Return what is known of a recipe in advance, of one that was cut short what is left of it (`log`); nothing
        moves."""
        from pico.recipes.ahead import foresee

        known = {path: step.told for path, step in (log.steps if log else {}).items() if step.told is not None}
        return foresee(self.bench, recipe, arguments, known)

    def require_unattended(self, recipe: Recipe, arguments: Mapping[str, Any]) -> tuple[Diagnostic, ...]:
        """Return what is to be known of a recipe that begins now with nobody there; raises PicoError (exit code DENIED)
        where it must not."""
        from pico.edge.network.opening import served
        from pico.recipes.guarding import guard_of

        guard_of(self.bench, recipe, arguments).require_start()
        if served(self.bench.place):
            return ()
        text = "only this process holds it to what it states: killed, it leaves the bench as it is to the next one"
        hint = "a bench that is served outlives it: `pico edge`, in a terminal of its own"
        return (warning("unattended", text, hint=hint),)

    def require_step(self, recipe: Recipe, path: str, ahead: Foreseen | None = None) -> None:
        """Raise PicoError where a recipe has no step of this path (`3[2].1`), as far as that is known in advance."""
        known = list(paths_of(recipe))
        there = re.sub(r"\[\d+\]", "", path) in known
        if there and "[" in path and ahead is not None and ahead.whole:
            turns = {f"{e.path}[{e.turn}]" if e.turn else e.path for e, _ in ahead.steps}
            there = any(one == path or one.startswith((f"{path}.", f"{path}[")) for one in turns)
        if not there:
            hint = (
                did_you_mean(path[:40], known)
                if len(known) < 10
                else f"such as `{known[len(known) // 2]}`: `--dry-run` shows them"
            )
            raise PicoError(error("no-step", f"{recipe.name} has no step `{path[:40]}`", hint=hint))

    def require_alone(self, recipe: Recipe, *, asked: bool = False) -> None:
        """Raise PicoError where nobody is at a terminal and a step waits for a person; `asked`: who is elsewhere
        answers what is asked in words."""
        if found := asking(recipe, "keys" if asked else ""):
            raise PicoError(found)

    def begin(self, recipe: Recipe, arguments: Mapping[str, Any]) -> Log:
        """Begin a run of a recipe with the values of all its parameters."""
        from pico.edge.running import new_run_id

        path = str(Path(recipe.path).resolve())
        texts = {p: t.decode("utf-8", "replace") for p, t in self.texts.items()}
        return Log.begin(
            self.bench.place, About(new_run_id(), recipe.name, path, recipe.digest, arguments, clock.now(), texts)
        )

    def cut_short(self) -> tuple[About, ...]:
        """Return the runs of recipes that have no end, the latest first; a log that can't be read is left out."""
        found = (log.about for log in self._logs(MOST_LISTED))
        return tuple(about for about in found if not about.ended)

    def unended(self, word: str | None = None) -> Log:
        """Return the run of a recipe that was cut short last, of the recipe or the id that is named.
        Raises PicoError where there is none, it has ended, or its log can't be read."""
        for log in self._logs():
            if word in (None, log.about.name, Path(log.about.path).stem) and not log.about.ended:
                return log
            if word is not None and log.about.id.startswith(word):
                if not log.about.ended:
                    return log
                text = f"run {log.about.id} of {log.about.name} has ended"
                raise PicoError(error("recipe-ended", text, hint="begin it anew"))
        text = f"no run of {'a recipe' if word is None else f'the recipe {word[:40]}'} was cut short"
        raise PicoError([*self.broken, error("nothing-to-resume", text, hint="`pico recipe` lists what can go on")])

    def _logs(self, most: int | None = None) -> Iterator[Log]:
        """Yield the logs of this bench, the latest first; one that can't be read is kept in `broken`, and one that a
        kill left before its first line is of a run that did nothing."""
        self.broken = []
        for path in logs(self.bench.place)[:most]:
            try:
                yield Log.read(path)
            except PicoError as exc:
                if path.stat().st_size:
                    self.broken += [replace(d, severity="warning") for d in exc.diagnostics]

    def changed_since(self, log: Log) -> tuple[Diagnostic, ...]:
        """Return what is otherwise than a run of a recipe left it; see `pico.recipes.taken_up.otherwise`."""
        return otherwise(self.bench, log)

    def ran(self, word: str | None = None) -> tuple[Recipe, Log]:
        """Return the last run of a recipe, or the last of a recipe of that name, or the one whose id begins so; with
        the recipe as it was then. Raises PicoError where there is none."""
        for log in self._logs():
            if word in (None, log.about.name) or log.about.id.startswith(str(word)):
                return Recipes(self.bench, log.about.texts).read(log.about.path), log
        text = f"no recipe {'was run here' if word is None else f'or run of one is called `{word[:40]}`'}"
        raise PicoError(self._elsewhere(word) or error("run", text, hint="`pico run RECIPE`"))

    def _elsewhere(self, word: str | None) -> Diagnostic | None:
        """Return what is wrong where a recipe was run on another bench, whose runs commits have brought here."""
        carried = [run for run, commit in self.bench.history.runs() if commit is not None and run.cause.recipe]
        names = {run.id: str(run.cause.recipe).partition("@")[0] for run in carried}
        brought = [run for run, name in names.items() if word in (None, name) or run.startswith(str(word))]
        if not brought:
            return None
        name = names[brought[0]]
        text = f"{name} was run on another bench: what it returned is in the log there, in no commit"
        hint = f"there `pico runs plot --recipe {name}`; its runs are here: `pico runs show {brought[0]}`"
        return error("run", text, hint=hint)

    def taken_up(self, log: Log) -> Recipe:
        """Return the recipe of a run that was cut short; raises PicoError where it was edited since. Where its file is
        gone, with the commit that it checked out, it is taken as it was."""
        self.kept = log.about.texts
        recipe = self.read(log.about.path)
        if recipe.digest != log.about.digest:
            text = f"{log.about.path} was edited since run {log.about.id} began"
            raise PicoError(error("recipe-changed", text, hint="begin it anew, without --resume"))
        return recipe

    def run(
        self, recipe: Recipe, log: Log, watching: Watching = Watching(), **how: Any  # noqa: B008
    ) -> Outcome:  # fmt: skip
        """Run a recipe, or go on with it; `how`: see `pico.recipes.doing.Doing`. What goes wrong is in the outcome."""
        return run_recipe(self.bench, recipe, log, Doing(self.bench, **how), watching)

    def _able(self) -> Able:
        able = self.bench.wait(self.bench.edge.describe())
        return Able(measurables=able.measurables, revision=self.bench.history.is_revision)

    def _fetch(self, word: str, caller: str) -> tuple[str, bytes]:
        path = self.path(word, caller)
        return str(path), self._text(path)

    def _text(self, path: Path) -> bytes:
        name = str(path.resolve())
        if name in self.kept and (self.past or not path.exists()):
            self.texts[name] = self.kept[name].encode()
        else:
            self.texts[name] = _read(path)
        return self.texts[name]


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as exc:
        said = (exc.strerror or str(exc)).lower()
        raise PicoError(error("unreadable", f"{path} can't be read: {said}")) from exc
