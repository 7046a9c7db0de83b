"""A recipe ahead of time: every state that is known in advance is planned from the one before it, and nothing moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

from pico.bench.bench import Bench
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.model.observation import Observation, ObservedComponent, ObservedValue, live_state
from pico.model.operation import Operation, touched_by
from pico.model.plan import Plan, Target
from pico.model.pose import Pose
from pico.model.record import digest
from pico.model.state import LabState
from pico.model.vocabulary import values_of
from pico.recipes.doing import Doing
from pico.recipes.reader import NAMES, is_name
from pico.recipes.recipe import Act, Recipe, Scan, Step
from pico.recipes.registry import StepFile, step_file
from pico.recipes.walking import Ask, Entered, Told, walk

_REFS = {"tag": "tags", "branch": "heads"}
_HINTS = {
    "tag": "a tag is for good: give another name, by a parameter for instance",
    "branch": "give another name, or `checkout: {name}` to go on with it",
}
MOST = 400
"""Steps that are looked at ahead."""
_ANY = "*"
"""For everything on the bench."""


@dataclass(frozen=True)
class Foreseen:
    """What is known of a recipe in advance: its steps as they would be begun with the seconds that each takes [s, None
    where nobody knows], those that depend on a measurement among them (`known` of them is false), the `seconds` of all,
    what is impossible; `whole`: no step depends on one, and all were looked at."""

    steps: tuple[tuple[Entered, float | None], ...]
    seconds: float
    diagnostics: tuple[Diagnostic, ...] = ()
    whole: bool = True
    exit_code: ExitCode = ExitCode.DONE


class _Later(Bench):
    """A bench as it will be: it is observed as the plans so far would leave it."""

    def __init__(self, bench: Bench) -> None:
        kept = {k: v for k, v in vars(bench).items() if not isinstance(getattr(Bench, k, None), cached_property)}
        self.__dict__.update(kept)
        self.seen = bench.observe()

    def observe(self) -> Observation:
        """Return what would be seen."""
        return self.seen


def foresee(
    bench: Bench, recipe: Recipe, arguments: Mapping[str, Any], known: Mapping[str, Told] | None = None
) -> Foreseen:
    """Return what is known of a recipe in advance on a bench as it stands. `known`: what came of the steps that were
    done before it was cut short, by path; they are not among those that are foreseen."""
    return _Ahead(bench, recipe, arguments, known or {}).run()


class _NewNames:
    """The tags and branches of a bench's lab as they will be while a recipe goes on."""

    def __init__(self, bench: Bench) -> None:
        head = bench.folder.head()
        self.bench, self.own = bench, set[tuple[str, str]]()
        self.on = head.branch if head else None

    def made(self, step: Act, given: Mapping[str, Any]) -> None:
        """Remember what a step makes, or checks out; raises PicoError, at its place, for a name that can't be made."""
        if step.kind == "checkout":
            name = str(given["revision"])
            self.on = name if self._there("branch", name) else None
        if step.kind not in _REFS:
            return
        name = str(given["name"])
        if step.kind == "branch" and name == self.on:
            return
        if not is_name(name):
            raise PicoError(error("name", f"`{name[:40]}` is no name of a {step.kind}", hint=NAMES, source=step.source))
        if self._there(step.kind, name):
            text = f"there is a {step.kind} `{name[:40]}` already"
            raise PicoError(error("name-taken", text, hint=_HINTS[step.kind].format(name=name), source=step.source))
        self.own.add((step.kind, name))
        self.on = name if step.kind == "branch" else self.on

    def _there(self, kind: str, name: str) -> bool:
        return (kind, name) in self.own or self.bench.history.is_revision(f"refs/{_REFS[kind]}/{name}")


