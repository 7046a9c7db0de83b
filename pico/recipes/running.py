"""A recipe on a bench: walked step by step, each written down; taken up again where it was cut short."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.edge.unattended import ended
from pico.model.trace.unattended import Left
from pico.model.vocabulary import values_of
from pico.recipes.doing import Doing
from pico.recipes.guarding import Guard, guard_of
from pico.recipes.log import UNWRITTEN, Log
from pico.recipes.one_run import OneRun
from pico.recipes.recipe import Act, Recipe
from pico.recipes.registry import step_file
from pico.recipes.taken_up import checked_out, settle
from pico.recipes.walking import Ask, Entered, Told, walk

if TYPE_CHECKING:
    from pico.bench.bench import Bench


@dataclass(frozen=True)
class Outcome:
    """How a run of a recipe ended: `done`, `failed` or `interrupted`; what it `returns`; how many steps acted, and how
    many of them had been done before it was taken up; what went wrong at which step (`at`: `3[2].1`), and the exit
    code. `runs`: those on the bench, in order. `left`: how it left the bench, of what it states of that, where nobody
    was there."""

    id: str
    outcome: str
    at: str = ""
    returns: Mapping[str, Any] = field(default_factory=dict)
    acted: int = 0
    before: int = 0
    diagnostics: tuple[Diagnostic, ...] = ()
    exit_code: ExitCode = ExitCode.DONE
    runs: tuple[str, ...] = ()
    left: tuple[str, ...] = ()


@dataclass(frozen=True)
class Watching:
    """Who watches a recipe: `entered` hears of each step that begins, `ended` of each act that is over (True where it
    had been done before); `until`: the path before which it stops."""

    entered: Callable[[Entered], None] = lambda _: None
    ended: Callable[[str, Told, bool], None] = lambda *_: None
    until: str = ""


def run_recipe(
    bench: Bench, recipe: Recipe, log: Log, doing: Doing, watching: Watching = Watching()
) -> Outcome:  # fmt: skip
    """Run a recipe with the arguments of its log, which may tell of a part that was done; never raises PicoError, which
    is in the outcome. Where nobody is there it begins only as the recipe states, stops as it states, and leaves the
    bench so, which its edge brings about even where this process dies."""
    if not doing.unattended:
        return _Run(bench, recipe, log, doing, watching).run()
    name = f"{recipe.name}@{log.about.id}"
    try:
        guard = guard_of(bench, recipe, log.about.arguments)
        guard.require_start()
        doing = replace(doing, attended=False, allow=guard.allow, every=guard.stated.every)
        guard.hold(name, replace(doing, recipe=name, step="unattended"))
    except PicoError as exc:
        code = exc.exit_code or ExitCode.ERROR
        return Outcome(log.about.id, "failed", diagnostics=tuple(exc.diagnostics), exit_code=code)
    moves = False
    try:
        found = _Run(bench, recipe, log, doing, watching, guard).run()
        moves = found.outcome != "interrupted"
    finally:
        left = guard.leave(name, moves=moves)
    return _left(found, left)


def _left(found: Outcome, left: Left) -> Outcome:
    """Return how a run ended with how it left the bench, which the edge may have done before its end."""
    code = found.exit_code or (ExitCode.ERROR if left.wrong else ExitCode.DONE)
    if left.why:
        found, code = replace(found, diagnostics=(ended(left),)), ExitCode.EXPECTATION
    return replace(found, left=left.reached, diagnostics=(*found.diagnostics, *left.wrong), exit_code=code)


class _Until(Exception):
    """The step has come before which the recipe is to stop."""


class _Run:
    def __init__(
        self, bench: Bench, recipe: Recipe, log: Log, doing: Doing, watching: Watching, guard: Guard | None = None
    ) -> None:  # fmt: skip
        self.guard = guard
        self.bench, self.recipe, self.log, self.doing, self.watching = bench, recipe, log, doing, watching
        self.one = OneRun(bench, f"{recipe.name}@{log.about.id}")
        self.acted = self.before = 0
        self.at = self.failed = ""
        self.taken_up = 0
        self.reached = False

    def run(self) -> Outcome:
        try:
            return self._run()
        finally:
            self.one.end("interrupted")

    def _run(self) -> Outcome:
        steps = walk(self.recipe, self.log.about.arguments, self._entered, failing=self._failing)
        found: tuple[Diagnostic, ...] = ()
        code = ExitCode.DONE
        try:
            self.taken_up = self.log.taken_up() if self.log.steps else 0
            returns = self._to_the_end(steps)
            self.one.end()
        except _Until:
            steps.close()
            self.one.end("interrupted")
            return self._outcome("interrupted")
        except KeyboardInterrupt:  # between two runs on the bench
            steps.close()
            return self._outcome("interrupted", at=self.at, exit_code=ExitCode.INTERRUPTED)
        except PicoError as exc:
            self.one.end("interrupted" if exc.exit_code == ExitCode.INTERRUPTED else "failed")
            found, code, returns = tuple(exc.diagnostics), exc.exit_code or ExitCode.ERROR, {}
            if _unwritten(exc):  # without an end in its log it goes on once there is room
                return self._outcome("failed", at=self.at, diagnostics=found, exit_code=code)
        if code == ExitCode.INTERRUPTED:
            return self._outcome("interrupted", at=self.at, diagnostics=found, exit_code=code)
        try:
            self.log.end("failed" if found else "done")
        except PicoError as exc:
            found, code = (*found, *exc.diagnostics), code or ExitCode.ERROR
        if found:
            return self._outcome("failed", at=self.failed or self.at, diagnostics=found, exit_code=code)
        return self._outcome("done", returns=returns)

    def _outcome(self, how: str, **what: Any) -> Outcome:
        runs = dict.fromkeys(run for step in self.log.steps.values() for run in step.runs)
        return Outcome(self.log.about.id, how, acted=self.acted, before=self.before, runs=tuple(runs), **what)

    def _entered(self, entered: Entered) -> None:
        self.at = entered.path
        self.reached |= bool(entered.path) and entered.path == self.watching.until
        self.watching.entered(entered)

    def _failing(self, begun: str) -> None:
        """Remember which step failed: the one begun last, which is not entered before its terms have values."""
        inside = self.at == begun or self.at.startswith((f"{begun}.", f"{begun}["))
        self.failed = self.failed or (self.at if inside else begun)

    def _to_the_end(self, steps: Any) -> dict[str, Any]:
        send: Callable[[], Ask] = lambda: next(steps)  # noqa: E731
        while True:
            try:
                ask = send()
            except StopIteration as stop:
                return dict(stop.value)
            try:
                told = self._answer(ask)
            except PicoError as exc:
                if exc.exit_code == ExitCode.INTERRUPTED or _unwritten(exc):
                    steps.close()
                    raise
                failed, self.failed = _at_step(exc, ask.step), self.failed or ask.path
                send = lambda: steps.throw(failed)  # noqa: E731, B023
            else:
                answer = told
                send = lambda: steps.send(answer)  # noqa: E731, B023

    def _answer(self, ask: Ask) -> Told:
        until = self.watching.until
        if until and (
            self.reached or ask.path == until or ask.path.startswith((f"{until}.", f"{until}[", f"{until}?"))
        ):
            raise _Until
        content = {"kind": ask.step.kind, "given": ask.given} if ask.step else {"names": list(ask.names)}
        again = ask.path in self.log.steps
        known = self.log.begun(ask.path, content, checked_out(self.bench), ask.step.kind if ask.step else "")
        if known.told is not None:
            self.before += ask.step is not None
            self.watching.ended(ask.path, known.told, True)
            return known.told
        told = self._act(ask, ask.step, known.runs, known.head, again) if ask.step else self._looked(ask.names)
        if self.taken_up and ask.step:
            told = {**told, "taken_up": self.taken_up}
        self.log.told(ask.path, told, checked_out(self.bench))
        if ask.step:
            self.acted += 1
            self.watching.ended(ask.path, told, False)
        return told

    def _act(self, ask: Ask, step: Act, runs: list[str], head: str | None, again: bool) -> Told:
        if again:
            settle(self.bench, runs)
        file = step_file(step.kind)
        one = self.one if file.KIND.within else None
        if one is None:
            self.one.end()
        doing = replace(
            self.doing, recipe=self.one.recipe, step=ask.path, one=one, begun=tuple(runs), again=again,
            head=head if again else None, begin=lambda run: self.log.running(ask.path, run),
        )  # fmt: skip
        if (guard := self.guard) is not None:
            guard.judge(doing, ask.path)
            doing.watch = lambda: guard.judge(doing, ask.path)
        for attempt in range(step.retries + 1):
            try:
                return file.run(doing, ask.given)
            except PicoError as exc:
                self.one.end("interrupted" if exc.exit_code == ExitCode.INTERRUPTED else "failed")
                if attempt == step.retries or exc.exit_code in (ExitCode.INTERRUPTED, ExitCode.DENIED):
                    raise
        raise AssertionError("a step has at least one attempt")

    def _looked(self, names: tuple[str, ...]) -> Told:
        """Return the values of names of the bench as observed now; one that nobody knows is left out."""
        seen = self.bench.observe()
        values, _ = values_of(self.bench.setup, seen, sorted({n.partition(".")[0] for n in names}))
        return {n: values[n] for n in names if n in values}


def _unwritten(exc: PicoError) -> bool:
    """Whether a run can't go on for its log can't be written: what would be done then, nobody would know."""
    return any(d.code == UNWRITTEN for d in exc.diagnostics)


def _at_step(exc: PicoError, step: Act | None) -> PicoError:
    """Return a failure with the place of its step in the recipe, where nothing says another."""
    if step is None or step.source is None:
        return exc
    found = [d if d.source or d.severity != "error" else replace(d, source=step.source) for d in exc.diagnostics]
    return PicoError(found, exc.exit_code)
