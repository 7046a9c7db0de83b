"""After a run that was cut short: taking it up again, going back to before it, or only clearing the hands."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.bench.cut_short import not_left, unattended
from pico.bench.in_use import refuse_in_use
from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.bench.undo import intention
from pico.bench.undo.choice import begun_by, called, chosen, document_if_any, document_of, not_in_place
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.model.address import renamed_state, renaming_of
from pico.model.comparing.drift import drift_of
from pico.model.diff import deviation
from pico.model.observation import Observation, live_state, slot_at
from pico.model.operation import Operation, touched_by
from pico.model.plan import Plan, Target
from pico.model.state import LabState, state_from_json, with_values
from pico.motion.deferred import DeferredMotion
from pico.planning.parts.phrases import listed
from pico.runs.left_set import left_set

if TYPE_CHECKING:
    from pico.edge.network.remotes import Place
    from pico.model.instruments.fault import DeviceFault
    from pico.model.setup import Setup
    from pico.runs.journal import RunRecord
    from pico.runs.memory import Memory


_WHOLE = {"survey": "pico morning", "verify": "pico verify --measure"}
"""Commands that do what single operations are part of."""


class Recovery:
    """What a run left behind on one bench, and the plans that go on from there."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def intend(self, command: str) -> Callable[[], None]:
        """Keep that a command was approved, and return what to call at its end; see `pico.bench.undo.intention`."""
        return intention.keep(self.opened.place, command)

    def killed_early(self) -> tuple[Diagnostic, ...]:
        """Return that what was called last was killed before it moved anything."""
        return intention.told(self.opened.place)

    def require_named(self, command: str, of: str | None = None) -> None:
        """Raise PicoError if what was called last was killed before it moved anything, so that `command`, which nobody
        is asked about, would be about a run before that."""
        memory = self.opened.edge.memory
        if memory is None or intention.killed(self.opened.place) is None:
            return
        if command == "resume":
            intention.require_named(self.opened.place, command, called(memory, _last(self.opened.place, memory)))
        found = chosen(self.opened.setup, memory, None, of, self._me(), undone=command == "redo")
        intention.require_named(self.opened.place, command, called(memory, found.run))

    def resume_plan(self, run: str | None = None) -> tuple[Plan, str]:
        """Return the plan from the bench as it stands to the goal of the last run, and the id of that run. run: that
        id, for whoever wants to be sure.

        Raises PicoError where the last run reached its end, or is still going on (exit code LOCKED), and where only
        what brings about no state is left of it, such as a measurement.
        """
        from pico.execution.resume import renumbered
        from pico.history.runs.benches import fits
        from pico.planning import PlanGoal

        self._require_here(run, f"resume {run}")
        memory = self._memory()
        refuse_in_use(self.opened)
        last = _last(self.opened.place, memory)
        sought = _cut_goals(memory, last.run)
        if run is not None and not (run and fits(run, last.run)):
            named = [one.run for one in memory.runs() if run and fits(run, one.run)]
            if not named:
                text = f"this bench has no run `{run[:40]}`"
                raise PicoError(error("no-run", text, hint="`pico runs` lists them; `pico resume` means the last"))
            text = f"only the last run can be taken up again, and that is {called(memory, last)}"
            goes_on = last.outcome != "done" or sought
            hint = f"{f'`pico resume {last.run}` continues that; ' if goes_on else ''}`pico runs show {named[-1]}`"
            raise PicoError(error("not-last", text, hint=f"{hint} says what became of the other"))
        if last.outcome == "done" and not sought:
            text = f"there is nothing to resume: the last run ({last.run}) did all that it was to do"
            nothing = error("nothing-to-resume", text, hint=_goes_on(memory))
            raise PicoError([nothing, *self._elsewhere()])
        began = document_of(memory, last)
        if steered := next((op for op in began.operations if op.primitive == "teleoperate"), None):
            raise PicoError(_steered(steered.component, steered.robot))
        if began.open:
            raise PicoError(_recorded(began, last))
        self._as_before(memory)
        only = began.target.only or _asked(began, sought)
        seen = self.opened.observe()
        wanted = renamed_state(renaming_of(self.opened.setup.lab), began.target_state)
        target = began.target
        if began.asked and not (target.revision or target.title):
            target = replace(target, title=f"what run {last.run} was to lead to")
        goal = PlanGoal(wanted, target, targets=tuple(only or ()), exclude=target.exclude or ())
        plan = Plans(self.opened).to_state(seen, goal)
        anew = {op.address for op in plan.operations if op.primitive == "optimize"}  # it aligns all the same
        sought = {key: op for key, op in sought.items() if op.address not in anew}
        plan = Plans(self.opened).with_goals_again(plan, seen, sought)
        left = tuple(_left_out(began, memory, last.run, sought))
        if left and not plan.operations:
            raise PicoError([replace(d, severity="error", code="nothing-to-resume") for d in left])
        plan = replace(plan, diagnostics=(*self._elsewhere(), *left, *plan.diagnostics))
        return renumbered(plan, last.resumed + 1), last.run

    def undo_plan(self, run: str | None = None, *, of: str | None = None) -> Plan:
        """Return the plan that takes everything that a run moved or set back to where it was before.

        run: its id, or how that begins or ends; None: the last one that left the bench otherwise than it found it,
        beyond tolerance, or was cut short. of: whose it is, for a run of another person. A run that is named must still
        be in place. Runs that only emptied hands since belong to the one that they tidied up after. A part that a hand
        held when the run began goes to where it stood before that. What nobody knew before it is left as it is; where
        something else has changed since, the plan is for what the run changed alone. Raises PicoError.
        """
        return self._taken_back(run, of, "undo")

    def redo_plan(self, run: str | None = None, *, of: str | None = None) -> Plan:
        """Return the plan that takes an undo back: the last run, if it is one, or the one that is named, by its id or
        by that of the run that it took back. Raises PicoError if the bench does not stand as it left it any more."""
        return self._taken_back(run, of, "redo")

    def _taken_back(self, run: str | None, of: str | None, cause: str) -> Plan:
        from pico.planning import PlanGoal

        self._require_here(run, f"{cause} {run}")
        memory, setup = self._memory(), self.opened.setup
        refuse_in_use(self.opened)
        found = chosen(setup, memory, run, of, self._me(), undone=cause == "redo")
        if not self.opened.asked:
            self.opened.suit(found.plan)
        names = renaming_of(setup.lab)
        done = {(names.get(c, c), t) for own in found.runs[: found.at + 1] for c, t in begun_by(memory, own)}
        before, held = state_before(setup, memory, found.runs[found.at :], {component for component, _ in done})
        looked = self.opened.observe()
        if (found.explicit or cause == "redo") and (wrong := not_in_place(setup, memory, looked, found)):
            raise PicoError(wrong)
        seen = self._emptied(looked)
        live = live_state(setup, seen)
        wanted = replace(live, components={**live.components, **in_slots(setup, seen, before).components})
        off = {(c.component, c.tunable) for c in drift_of(setup, seen, wanted) if not c.tolerated}
        only = _addresses(done, off - done) if off - done else ()
        # what light found matters below the tolerance of its axis, too; a part is put down only so well
        numbers = all(tunable in setup.type_of(component).tunables for component, tunable in done)
        taken = f", with {listed(held)} where it was picked" if held else ""
        title = f"the state before run {found.run.run}{taken}"
        target = Target(title=title, only=only or None, cause=cause, of=found.run.run)
        targets = tuple(sorted(f"{component}.{tunable}" for component, tunable in done)) if numbers else only
        goal = PlanGoal(wanted, target, exact=numbers, targets=targets)
        note = Diagnostic("note", cause, f"this takes back {called(memory, found.run)}")
        return Plans(self.opened).to_state(looked, goal, told=(note, *self._elsewhere()))

    def recover_plan(self) -> Plan:
        """Return the plan that sets down what hands still hold, sets back what the last run had set for a measurement
        where only a script could go on with it, and changes nothing else."""
        from pico.planning import PlanGoal

        refuse_in_use(self.opened)
        if memory := self.opened.edge.memory:
            self._as_before(memory)
        seen = self.opened.observe()
        wanted = live_state(self.opened.setup, self._emptied(seen))
        before = left_set(memory, seen) if memory else {}
        wanted = with_values(wanted, before)
        title = f"the state with empty grippers{f', and {listed(sorted(before))} as before' if before else ''}"
        target = Target(title=title, cause="recover")
        return Plans(self.opened).to_state(seen, PlanGoal(wanted, target))

    def _as_before(self, memory: Memory) -> None:
        """Move the bench in the fidelity of the last run, unless somebody asked for another."""
        if not self.opened.asked and (last := memory.last()) and (plan := document_if_any(memory, last)):
            self.opened.suit(plan)

    def settle(self) -> tuple[Diagnostic, ...]:
        """Record what became of operations that a killed run had begun, though there is nothing left to move, and have
        the bench left as an unattended one states whose process was killed; return how it is left then.

        Raises PicoError for what only a person can tell.
        """
        edge = self.opened.edge
        was_not_left = not_left(self.opened)
        if was_not_left or (edge.memory is not None and edge.memory.unsettled()):
            self.opened.wait(edge.release(self.opened.wait(edge.acquire("pico apply", self.opened.lock_timeout))))
        return unattended(self.opened) if was_not_left else ()

    def faults(self) -> tuple[DeviceFault, ...]:
        """Return the faults that devices of the bench keep until they are cleared. Raises PicoError for links that are
        lost."""
        try:
            return self.opened.wait(self.opened.edge.faults())
        except PicoError as exc:
            if self.opened.far is not None and exc.diagnostics[0].code == "link":  # an older edge or coordinator
                return ()
            raise

    def clear_fault(self, fault: DeviceFault) -> None:
        """Clear a fault, for a person who was at the table and confirmed that at a terminal; moves nothing.

        Raises PicoError for a bench of a coordinator, if the bench is in use (exit code LOCKED), and naming what is
        still to be done.
        """
        from pico.edge.lease import user

        if self.opened.far is not None:
            raise PicoError(_at_table(fault))
        self.opened.wait(self.opened.edge.clear_fault(fault.device, user()))

    def open_questions(self) -> list[Diagnostic]:
        """Return an error for each operation that only a person can tell the end of."""
        from pico.edge import recovery

        memory = self.opened.edge.memory
        return recovery.open_questions(memory.unsettled() if memory else ())

    def answer(self, key: str, *, done: bool) -> None:
        """Record what a person says of an operation that only a person can tell the end of; see `Edge.resolve`."""
        from pico.edge.lease import user

        self._require_here(key.partition("/")[0], f"recover --{'' if done else 'not-'}done {key}")
        self.opened.wait(self.opened.edge.resolve(key, "done" if done else "failed", user()))

    def _emptied(self, seen: Observation) -> Observation:
        """Return the bench as it is, with what hands hold where it will be set down."""
        from pico.planning.parts.setdown import set_downs

        return set_downs(self.opened.setup, seen, DeferredMotion(self.opened.setup)).seen

    def _memory(self) -> Memory:
        memory = self.opened.edge.memory
        if memory is None:
            raise PicoError(_no_run(self.opened.place))
        return memory

    def _require_here(self, word: str | None, command: str) -> None:
        """Raise PicoError if a word names no run of this bench, and one of another bench of this machine; `command`:
        what to call there."""
        from pico.history.runs.benches import fits, refuse_of_another

        memory = self.opened.edge.memory
        if word and (memory is None or not any(fits(word, one.run) for one in memory.runs())):
            refuse_of_another(self.opened.place, word, command)

    def _me(self) -> str:
        """Return what the journal calls the person who asks; at a coordinator that is the owner of the token."""
        from pico.edge.lease import user
        from pico.edge.network.asking import ask

        far = self.opened.far
        return user() if far is None else str(ask(far.remote, "GET", "/whoami")["name"])

    def _elsewhere(self) -> tuple[Diagnostic, ...]:
        """Return that a later run of this lab was on another bench of this machine, if so: this one was perhaps meant
        by mistake."""
        from pico.history.runs.benches import later_elsewhere

        other = later_elsewhere(self.opened.place)
        if not other:
            return ()
        text = (
            f"the last run of this lab was on the bench `{other}`, and this command acts on `{self.opened.place.title}`"
        )
        return (warning("other-bench", text, hint=f"add `--bench {other}` if that one is meant"),)