class _Ahead:
    def __init__(self, bench: Bench, recipe: Recipe, arguments: Mapping[str, Any], known: Mapping[str, Told]) -> None:
        self.later, self.known = _Later(bench), dict(known)
        self.walk = walk(recipe, arguments, self.entered, ahead=self.may_be)
        self.steps: list[tuple[Entered, float | None]] = []
        self.found: list[Diagnostic] = []
        self.whole, self.acts, self.code = True, 0, ExitCode.DONE
        self.made: dict[str, LabState] = {}
        self.before: dict[str, tuple[float, Observation, frozenset[str]]] = {}
        self.branch = ""
        self.names = _NewNames(bench)
        self.open = set[str]()

    def may_be(self, step: Step) -> None:
        """Take what a step changes for unknown: only a measurement will tell whether it is done, or with what."""
        if isinstance(step, Scan):
            changed = set(step.over)
        elif isinstance(step, Act) and step.kind == "set":
            changed = set(step.given)
        elif isinstance(step, Act) and step.kind == "move":
            changed = {f"{name}.pose" for name in step.given}
        else:
            changed = {_ANY} if isinstance(step, Act) and _moves(step) else set()
        self.whole, self.open = False, self.open | changed

    def entered(self, entered: Entered) -> None:
        self.steps.append((entered, None))

    def run(self) -> Foreseen:
        try:
            ask = next(self.walk)
            while self.acts < MOST:
                ask = self.walk.send(self.told(ask))
            self.whole = False
        except StopIteration:
            pass
        except PicoError as exc:
            self.found.extend(exc.diagnostics)
            self.code = exc.exit_code
        seconds = sum(s for _, s in self.steps if s is not None)
        return Foreseen(tuple(self.steps), seconds, tuple(self.found), self.whole and not self.found, self.code)

    def told(self, ask: Ask) -> Told:
        if (before := self.known.pop(ask.path, None)) is not None:
            if not self.known:
                self.steps = []
            return before
        if ask.step is None:
            parts = sorted({n.partition(".")[0] for n in ask.names})
            values, _ = values_of(self.later.setup, self.later.seen, parts)
            return {n: values[n] for n in ask.names if n in values and not self.may_differ(n)}
        self.acts += 1
        seconds = self.planned(ask, ask.step, step_file(ask.step.kind))
        self.steps[-1] = (replace(self.steps[-1][0], known=seconds is not None), seconds)
        return {}

    def may_differ(self, name: str) -> bool:
        """Return whether only a measurement will tell what a number of the bench will be by then."""
        return any(one in (_ANY, name) or name.startswith(f"{one}.") for one in self.open)

    def doubtful(self, code: ExitCode) -> bool:
        """Return whether what speaks against a step may be otherwise by then: where parts stand, or any value."""
        poses = any(one == _ANY or one.endswith(".pose") for one in self.open)
        return poses or (bool(self.open) and code != ExitCode.IMPOSSIBLE)

    def planned(self, ask: Ask, step: Act, file: StepFile) -> float | None:
        """Plan a step from the bench as it would be by then, and let that be done; return how long it takes [s]."""
        self.names.made(step, ask.given)
        self.named(step.kind, ask.given)
        if not hasattr(file, "plan"):
            return float(ask.given["seconds"]) if "seconds" in ask.given else 0.0
        key = digest([step.kind, ask.given, self.later.seen.components, sorted(self.open)])
        if key in self.before and "revision" not in ask.given:  # loops come back to where they were
            seconds, self.later.seen, left_open = self.before[key]
            self.open = set(left_open)
            return seconds
        try:
            plan = self.to_made(ask.given) or cast(Any, file).plan(Doing(self.later, step=ask.path), ask.given)
        except PicoError as exc:
            if self.doubtful(exc.exit_code):
                self.may_be(step)
                return None
            raise PicoError([replace(d, source=step.source) for d in exc.diagnostics], exc.exit_code) from exc
        if plan.exit_code and self.doubtful(plan.exit_code):
            self.may_be(step)
            return None
        if plan.exit_code:
            wrong = [d for d in plan.diagnostics if d.severity == "error"]
            raise PicoError([replace(d, source=step.source) for d in wrong], plan.exit_code)
        for op in plan.operations:
            self.later.seen = done(self.later.seen, op)
            touched = {f"{one}.{tunable}" for one, tunable in touched_by(op.component, op.arguments)}
            if op.primitive == "set" or op.kind.carries:
                self.open -= touched
            elif op.kind.mutating:
                self.open |= touched
        self.before[key] = float(plan.makespan), self.later.seen, frozenset(self.open)
        return float(plan.makespan)

    def named(self, kind: str, given: Mapping[str, Any]) -> None:
        """Remember what the revisions will be that the recipe makes."""
        name = str(given.get("name", ""))
        if kind == "branch":
            self.branch = name
        elif kind == "checkout":
            self.branch = str(given["revision"]) if given["revision"] in self.made else ""
        if made := {"tag": name, "branch": name, "commit": self.branch}.get(kind, ""):
            self.made[made] = live_state(self.later.setup, self.later.seen)

    def to_made(self, given: Mapping[str, Any]) -> Plan | None:
        """Return the plan to a revision that the recipe will have made by then."""
        from pico.planning import PlanGoal

        state = self.made.get(str(given.get("revision")))
        if state is None:
            return None
        goal = PlanGoal(state, Target(revision=str(given["revision"])))
        return self.later.plans.to_state(self.later.seen, goal)


def _moves(step: Act) -> bool:
    return step.kind != "measure" and hasattr(step_file(step.kind), "plan")


def done(seen: Observation, op: Operation) -> Observation:
    """Return what would be seen once an operation was done as it is planned."""
    part = seen.components.get(op.component)
    if part is None:
        return seen
    if op.kind.carries and "pose" in op.arguments.get("to", {}):
        part = replace(part, pose=Pose(**op.arguments["to"]["pose"]), presence="seen")
    elif op.primitive == "set" and "to" in op.arguments:
        part = _with(part, str(op.arguments["tunable"]), op.arguments["to"])
    else:
        return seen
    return replace(seen, components={**seen.components, op.component: part})


def _with(part: ObservedComponent, tunable: str, value: Any) -> ObservedComponent:
    return replace(part, values={**part.values, tunable: ObservedValue(value=value)})
