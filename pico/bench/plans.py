"""Plans from the bench as it stands: to a revision, to the manifest, of one operation, of what is to be measured."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.backends.devices import EMULATED, HARDWARE
from pico.base import clock
from pico.bench.auditing import case_of
from pico.bench.cut_short import cut_short
from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, ExitCode, PicoError, did_you_mean, error
from pico.kernels.pipeline import source_of
from pico.manifest.file_names import EXCLUDED
from pico.model.address import called_now, read_addresses, renamed_state, renaming_of
from pico.model.commissioning import ONE_MOTION
from pico.model.comparing.drift import drift_of
from pico.model.diff import Change, diff_observed
from pico.model.observation import Observation, ObservedComponent, ObservedValue, live_state
from pico.model.operation import Operation
from pico.model.plan import Plan, Target
from pico.model.quantities import Value
from pico.model.request import PrimitiveRequest, as_stated, asked, value_at
from pico.model.state import LabState, place_of, with_values
from pico.motion.deferred import DeferredMotion
from pico.policy.expired import expired
from pico.policy.judging.judges import judge_plan, refusal_of
from pico.vision.calibration_files import calibration_digest, made_at

if TYPE_CHECKING:
    from pico.history.restoring.selected import SelectedParts
    from pico.manifest.load import Manifests
    from pico.motion.types import Motion
    from pico.optics.nominal.feeding import Right
    from pico.planning import PlanGoal, Planner
    from pico.planning.explaining.explain import Explanation
    from pico.planning.optimizing import Turn
    from pico.planning.passes.goal import Preference
    from pico.planning.sought import Sought
    from pico.planning.surveying import Shots


_NUMBERS = ("undo", "redo", "recover")
"""Causes of plans that bring numbers back, whatever light found."""


class Plans:
    """Plans on one bench. Nothing moves by them."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def plan(
        self,
        revision: str | None = None,
        *,
        exact: bool = False,
        prefer: Preference = "fewest-moves",
        targets: Collection[str] = (),
        exclude: Collection[str] = (),
        manifests: Manifests | None = None,
        expecting: bool = True,
        align: bool | None = None,
    ) -> Plan:
        """Return the plan from the bench as it stands to a revision, or to the manifest in the working tree.

        The state comes from the revision, the bench as it is now. `prefer`: what counts first, `fewest-moves`
        or `shortest-time`. `targets`: plan for these components or tunables (`p2`, `p1.angle`), and for what
        must make way for them; `exclude`: leave these alone, also those that only the revision has.
        `manifests`: instead of those in the working tree. `expecting`: whether the expectations of the state
        count; those of single components never do. `align`: seek the goals that are not aligned when all
        stands, or that the plan spoils, at its end; None: as the policy of the lab says. Raises PicoError for a
        revision that can't be read, for a component that there is not, and for an expectation that makes no
        sense; what is physically impossible is in the plan's diagnostics.
        """
        from pico.history.merge.doubts import require_settled
        from pico.planning import PlanGoal

        _require_preference(prefer)
        folder, given, names = self.opened.folder, manifests, renaming_of(self.opened.setup.lab)
        targets, exclude = ([called_now(names, word) for word in words] for words in (targets, exclude))
        manifests = folder.manifests_at(revision, without=exclude) if revision else given or folder.manifests
        commit = folder.history().resolve(revision).id if revision else None
        wanted = self._goal(manifests, revision, targets)
        if not expecting:
            wanted = replace(wanted, expect=())
        if wanted.expect and not (targets or exclude):
            from pico.manifest.expression_checks import check_expectations

            _require_sense(check_expectations(manifests))
        left_out = {d.address for d in manifests.diagnostics if d.code == EXCLUDED}
        exclude = [word for word in exclude if word not in left_out]
        read_addresses(self.opened.setup, exclude)
        if manifests is not given:
            require_settled(folder.repository, folder.root, manifests, commit, targets)
        target = Target(
            revision=revision,
            commit=commit,
            only=tuple(sorted(targets)) or None,
            exclude=tuple(sorted((*exclude, *left_out))) or None,
            expect=wanted.expect or None,
            align=self.aligns(align) or None,
        )
        goal = PlanGoal(
            wanted, target, exact=exact, prefer=prefer, targets=tuple(targets), exclude=tuple(exclude),
            source=manifests.source,
        )  # fmt: skip
        seen = self.opened.observe()
        old = expired(self.opened.setup, made_at(folder.root, self.opened.backend_name), clock.now())
        told = (*cut_short(self.opened, seen), *_strangers(seen), *old, *manifests.told)
        if revision and not targets:
            told = (*told, *self._stays(seen, wanted, revision))
        return self.to_state(
            seen, goal, told=told, calibration=calibration_digest(folder.root, self.opened.backend_name)
        )

    def aligns(self, asked: bool | None = None) -> bool:
        """Return whether a plan is to redo goals: as somebody asked, else as the policy of the lab says."""
        return self.opened.setup.lab.policy.align == "always" if asked is None else asked

    def _goal(self, manifests: Manifests, revision: str | None, targets: Collection[str]) -> LabState:
        from pico.history.restoring.selected import state_for

        if revision and targets:
            return state_for(self.opened.folder, manifests, revision, targets)
        return manifests.require()[1]

    def to_state(
        self, seen: Observation, goal: PlanGoal, *, told: tuple[Diagnostic, ...] = (), calibration: str | None = None
    ) -> Plan:  # fmt: skip
        """Return the plan from the bench as `seen` to a state, and what the policy of the lab says.

        `told`: what is wrong with the manifests beside it.
        """
        if self.opened.setup.lab.goals and not goal.exact and goal.target.cause not in _NUMBERS:
            from pico.bench.alignment.own_values import with_own_values

            at = goal.target.revision
            seen = with_own_values(self.opened, seen, goal.wanted, revision=at, named=goal.targets)
        planner = self.planner(seen)
        found = planner.plan(goal)
        if told or calibration:
            found = replace(found, calibration=calibration, diagnostics=(*told, *found.diagnostics)).sealed()
        return self.judged(self._realigned(found, seen, planner.motion) if found.target.align else found, seen)

    def planner(self, seen: Observation) -> Planner:
        """Return what plans from this observation on, for where it is to run."""
        from pico.planning import Planner

        head, setup = self.opened.folder.head(), self.opened.setup
        return Planner(
            setup, DeferredMotion(setup), seen, self.opened.backend_name, self.opened.fidelity,
            head.commit if head else None, timed=self._as_measured(),
        )  # fmt: skip

    def _as_measured(self) -> Callable[[Sequence[Operation]], tuple[Operation, ...]]:
        """Return what gives operations the seconds that earlier ones took on a bench with devices; of a simulated one
        the path says it."""
        opened, setup = self.opened, self.opened.setup
        if opened.backend_name not in (EMULATED, HARDWARE) or opened.far is not None:
            return tuple
        from pico.runs.durations import as_measured, measured_durations

        try:
            durations = measured_durations(setup, memory.records() if (memory := opened.edge.memory) else ())
        except PicoError:  # a journal that can't be read is told by what needs it
            return tuple
        return partial(as_measured, setup, durations=durations)

    def _realigned(self, plan: Plan, seen: Observation, motion: Motion | None) -> Plan:
        """Return the plan with the goals sought at its end that are not aligned then, and with what its goal recorded
        of its light measured again."""
        if plan.errored:
            return plan
        from pico.bench.aligned import redone, standing
        from pico.planning.by_light import as_meant, sought_in, with_goals
        from pico.planning.foreseen import foreseen
        from pico.planning.realigning import realigned

        setup, state = self.opened.setup, plan.target_state
        by_light = sought_in(setup, foreseen(setup, seen, plan.operations), state)
        goals, here = with_goals(setup, by_light), as_meant(setup, seen, state)
        stands = standing(self.opened, seen, state, wanted=True)
        sought = tuple(
            turn if turn.one.aim is None else replace(turn, right=(*self._met(turn.one.name, tuned=True),))
            for turn in redone(goals, here, stands, plan.operations, by_light.ready)
        )
        measured = () if plan.target.scope else self._recorded(plan.target)
        return realigned(setup, seen, plan, sought, motion, measured) if sought or measured else plan

    def _recorded(self, target: Target) -> tuple[tuple[str, str], ...]:
        """Return what was measured when the goal of a plan was committed, as far as this bench can measure it."""
        from pico.bench.light import Lights

        if target.title:
            return ()
        able = self.opened.wait(self.opened.edge.describe()).measurables
        recorded = Lights(self.opened).recorded(target.revision).measured
        return tuple(
            (one.component, one.measurable) for address, one in sorted(recorded.items()) if source_of(address) in able
        )

    def judged(self, plan: Plan, seen: Observation) -> Plan:
        """Return the plan with what its judges say of it, see `pico.policy.judging`. Skipped for steps of an open run;
        the edge judges those."""
        if put_off := tuple(_one_at_a_time(plan, seen)):
            plan = replace(plan, diagnostics=(*plan.diagnostics, *put_off)).sealed()
        if (far := self.opened.far) is not None and not far.local:
            plan = replace(plan, bench=far.name).sealed()
        if self.opened.recording is not None and (plan.asked or plan.target.title):
            return plan
        if self.opened.setup.lab.policy.rules and plan.operations:
            from pico.manifest.expression_checks import check_rules

            _require_sense(check_rules(self.opened.folder.manifests))
        return judge_plan(case_of(self.opened, plan, seen))

    def leaves_manifest(self, plan: Plan) -> bool:
        """Whether a plan leads the whole bench to a revision, and away from what the manifest says."""
        if not plan.target.revision or plan.target.only or plan.target.exclude:
            return False
        now = self.opened.folder.state_now()
        return now is not None and now.as_json() != dict(plan.target.state)

    def plan_of(self, word: str | None, *, folder: Path = Path(), **options: Any) -> Plan:
        """Return the saved plan that `word` names, or the plan to the revision it names (the manifest for None).

        `options` are those of `plan`; raises PicoError for any of them with a saved plan, which is what it is.
        """
        found = self.opened.history.find(word, folder) if word else None
        if not isinstance(found, Plan):
            return self.plan(found, **options)
        if (
            any(options.get(k) for k in ("exact", "targets", "exclude", "align"))
            or options.get("prefer") == "shortest-time"
        ):
            text = f"{word} is a saved plan, and is taken as it is"
            raise PicoError(
                error("usage", text, hint="names, --align, --exact, --exclude and --prefer go with `pico plan`")
            )
        return self._still_let_out(found)

    def _still_let_out(self, plan: Plan) -> Plan:
        """Return a saved plan without the light that nobody lets out now, and what is said of that."""
        from pico.planning.passes.light import without_light

        return without_light(self.opened.setup, self.opened.observe(), plan) if plan.operations else plan

    def refusal(self, plan: Plan) -> PicoError | None:
        """Return why a saved plan must not run now, None if it may: what it stands on has changed (exit code STALE), or
        one of the judges refuses it, as its edge would."""
        from pico.bench.saved_plans import changed_since

        seen = self.opened.observe()
        if found := changed_since(self.opened, plan, seen):
            return PicoError(found, ExitCode.STALE)
        able = self.opened.wait(self.opened.edge.describe())
        return refusal_of(replace(case_of(self.opened, plan, seen), able=able))

    def refreshed(self, plan: Plan) -> Plan:
        """Return a new plan from the bench as it stands to the goal of a saved one, for the same components."""
        target = plan.target
        return self.plan(target.revision, targets=target.only or (), exclude=target.exclude or (), align=target.align)

    def require_permitted(self, plan: Plan) -> None:
        """Raise PicoError if a saved plan must not run now, as `refusal` says."""
        if (why := self.refusal(plan)) is not None:
            raise why

    def explain(self, plan: Plan, component: str | None = None) -> Explanation:
        """Return why a plan is as it is, or what it does with one component; raises PicoError for an unknown one."""
        from pico.planning.explaining.explain import explain

        return explain(self.opened.setup, plan, component)

    def checkout_plan(self, revision: str | SelectedParts, *, exact: bool = False) -> Plan:
        """Return the plan to a revision that is about to be checked out, or to what is taken from one for some
        components; raises PicoError where edits would be lost."""
        if not isinstance(revision, str):
            found = self.plan(manifests=revision.manifests, targets=revision.names, exact=exact)
            return found.because("checkout")
        self.opened.folder.refuse_edits()
        return self.plan(revision, exact=exact).because("checkout")

    def _stays(self, seen: Observation, wanted: LabState, revision: str) -> Iterator[Diagnostic]:
        """Yield what was set here and stays as it is, since the state of a revision does not name it."""
        from pico.runs.unstated_settings import in_words, looked_up

        found = looked_up(self.opened.setup, self.opened.edge.memory, seen, wanted)
        if found:
            verb, them = ("stays", "it") if len(found) == 1 else ("stay", "them")
            text = f"{in_words(self.opened.setup, found)} {verb} as set: the state of {revision} does not name {them}"
            yield Diagnostic("note", "in-no-state", text)

    def measuring(self, wanted: Sequence[tuple[str, str]], goals: Sequence[Turn] = ()) -> Plan:
        """Return the plan that measures measurables, each as its component and its name; before that `goals` where
        their tunables stand. It has no operations where that is nothing."""
        from pico import planning

        seen = self._seen()
        planner = self.planner(seen)
        return self.judged(planner.plan(planning.measure(planner, wanted, goals)), seen)

    def to_measure(self, what: Sequence[str]) -> Plan:
        """Return the plan that measures what a person names (`cam.centroid`, `cam`, `cam.image | centroid`), in this
        order; raises PicoError for nonsense."""
        from pico import planning

        seen = self._seen()
        asks = [tuple(word.strip() for word in one.partition(".")[::2]) for one in what]
        if len(asks) == 1:
            return self.single(asks[0][0], "measure", {"measurable": asks[0][1]} if asks[0][1] else {})
        wanted = [
            (one.component, str(one.measurable))
            for name, own in asks
            for one in [asked(self.opened.setup, seen, name, "measure", {"measurable": own} if own else {})]
        ]
        planner = self.planner(seen)
        return self._able(planner, planning.measure(planner, [*dict.fromkeys(wanted)]))

    def setting(self, values: Mapping[str, Value]) -> Plan:
        """Return the plan that brings tunables to values exactly, by address (`p1.angle`), side by side as far as their
        motors can; nothing else is set or moved. Raises PicoError for a value out of range."""
        parts = {address.partition(".")[0] for address in values}
        if len(parts) == 1:
            return self.single(parts.pop(), "set", {a.partition(".")[2]: written(v) for a, v in values.items()})
        setup, seen = self.opened.setup, self._seen()
        checked = {a: value_at(setup, a, written(v)) for a, v in values.items()}
        return self._asked(seen, with_values(live_state(setup, seen), checked), checked)

    def moving(self, places: Mapping[str, str | Mapping[str, float]]) -> Plan:
        """Return the plan that takes parts to slots or poses (what is not named of one stays as observed), in an order
        in which they pass one another; nothing else is moved but what must make way."""
        seen = self._seen()
        live = live_state(self.opened.setup, seen)
        changed = {}
        for name, place in places.items():
            part = seen.components.get(name)
            if part is None or part.pose is None or name not in live.components:
                raise PicoError(error("missing", f"nobody sees {name}, so it can't be moved", address=name))
            own, pose = live.components[name], None
            if not isinstance(place, str):
                pose = replace(part.pose, **{k: float(v) for k, v in place.items()})
            changed[name] = replace(own, slot=place if isinstance(place, str) else None, pose=pose)
        return self._asked(seen, replace(live, components={**live.components, **changed}), places)

    def _asked(self, seen: Observation, wanted: LabState, named: Collection[str]) -> Plan:
        from pico.planning import PlanGoal

        target = Target(title=", ".join(named), only=tuple(sorted(named)))
        return self.to_state(seen, PlanGoal(wanted, target, exact=True, targets=tuple(named)))

    def single(
        self, component: str, primitive: str, arguments: Mapping[str, str] | None = None, *,
        base: LabState | None = None,
    ) -> Plan:  # fmt: skip
        """Return the plan of one primitive, its arguments as a person writes them; raises PicoError for nonsense.

        What is not named, and what is relative, counts from where the bench stands, or from the state `base`.
        """
        from pico.policy.capability import require_able

        seen, setup = self._seen(), self.opened.setup
        stands = seen if base is None else as_stated(setup, base)
        found = self._one(seen, asked(setup, stands, component, primitive, arguments or {}))
        if self.opened.recording is not None:  # its edge looks at all of that
            return found
        require_able(found, self.opened.wait(self.opened.edge.describe()))
        told = cut_short(self.opened, seen)
        return replace(found, diagnostics=(*told, *found.diagnostics)).sealed() if told else found

    def _seen(self) -> Observation:
        """Return the bench as it is; within an open run without what is aligned, of which single operations know
        nothing."""
        opened = self.opened
        return opened.observe() if opened.recording is None else opened.wait(opened.edge.observe())

    def to_goal(
        self, one: Sought, first: Sequence[Sought] = (), took: float | None = None, *, absorb: bool = True
    ) -> Plan:  # fmt: skip
        """Return the plan that brings light to a goal, by those that are sought `first` where it is dark; see
        `pico.bench.goals`. `took`: the seconds that it is reckoned with. Raises PicoError."""
        from pico.planning import optimize_one

        seen = self.opened.observe()
        planner, right = self.planner(seen), [*self._right(one, seen)] if absorb else []
        return self._able(planner, optimize_one(planner, one, first=first, took=took, right=right))

    def _able(self, planner: Planner, goal: PlanGoal) -> Plan:
        """Return the plan to a goal that the bench can do, judged; raises PicoError where it can't."""
        from pico.policy.capability import require_able

        found, seen = planner.plan(goal), planner.seen
        require_able(found, self.opened.wait(self.opened.edge.describe()))
        judged, told = self.judged(found, seen), cut_short(self.opened, seen)
        return replace(judged, diagnostics=(*told, *judged.diagnostics)).sealed() if told else judged

    def with_goals_again(self, plan: Plan, seen: Observation, sought: Mapping[str, Operation]) -> Plan:
        """Return a plan after which optimizations that were cut short, by their keys, begin again: from where it brings
        their tunables, at the best that they had measured; raises PicoError."""
        if not sought or plan.errored:
            return plan
        from pico.planning.realigning import again

        setup = self.opened.setup
        found = self.judged(again(setup, seen, plan, sought, motion=DeferredMotion(setup)), seen)
        return replace(found, diagnostics=tuple(dict.fromkeys(found.diagnostics))).sealed()

    def to_steer(self, component: str, tunable: str | None = None) -> Plan:
        """Return the plan in which a person steers a component: one tunable of it, `pose`, or what motors set of it.

        Raises PicoError for what there is not, and what nobody can steer.
        """
        from pico.planning import teleoperate_one

        planner = self.planner(self.opened.observe())
        return self._able(planner, teleoperate_one(planner, component, tunable))

    def _right(self, one: Sought, seen: Observation) -> Iterator[Right]:
        """Yield benches with the light that a goal is to have: as it was met last, and as the manifest has it, where
        the tunables of the goal stand as that says."""
        from pico.optics.nominal.feeding import Right

        setup, wanted = self.opened.setup, self.opened.folder.state_now()
        yield from self._met(one.name, tuned=one.aim is not None)
        if wanted is None or one.aim is not None:
            return
        off = {f"{c.component}.{c.tunable}" for c in diff_observed(setup, seen, wanted) if not c.tolerated}
        if not off & one.goal.tunables.keys():
            live = seen.known_values
            parts = {n: replace(p, values={**live.get(n, {}), **p.values}) for n, p in wanted.components.items()}
            yield Right(replace(wanted, components=parts), met=False)

    def _met(self, goal: str, *, tuned: bool) -> Iterator[Right]:
        """Yield the bench as it was when a goal was met last, if it ever was."""
        from pico.optics.nominal.feeding import Right
        from pico.runs.when_met import when_met

        lab = self.opened.setup.lab
        if (met := when_met(self.opened.edge.memory, lab.name, goal)) is not None:
            yield Right(renamed_state(renaming_of(lab), met), met=True, tuned=tuned)

    def to_survey(self, seen: Observation, shots: Shots, dark: Sequence[str]) -> Plan:
        """Return the plan that reads `shots` and frames in the `dark` of cameras; see `pico.bench.mornings`. Raises
        PicoError."""
        from pico.planning import survey

        planner = self.planner(seen)
        return self._able(planner, survey(planner, shots, dark))

    def not_in_manifest(self, plan: Plan) -> tuple[Change, ...]:
        """Return where a bench at the goal of a plan will have left the manifest, beyond tolerance; raises PicoError
        where that can't be read."""
        setup, goal = self.opened.setup, plan.target_state
        parts = {
            name: ObservedComponent(
                pose=place_of(setup, goal, name)[1], values={k: ObservedValue(value=v) for k, v in part.values.items()}
            )
            for name, part in goal.components.items()
        }
        seen = Observation(backend=plan.backend, components=parts)
        return tuple(c for c in drift_of(setup, seen, self.opened.state) if not c.tolerated and c.component in parts)

    def _one(self, seen: Observation, request: PrimitiveRequest) -> Plan:
        planner = self.planner(seen)
        return self.judged(planner.plan(_goal_of(planner, request)), seen)


