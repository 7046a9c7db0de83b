"""One operation at a time, as `pico do` asks for it, through the same checks as a plan."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, slot_meant
from pico.model.diff import Change, describe_value
from pico.model.observation import Observation, live_state, with_value
from pico.model.operation import Operation, Reason, new_id, searched_by
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.primitive import primitive
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, state_from_json
from pico.model.vocabulary import measured_in
from pico.motion.types import Motion
from pico.planning.checks.beams import shutter_of
from pico.planning.checks.emission import left_shut, refused
from pico.planning.checks.interlocks import policy_rules, stay_shut, unguarded, with_interlocks
from pico.planning.compile import compiled_plan
from pico.planning.measuring import measuring, unlit
from pico.planning.optimizing import Turn, optimizing
from pico.planning.parts.setdown import parked_first
from pico.planning.realigning import measured_last
from pico.planning.request import Request
from pico.planning.schedule import makespan, schedule
from pico.planning.sought import Sought, sought_by, tunables_of
from pico.planning.surveying import Shots, surveying
from pico.planning.teleoperating import kept_dark, steered, teleoperating
from pico.planning.values import home_operation, value_operations

if TYPE_CHECKING:
    from pico.optics.nominal.feeding import Right

ASKED = Reason(kind="asked")


def move_one(
    setup: Setup, seen: Observation, component: str, to: Pose | str, *, motion: Motion | None, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None,
) -> Plan:  # fmt: skip
    """Return the plan that takes `component` to a pose or a slot and moves nothing else.

    The plan is errored where that is not possible without moving something else first. Raises PicoError for a
    component that the lab does not have or that is not seen, and for an unknown slot.
    """
    _part(setup, seen, component)
    if isinstance(to, str) and to not in setup.lab.slots:
        raise PicoError(error("unknown-slot", f"there is no slot `{to}`", hint=slot_meant(to, setup.lab.slots)))
    place = ComponentState(slot=to) if isinstance(to, str) else ComponentState(pose=to)
    wanted = _live_with(setup, seen, component, place)
    request = Request(setup, seen, wanted, motion, exact=not isinstance(to, str), alone=True, reason=ASKED)
    plan = compiled_plan(
        request, backend=backend, fidelity=fidelity, base=base or Base(state=live_state(setup, seen).as_json()),
        target=Target(state=wanted.as_json(), cause="single"),
    )  # fmt: skip
    return replace(plan, changes=tuple(c for c in plan.changes if c.component == component)).sealed()


def set_one(
    setup: Setup, seen: Observation, component: str, tunable: str, value: Value, *, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None,
) -> Plan:  # fmt: skip
    """Return the plan that brings one tunable to a value.

    The value is taken as it is. Raises PicoError for a component or tunable that there is not.
    """
    _tunable(setup, seen, component, tunable)
    live = _live_with(setup, seen, component, None, {tunable: value})
    known = seen.components[component].values[tunable]
    before = None if known.status == "unknown" else known.value
    text = describe_value(setup.type_of(component).tunables[tunable], before, value)
    change = Change(component=component, tunable=tunable, before=before, after=value, text=text)
    changes = () if before == value else (change,)
    operations, notes = value_operations(setup, seen, changes, ASKED)
    return _sealed(setup, seen, operations, notes, backend, fidelity, base, live, changes)


def home_one(
    setup: Setup, seen: Observation, component: str, tunable: str, *, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None,
) -> Plan:  # fmt: skip
    """Return the plan that homes the axis of one tunable.

    Raises PicoError for a component or tunable that there is not, and for one without an axis that can be homed.
    """
    _tunable(setup, seen, component, tunable)
    kind = setup.type_of(component).tunables[tunable]
    if kind.axis is None or kind.axis.kind != "homed":
        raise PicoError(error(
            "unsupported", f"{component}.{tunable} has no axis to home", address=f"{component}.{tunable}",
        ))  # fmt: skip
    live = seen.components[component].values.get(tunable)
    operation = home_operation(component, tunable, kind, live.value if live else None, ASKED)
    return _sealed(setup, seen, [operation], [], backend, fidelity, base, live_state(setup, seen), ())


def do_one(
    setup: Setup, seen: Observation, component: str, name: str, arguments: Mapping[str, Value], *, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None, motion: Motion | None = None,
) -> Plan:  # fmt: skip
    """Return the plan of a primitive that a device does and that brings about no state; one that takes pictures for it
    needs what a picture needs.

    Raises PicoError for a component that the lab does not have or that is not seen, and for a setting without a range
    where one is to be found.
    """
    _part(setup, seen, component)
    setting = setup.type_of(component).tunables.get(str(arguments.get("tunable")))
    if name == "auto_range" and setting is not None and setting.range is None:
        text = f"{component}.{arguments['tunable']} has no `range`, within which to look for the right one"
        raise PicoError(error("range", text, hint="give it one in its type", address=component))
    if name == "auto_range" and "image" in setup.measurables_of(component):
        made = measuring(setup, seen, [(component, "image")], ASKED, motion)
        own = (f"{component}.{arguments.get('tunable')}",)
        ranging = [
            op if op.primitive != "measure" else replace(
                op, primitive=name, arguments=arguments, resources=(*own, *op.resources),
                seconds=primitive(name).seconds,
            )
            for op in made
        ]  # fmt: skip
        return _sealed(setup, seen, ranging, [], backend, fidelity, base, live_state(setup, seen), ())
    operation = Operation(
        id=new_id(), primitive=name, component=component, arguments=arguments, resources=(component,), reason=ASKED,
        seconds=primitive(name).seconds,
    )  # fmt: skip
    return _sealed(setup, seen, [operation], [], backend, fidelity, base, live_state(setup, seen), ())


def measure(
    setup: Setup, seen: Observation, wanted: Sequence[tuple[str, str]], *, motion: Motion | None, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None, goals: Sequence[Turn] = (),
) -> Plan:  # fmt: skip
    """Return the plan that measures `wanted` and leaves the bench as it was, arms parked.

    Each is a component or camera with one of its `Setup.measurables_of`. `goals`: those that are measured before that
    where their tunables stand, see `pico.planning.verifying`.
    """
    first = optimizing(setup, seen, goals, motion) if goals else []
    operations = [*first, *measured_last(setup, seen, wanted, ASKED, motion, first)]
    spoken = measured_in(setup, [text for turn in goals for text in turn.texts])
    notes = [*left_shut(seen, unlit(setup, seen, [*spoken, *wanted]))]
    return _sealed(setup, seen, operations, notes, backend, fidelity, base, live_state(setup, seen), ())


def optimize_one(
    setup: Setup, seen: Observation, one: Sought, *, motion: Motion | None, first: Sequence[Sought] = (),
    took: float | None = None, backend: str = "sim", fidelity: str = "kinematic", base: Base | None = None,
    right: Sequence[Right] = (),
) -> Plan:  # fmt: skip
    """Return the plan that brings light to a goal, by those that are sought `first` where it is dark, and leaves all
    else as it is. `right`: benches with the light that it is to have; what is seen to stand otherwise is made up for.
    `took`: the seconds that it is reckoned with, where that is known.

    Raises PicoError for a component that is not seen, and for tunables of which nobody knows where they stand.
    """
    for component in {address.partition(".")[0] for address in tunables_of(one, first)}:
        _part(setup, seen, component)
    operations = optimizing(setup, seen, [Turn(one, tuple(first), took, right=tuple(right))], motion)
    texts = [text for stage in (*first, one) for text in stage.goal.texts]
    notes = [*left_shut(seen, unlit(setup, seen, measured_in(setup, texts)))]
    return _sealed(setup, seen, operations, notes, backend, fidelity, base, live_state(setup, seen), ())


def arm_one(
    setup: Setup, seen: Observation, laser: str, *, motion: Motion | None, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None,
) -> Plan:  # fmt: skip
    """Return the plan that lets a laser emit, arms parked before: it is switched on, and what shuts it opened.

    Raises PicoError for what is no laser here, or is not seen.
    """
    _part(setup, seen, laser)
    gate = laser if "shutter" in setup.type_of(laser).tunables else shutter_of(setup, seen, (), laser)
    wanted: list[tuple[str, str, Value]] = (
        [(laser, "emission", True)] if "emission" in setup.type_of(laser).tunables else []
    )
    wanted += [(gate, "shutter", "open")] if gate else []
    changes, live = [], live_state(setup, seen)
    for component, tunable, value in wanted:
        _tunable(setup, seen, component, tunable)
        known = seen.components[component].values[tunable]
        before = None if known.status == "unknown" else known.value
        if before != value:
            text = describe_value(setup.type_of(component).tunables[tunable], before, value)
            changes.append(Change(component=component, tunable=tunable, before=before, after=value, text=text))
        now = live.components.get(component, ComponentState())
        live = LabState(lab=live.lab, components={
            **live.components, component: replace(now, values={**now.values, tunable: value})
        })  # fmt: skip
    operations, notes = value_operations(setup, seen, tuple(changes), ASKED)
    operations = [replace(op, after=tuple(o.id for o in operations[:n])) for n, op in enumerate(operations)]
    return _sealed(
        setup, seen, parked_first(setup, seen, operations, motion), notes, backend, fidelity, base, live, tuple(changes)
    )


def park(
    setup: Setup, seen: Observation, *, motion: Motion | None, backend: str = "sim", fidelity: str = "kinematic",
    base: Base | None = None,
) -> Plan:  # fmt: skip
    """Return the plan that parks the arms that were stopped on their way with an empty hand; others stay."""
    parks = parked_first(setup, seen, [], motion)
    return _sealed(setup, seen, parks, [], backend, fidelity, base, live_state(setup, seen), ())


def again(
    setup: Setup, seen: Observation, plan: Plan, sought: Mapping[str, Operation], *, motion: Motion | None
) -> Plan:  # fmt: skip
    """Return a plan with optimizations after all of its operations, which bring their tunables back to where each had
    begun; `sought`: those that were cut short, by their keys.

    Raises PicoError for tunables of which nobody knows where they stand then.
    """
    out, after = [*plan.operations], seen
    for op in plan.operations:
        if op.primitive == "set":
            after = with_value(after, op.component, str(op.arguments["tunable"]), op.arguments["to"])
    for key, cut in sought.items():
        one, stages = sought_by(cut.arguments)
        waits = [op.id for op in out]
        for op in optimizing(setup, after, [Turn(one, stages)], motion, out):
            given = {**op.arguments, "again": key} if op.primitive == "optimize" else op.arguments
            out.append(replace(op, arguments=given, after=tuple(dict.fromkeys((*waits, *op.after)))))
    timed, tuned = schedule(out), {address for cut in sought.values() for address in searched_by(cut.arguments)}
    wanted = _without(state_from_json(plan.lab.name, plan.target.state), tuned)  # these have their last word by light
    return replace(
        plan, operations=timed, makespan=makespan(timed), policy=policy_rules(setup, seen, timed),
        target=replace(plan.target, state=wanted.as_json()),
    ).sealed()  # fmt: skip


def _without(state: LabState, tuned: Collection[str]) -> LabState:
    """Return a state that says nothing of some tunables."""
    parts = {
        name: replace(part, values={t: v for t, v in part.values.items() if f"{name}.{t}" not in tuned})
        for name, part in state.components.items()
    }
    return replace(state, components=parts)


def teleoperate_one(
    setup: Setup, seen: Observation, component: str, tunable: str | None, *, motion: Motion, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None,
) -> Plan:  # fmt: skip
    """Return the plan in which a person steers a component: one of its tunables, `pose`, or for None what motors and
    electronics set of it.

    Raises PicoError for what there is not, what nobody can steer, and what nobody knows where it stands.
    """
    _part(setup, seen, component)
    operations = teleoperating(setup, seen, component, steered(setup, component, tunable), motion)
    return _sealed(
        setup, seen, operations, [], backend, fidelity, base, live_state(setup, seen), (), cause="teleoperation"
    )


def survey(
    setup: Setup, seen: Observation, shots: Shots, dark: Sequence[str], *, motion: Motion | None, backend: str = "sim",
    fidelity: str = "kinematic", base: Base | None = None,
) -> Plan:  # fmt: skip
    """Return the plan that reads all `shots`, and frames in the dark of some cameras, and leaves all as it is.

    Raises PicoError for tunables of which nobody knows where they stand.
    """
    operations = surveying(setup, seen, shots, dark, motion)
    return _sealed(setup, seen, operations, [], backend, fidelity, base, live_state(setup, seen), ())


def _sealed(
    setup: Setup, seen: Observation, operations: list[Operation], notes: list[Diagnostic], backend: str, fidelity: str,
    base: Base | None, wanted: LabState, changes: tuple[Change, ...], cause: str = "single",
) -> Plan:  # fmt: skip
    guarded, told = kept_dark(setup, with_interlocks(setup, seen, operations))
    timed = schedule(guarded)
    notes = [*notes, *told, *unguarded(setup, seen, timed), *refused(setup, seen, timed)]
    notes += left_shut(seen, stay_shut(setup, seen, operations))
    return Plan(
        lab=LabRef(name=setup.lab.name, digest=setup.digest()), backend=backend, fidelity=fidelity,
        base=base or Base(state=live_state(setup, seen).as_json()),
        target=Target(state=wanted.as_json(), cause=cause), changes=changes, operations=timed,
        makespan=makespan(timed), policy=policy_rules(setup, seen, timed), diagnostics=tuple(notes),
    ).sealed()  # fmt: skip


def _live_with(
    setup: Setup, seen: Observation, component: str, place: ComponentState | None,
    values: Mapping[str, Value] | None = None,
) -> LabState:  # fmt: skip
    """Return the live state with one component's place or some of its values replaced."""
    live = live_state(setup, seen)
    now = live.components.get(component, ComponentState())
    changed = ComponentState(
        slot=place.slot if place else now.slot,
        pose=place.pose if place else now.pose,
        values={**now.values, **(values or {})},
    )
    return LabState(lab=live.lab, components={**live.components, component: changed})


def _part(setup: Setup, seen: Observation, component: str) -> None:
    if component not in setup.lab.inventory:
        hint = did_you_mean(component, setup.lab.inventory)
        raise PicoError(error("unknown-component", f"the lab has no component `{component}`", hint=hint))
    part = seen.components.get(component)
    if part is None or part.presence != "seen" or part.pose is None:
        what = part.presence if part else "missing"
        hint = "`pico recover` sets it down" if what == "held" else "`pico drift` says what is seen of it"
        text = f"{component} is {what}: it must be seen standing on the table first"
        raise PicoError(error("missing", text, hint=hint))


def _tunable(setup: Setup, seen: Observation, component: str, tunable: str) -> None:
    _part(setup, seen, component)
    known = setup.type_of(component).tunables
    if tunable not in known:
        raise PicoError(error(
            "unknown-tunable", f"{component} has no tunable `{tunable}`", hint=did_you_mean(tunable, known),
            address=component,
        ))  # fmt: skip
    if tunable not in seen.components[component].values:
        raise PicoError(error("unsupported", f"the backend does not model {component}.{tunable}"))
