"""`pico run`."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error

from ..arguments import Fidelity, LockTimeout, Seed, Yes
from ..runs.running import say
from ..session import Session
from ..terminal.waiting import waiting
from ..views import recipe as view
from ..views import recipe_progress as progress

HEADING = "Recipes"
ORDER = 10

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from pico.recipes.ahead import Foreseen
    from pico.recipes.log import Log
    from pico.recipes.recipe import Recipe
    from pico.recipes.recipes import Recipes

Given = Annotated[
    list[str] | None,
    typer.Option("-p", "--param", metavar="NAME=VALUE", help="A parameter, with its unit or without; may be repeated."),
]
Until = Annotated[str, typer.Option("--until", metavar="STEP", help="Stop before this step: `3`, `3[2].1`.")]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with what was cut short last, of RECIPE if named.")]
JUnit = Annotated[Path | None, typer.Option("--junit", metavar="FILE", help="Write JUnit XML to FILE.")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Show the steps as far as they are known; move nothing.")]
Detach = Annotated[bool, typer.Option("--detach", help="Leave it to a process of its own, and give the prompt back.")]
Unattended = Annotated[
    bool, typer.Option("--unattended", help="Nobody will be there: hold it to what it states of that.")
]


def run(
    context: typer.Context,
    recipe: Annotated[str | None, typer.Argument(metavar="RECIPE", help="A file, or a name in `recipes/`.")] = None,
    given: Given = None,
    dry_run: DryRun = False,
    until: Until = "",
    resume: Resume = False,
    unattended: Unattended = False,
    seed: Seed = None,
    fidelity: Fidelity = None,
    junit: JUnit = None,
    detach: Detach = False,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Run a recipe: an experiment, step by step.

    It is checked first, and every state that is known in advance is planned; then it asks. Each step is written down:
    after Ctrl-C, a kill or a power cut `pico run --resume` goes on where it was and measures nothing twice. With
    --detach it goes on by itself, of a bench on the network beside its coordinator; `pico runs attach` follows it and
    brings its commits and runs. Exit code 6: an assertion failed. With --json: a line for each step.

    Examples:
      pico run tilt_scan -p tilts='[0, 15, 30]'
      pico run recipes/tilt_scan.yaml --dry-run --seed 1
    """
    from pico.recipes.recipes import Recipes

    session = Session.of(context)
    _require_whole(recipe, resume, given, seed, detach and bool(resume or dry_run or until or junit))
    if junit:
        _require_place(session.folder / junit)
    if not dry_run and not resume:
        session.require_answer(auto_approve)
    bench = session.bench(fidelity, writing=not dry_run)
    recipes = Recipes(bench)
    if resume:
        return _go_on(session, recipes, recipe, dry_run, until, auto_approve, unattended, junit)
    assert recipe is not None
    found = recipes.read(recipe)
    session.tell(found.told)
    arguments = recipes.arguments(found, _pairs(given or []))
    if until:
        recipes.require_step(found, until)
    with waiting("Planning what is known in advance"):
        ahead = recipes.ahead(found, arguments)
    if dry_run or ahead.diagnostics:
        session.show(view, found, ahead)
        session.report(ahead.diagnostics)
        return int(ahead.exit_code)
    if until:
        recipes.require_step(found, until, ahead)
    beside = detach and bench.far is not None
    if detach:
        recipes.require_alone(found, asked=beside)
    alone = _alone(session, recipes, found, arguments, unattended, beside)
    if not _agreed(session, found, ahead, auto_approve, seed):
        session.say("Nothing was done.")
        return int(ExitCode.ERROR)
    if seed is not None:
        bench.sim.reset(seed)
    if beside:
        return _detach(session, recipes, found, given or [], alone)
    if detach:
        return _leave(session, recipes, found, arguments, alone)
    return _carry_out(session, recipes, found, recipes.begin(found, arguments), until, True, alone, junit)


def _require_whole(recipe: str | None, resume: bool, given: list[str] | None, seed: int | None, apart: bool) -> None:
    """Raise PicoError for options that do not go together; `apart`: it is to be left to a process of its own, and
    something else that needs this one."""
    if recipe is None and not resume:
        hint = "`pico run RECIPE`, or `pico run --resume` for the one that was cut short"
        raise PicoError(error("usage", "name a recipe, or say --resume", hint=hint))
    if resume and (seed is not None or given):
        text = "what was cut short goes on with the world and the parameters that it began with"
        raise PicoError(error("usage", text, hint="`pico run --resume` takes neither --seed nor -p"))
    if apart:
        hint = "`pico run RECIPE --detach`, and `pico runs attach` to follow it"
        raise PicoError(error("usage", "--detach goes with none of --resume, --dry-run, --until, --junit", hint=hint))


def _leave(session: Session, recipes: Recipes, recipe: Recipe, arguments: Mapping[str, Any], alone: bool) -> int:
    """Begin a run of a recipe, and leave it to a process of its own."""
    from ..runs.leaving import leave
    from ..views import left

    log = recipes.begin(recipe, arguments)
    leave(session, recipes.bench, log, alone)
    session.show(left, log.about.id, by="in a process of its own on this machine")
    return int(ExitCode.DONE)


def _detach(session: Session, recipes: Recipes, recipe: Recipe, given: list[str], alone: bool) -> int:
    """Leave a run of a recipe to the coordinator of the bench."""
    from ..runs.detached import detach
    from ..views import left

    far = recipes.bench.far
    assert far is not None
    run = detach(recipes.bench, Path(recipe.path), given, alone)
    session.show(left, run, by=f"beside {far.remote.url}")
    return int(ExitCode.DONE)