def _at_table(fault: DeviceFault) -> Diagnostic:
    """Return that a fault is cleared at the table only."""
    hint = f"{fault.check}; then a person calls `pico recover` at a terminal of the bench's own computer"
    return error(fault.code, f"{fault}; it is not cleared over a network", hint=hint, address=fault.device)


def _steered(component: str, robot: str | None) -> Diagnostic:
    """Return why a teleoperation is not taken up: nobody meant it to lead anywhere else than where it ended."""
    text = f"{component} was steered by a person, who alone can go on; it is where it was left"
    empty = f"`pico recover` sets {component} down where {robot} still holds it; " if robot else ""
    hint = f"{empty}`pico teleop {component}{'.pose' if robot else ''}` goes on, `pico undo` goes back"
    return error("nothing-to-resume", text, hint=hint, address=component)


def _recorded(began: Plan, last: RunRecord) -> Diagnostic:
    """Return why an open run is not taken up: nobody but its script or recipe knows what was to come."""
    hint = "`pico run --resume` goes on with the recipe, `pico undo` goes back to before this run"
    if began.target.recipe:
        text = f"run {last.run} is of the recipe {began.target.name}, which alone can go on with it"
        return error("nothing-to-resume", text, hint=hint)
    text = f"run {last.run} was recorded: {began.target.name}; its script alone can go on with it"
    hint = "`pico runs show` tells what it did; `pico recover` brings the bench to order, `pico undo` goes back"
    return error("nothing-to-resume", text, hint=hint)