def _goal_of(planner: Planner, request: PrimitiveRequest) -> PlanGoal:
    from pico import planning

    name = request.component
    if request.primitive == "set":
        return planning.set_values(planner, name, request.values)
    if request.primitive == "home":
        assert request.tunable is not None
        return planning.home_one(planner, name, request.tunable)
    if request.measurable is not None:
        return planning.measure(planner, [(name, request.measurable)])
    if place := request.slot or request.pose:
        return planning.move_one(planner, name, place)
    return planning.do_one(planner, name, request.primitive, request.arguments)


def written(value: object) -> str:
    """Return a value as a person writes it, with every digit."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _strangers(seen: Observation) -> Iterator[Diagnostic]:
    """Yield a note for each object on the table that is in no inventory."""
    for name, thing in sorted(seen.unknown.items()):
        text = f"{name} stands at {thing.pose}: not in the inventory, so it is an obstacle and never moved"
        hint = "take it away, or take it into the inventory: `pico import`"
        yield Diagnostic("note", "stranger", text, hint=hint, address=name)


def _one_at_a_time(plan: Plan, seen: Observation) -> Iterator[Diagnostic]:
    """Yield, for each arm that makes one motion a command, which of a plan this command does and what is left."""
    for robot in sorted({problem.address for problem in seen.problems if problem.code == ONE_MOTION}):
        own = [op for op in plan.operations if op.robot == robot]
        if len(own) < 2:
            continue
        first, *rest = own
        left = ", ".join(f"{op.primitive} {op.component}" for op in rest)
        text = f"{robot} makes one motion a command: now {first.primitive} {first.component}; then {left}"
        hint = f"call it {len(rest) + 1} times, or let plans run whole with `pico commission --only motion`"
        yield Diagnostic("note", "one-motion", text, hint=hint, address=robot)


def _require_sense(found: list[Diagnostic]) -> None:
    """Raise PicoError, with their places, for expectations of a state or rules of a lab that can't be told."""
    if found:
        raise PicoError(found)


def _require_preference(prefer: str) -> None:
    known = ["fewest-moves", "shortest-time"]
    if prefer not in known:
        raise PicoError(error("prefer", f"a plan can't prefer `{prefer}`", hint=did_you_mean(prefer, known)))