def _go_on(
    session: Session, recipes: Recipes, named: str | None, dry_run: bool, until: str, auto_approve: bool,
    unattended: bool, junit: Path | None,
) -> int:  # fmt: skip
    """Go on with what was cut short; where others changed the bench since, only once a person said so."""
    from ..runs.asking import at_terminal

    log = recipes.unended(Path(named).stem if named else None)
    found = recipes.taken_up(log)
    if until:
        recipes.require_step(found, until)
    if dry_run:
        ahead = recipes.ahead(found, log.about.arguments, log)
        session.show(view, found, ahead)
        session.report(ahead.diagnostics)
        return int(ahead.exit_code)
    alone = _alone(session, recipes, found, log.about.arguments, unattended)
    if changed := recipes.changed_since(log):
        session.tell([replace(d, severity="warning") for d in changed])
        if auto_approve or not at_terminal(session):
            wrong = _changed(found.name, changed)
            raise PicoError([*(changed if session.json else ()), wrong], ExitCode.STALE)
    return _carry_out(session, recipes, found, log, until, auto_approve, alone, junit)


def _changed(name: str, changed: Sequence[Diagnostic]) -> Diagnostic:
    """Return why a recipe that was cut short does not go on by itself: the bench has changed, or only the checkout."""
    asks = "at a terminal, without -y, `pico run --resume` asks"
    if all(one.code == "checkout-changed" for one in changed):
        text = f"the bench is as {name} left it, but not what is checked out"
        return error("checkout-changed", text, hint=f"go back as said above; {asks}")
    text = f"the bench is not as {name} left it when it was cut short"
    return error("bench-changed", text, hint=f"`pico undo` takes back the last run; {asks}")


def _alone(
    session: Session, recipes: Recipes, recipe: Recipe, arguments: Mapping[str, Any], said: bool, beside: bool = False
) -> bool:  # fmt: skip
    """Return whether nobody is there: that was said, or no terminal is, and the recipe states something of that;
    `beside`: it is run where questions wait for an answer. Raises PicoError where it must not begin so now."""
    from ..runs.asking import asker, at_terminal

    alone = said or (recipe.unattended is not None and not at_terminal(session))
    if not at_terminal(session):
        recipes.require_alone(recipe, asked=beside or asker(session) is not None)
    if alone:
        session.tell(recipes.require_unattended(recipe, arguments))
    return alone


def _agreed(session: Session, recipe: Recipe, ahead: Foreseen, auto_approve: bool, seed: int | None) -> bool:
    session.say(view.head(recipe, ahead))
    if seed is not None:
        session.say(f"It begins in a new simulated world of seed {seed}: every part is at home there.")
    return session.confirm(f"Run {recipe.name}?", auto_approve)


def _carry_out(
    session: Session, recipes: Recipes, recipe: Recipe, log: Log, until: str, agreed: bool, alone: bool,
    junit: Path | None,
) -> int:  # fmt: skip
    from pico.disk import write_whole
    from pico.recipes.rehearsing import Rehearsed
    from pico.recipes.running import Watching

    from ..runs.asking import Terminal, asker, attended
    from ..views.rehearsed import junit as in_junit

    if not agreed and not session.confirm(f"Go on with {recipe.name}, run {log.about.id}?", agreed):
        session.say("Nothing was done.")
        return int(ExitCode.ERROR)
    asking = None if alone else asker(session)
    lines = progress.Lines(recipes.bench.setup)

    def write(found: Any) -> None:
        if session.json:
            session.document(found)
        elif found:
            session.say(found)

    watching = Watching(
        entered=lambda entered: write(progress.data(entered) if session.json else lines.entered(entered)),
        ended=lambda path, told, before: write(
            progress.told(path, told, before) if session.json else lines.ended(path, told, before)
        ),
        until=until,
    )
    how: dict[str, Any] = {"attended": not alone and attended(session), "unattended": alone, "say": say}
    if asking is not None:
        how["ask"] = asking.ask
    if isinstance(asking, Terminal):
        from ..runs.steering import steer

        how["steer"] = lambda jog: steer(session, recipes.bench, jog, None, None)
    began = time.monotonic()
    outcome = recipes.run(recipe, log, watching, **how)
    took = time.monotonic() - began
    if session.json:
        session.document(view.outcome_data(outcome, recipe))
    else:
        session.say(view.outcome(outcome, recipe))
    session.tell(outcome.diagnostics)
    if junit:
        tried = Rehearsed.of(recipe.name, outcome, took)
        write_whole(session.folder / junit, in_junit({recipes.bench.setup.lab.name: [tried]}).encode())
    return int(outcome.exit_code)


def _require_place(path: Path) -> None:
    """Raise PicoError, before anything moves, where no file can be at a path."""
    if path.is_dir() or not path.parent.is_dir():
        why = "it is a folder" if path.is_dir() else "there is no such folder"
        raise PicoError(error("unwritable", f"can't write {path}: {why}", hint="a file in a folder that is there"))


def _pairs(words: list[str]) -> dict[str, str]:
    for word in words:
        if "=" not in word:
            raise PicoError(error("usage", f"-p takes NAME=VALUE, not `{word[:40]}`", hint="`-p tilt='30 deg'`"))
    pairs = [(name.strip(), value) for name, value in (word.split("=", 1) for word in words)]
    names = [name for name, _ in pairs]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise PicoError(error("usage", f"-p gives {twice[:40]} twice", hint="keep one of the two"))
    return dict(pairs)