def _goes_on(memory: Memory) -> str:
    """Return what goes on with a run that was cut short, where hands were only emptied after it."""
    runs = reversed(memory.runs())
    known = ((run, plan.target if (plan := document_if_any(memory, run)) else None) for run in runs)
    run, target = next(((r, t) for r, t in known if t is None or t.cause != "recover"), (None, None))
    if run is None or target is None or run.outcome == "done" or target.cause not in (None, "checkout"):
        return "`pico plan` shows what differs now"
    words = ["pico apply", target.revision, f"-- {' '.join(target.only)}" if target.only else None]
    return f"`{' '.join(filter(None, words))}` goes on with {run.run}, which was cut short before that"


def state_before(
    setup: Setup, memory: Memory, runs: Sequence[RunRecord], touched: Collection[str]
) -> tuple[LabState, list[str]]:
    """Return the bench before the first of some runs, the newest first, and which of the components that were `touched`
    a hand held then: they are where the run before found them."""
    names = renaming_of(setup.lab)
    plans = (document_of(memory, run) if run is runs[0] else document_if_any(memory, run) for run in runs)
    bases = (plan.base.state for plan in plans if plan)  # an older run that was salvaged has none
    states = (renamed_state(names, state_from_json(setup.lab.name, base)) for base in bases)
    parts = dict(next(states).components)
    held = [name for name in sorted(touched) if name not in parts]
    for state in states:
        parts = {**{n: p for n, p in state.components.items() if n in held}, **parts}
        if parts.keys() >= set(held):
            break
    known = {name: part for name, part in parts.items() if name in setup.lab.inventory}
    return LabState(lab=setup.lab.name, components=known), [name for name in held if name in known]


def in_slots(setup: Setup, seen: Observation, before: LabState) -> LabState:
    """Return a state with the slots by name of parts that stood right in them and stand elsewhere now."""
    parts = dict(before.components)
    for name, part in before.components.items():
        slot = slot_at(setup, part.pose) if part.pose and setup.movable(name) else None
        live = seen.components.get(name)
        away = live is None or live.pose is None or slot_at(setup, live.pose) != slot
        if slot and part.pose and away:
            right = deviation(setup, name, part.pose, None, setup.lab.slots[slot].pose) != "off"
            parts[name] = replace(part, slot=slot, pose=None) if right else part
    return replace(before, components=parts)


def _addresses(done: Collection[tuple[str, str]], left: Collection[tuple[str, str]]) -> tuple[str, ...]:
    """Return what a run did as it is named: a component, or its tunables where others of them are to be left alone."""
    apart = {component for component, _ in left}
    return tuple(sorted({f"{c}.{t}" if c in apart else c for c, t in done}))


def _cut_goals(memory: Memory, run: str) -> dict[str, Operation]:
    """Return the optimizations of a run that did not come to their end, by the key under which each was begun last: the
    process was gone, or a person stopped them."""
    from pico.model.operation import operation_from_json
    from pico.optimize.loop import STOPPED

    records = memory.records(run=run)
    begun = {r.key for r in records if r.kind == "started"}
    ended = {r.key for r in records if r.kind == "done" and (r.data.get("data") or {}).get("why") != STOPPED}
    found: dict[str, tuple[str, Operation]] = {}
    for record in records:
        if record.kind == "intent" and record.data.get("primitive") == "optimize" and record.key in begun:
            operation = operation_from_json(record.data)
            found[operation.address] = record.key, operation
    return {key: operation for key, operation in found.values() if key not in ended}


def _asked(plan: Plan, sought: Mapping[str, Operation]) -> tuple[str, ...]:
    """What a plan for single operations was about: their components, and what was to be set for them and back; of
    optimizations all that they may have changed."""
    if not plan.asked:
        return ()
    if sought:
        own = {f"{c}.{t}" for op in sought.values() for c, t in touched_by(op.component, op.arguments)}
        return tuple(sorted(own | {op.address for op in plan.operations if op.primitive == "set"}))
    own = {op.component for op in plan.operations if op.reason.kind == "asked" and op.primitive not in _WHOLE}
    back = [op for op in plan.operations if op.primitive in _WHOLE]  # they set back what they set
    own |= {f"{c}.{t}" for op in back for c, t in touched_by(op.component, op.arguments)}
    along = {f"{op.component}.{op.arguments['tunable']}" for op in plan.operations if op.primitive == "set"}
    return tuple(sorted({*own, *(one for one in along if one.partition(".")[0] not in own)}))


def _left_out(
    began: Plan, memory: Memory, run: str, sought: Mapping[str, Operation]
) -> Iterator[Diagnostic]:  # fmt: skip
    """Yield a note for each measurement of a run, or setting that was to be found by one, that it did not come to: no
    state holds it, so it is not taken up again; and for each optimization that is, from where it begins."""
    done = {r.key.rpartition("/")[0] for r in memory.records(run=run) if r.kind == "done"}
    taken_up = {op.address for op in sought.values()}
    for name in sorted(taken_up):
        text = f"`pico optimize {name}` was cut short: what it set goes back to where it stood before, then it begins"
        yield Diagnostic("note", "taken-up", f"{text} at the best point that it had measured")
    told = set[str]()
    whole = next((_WHOLE[op.primitive] for op in began.operations if op.primitive in _WHOLE), "")
    for op in began.operations:
        if op.primitive == "optimize" and op.address in taken_up:
            continue
        if op.reason.kind == "asked" and not (op.kind.changes == "pose" or "to" in op.arguments):
            if f"{run}/{op.id}" in done:
                continue
            words = [op.primitive, *(str(v) for k, v in op.arguments.items() if k in ("measurable", "tunable"))]
            command = f"pico do {op.component} {' '.join(words)}"
            if "measurable" in op.arguments:
                command = whole or f"pico measure {op.component}.{op.arguments['measurable']}"  # its readings, too
            if op.primitive == "optimize":
                command = f"pico optimize {op.address}"
            if op.primitive in _WHOLE:
                command = _WHOLE[op.primitive]
            if command in told:
                continue
            told.add(command)
            text = f"`{command}` did not come to its end, and is not taken up again"
            yield Diagnostic("note", "left-out", text, hint=f"`{command}` does it anew", address=op.component)


def _last(place: Place, memory: Memory) -> RunRecord:
    last = memory.last()
    if last is None:
        raise PicoError(_no_run(place))
    return last


def _no_run(place: Place) -> Diagnostic:
    from pico.history.runs.benches import later_elsewhere

    other = later_elsewhere(place)
    hint = f"the last run was on `{other}`: add `--bench {other}`" if other else "`pico plan`"
    return error("no-run", f"the journal of the bench `{place.title}` knows no run that moved anything", hint=hint)
