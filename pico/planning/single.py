"""One operation at a time, as `pico do` asks for it: goals of the planner, through the same checks as other plans.

planner.plan(move_one(planner, "p2", Pose(520, 420)))
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, slot_meant
from pico.model.diff import Change, describe_value
from pico.model.observation import Observation, live_state, slot_at
from pico.model.operation import Operation, Reason, new_id
from pico.model.plan import Target
from pico.model.pose import Pose
from pico.model.primitive import faults, primitive
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, with_values
from pico.model.vocabulary import measured_in
from pico.planning.checks.beams import shutter_of
from pico.planning.checks.conditions import refused
from pico.planning.checks.emission import left_shut
from pico.planning.goal_light import goal_light, standing_poses
from pico.planning.measuring import measuring, unlit
from pico.planning.optimizing import Turn, optimizing
from pico.planning.parts.setdown import parked_first
from pico.planning.passes.goal import PlanGoal
from pico.planning.passes.values import home_operation, value_operations
from pico.planning.planner import Planner
from pico.planning.realigning import measured_last
from pico.planning.routines import with_arm
from pico.planning.sought import Sought, tunables_of
from pico.planning.surveying import Shots, surveying
from pico.planning.teleoperating import steered, teleoperating

if TYPE_CHECKING:
    from pico.optics.nominal.feeding import Right

ASKED = Reason(kind="asked")


def move_one(planner: Planner, component: str, to: Pose | str) -> PlanGoal:
    """Return the goal that takes `component` to a pose or a slot and moves nothing else.

    The plan is errored where that is not possible without moving something else first. Raises PicoError for a
    component that the lab does not have or that is not seen, and for an unknown slot.
    """
    setup, seen = planner.setup, planner.seen
    _part(setup, seen, component)
    if isinstance(to, str) and to not in setup.lab.slots:
        raise PicoError(error("unknown-slot", f"there is no slot `{to}`", hint=slot_meant(to, setup.lab.slots)))
    live = live_state(setup, seen)
    place = ComponentState(slot=to) if isinstance(to, str) else ComponentState(pose=to)
    stands = replace(place, values=live.components.get(component, ComponentState()).values)
    wanted = LabState(lab=live.lab, components={**live.components, component: stands})
    return PlanGoal(wanted, Target(cause="single"), exact=not isinstance(to, str), alone=component)


def set_values(planner: Planner, component: str, values: Mapping[str, Value]) -> PlanGoal:
    """Return the goal that brings tunables of a component to values, side by side as far as their motors can.

    The values are taken as they are. Raises PicoError for a component or tunable that there is not.
    """
    return _set(planner, {(component, tunable): value for tunable, value in values.items()})


def home_one(planner: Planner, component: str, tunable: str) -> PlanGoal:
    """Return the goal that homes the axis of one tunable.

    Raises PicoError for a component or tunable that there is not, and for one without an axis that can be homed.
    """
    setup, seen = planner.setup, planner.seen
    _tunable(setup, seen, component, tunable)
    kind = setup.type_of(component).tunables[tunable]
    if kind.axis is None or kind.axis.kind != "homed":
        raise PicoError(error(
            "unsupported", f"{component}.{tunable} has no axis to home", address=f"{component}.{tunable}",
        ))  # fmt: skip
    live = seen.components[component].values.get(tunable)
    return _asked(planner, [home_operation(component, tunable, kind, live.value if live else None, ASKED)])


def do_one(planner: Planner, component: str, name: str, arguments: Mapping[str, Value]) -> PlanGoal:
    """Return the goal of a primitive that a device does, or an arm with a tool, and that brings about no state; one
    that takes pictures for it needs what a picture needs.

    Raises PicoError for a component that the lab does not have or that is not seen, for a setting without a range
    where one is to be found, and where what the primitive requires does not hold.
    """
    setup, seen = planner.setup, planner.seen
    _part(setup, seen, component)
    setting = setup.type_of(component).tunables.get(str(arguments.get("tunable")))
    if name == "auto_range" and setting is not None and setting.range is None:
        text = f"{component}.{arguments['tunable']} has no `range`, within which to look for the right one"
        raise PicoError(error("range", text, hint="give it one in its type", address=component))
    if (broken := faults().get(name)) is not None:
        raise PicoError(broken)
    seconds = primitive(name).seconds
    if name == "auto_range" and "image" in setup.measurables_of(component):
        own = (f"{component}.{arguments.get('tunable')}",)
        return _asked(planner, [
            op if op.primitive != "measure" else replace(
                op, primitive=name, arguments=arguments, resources=(*own, *op.resources), seconds=seconds
            )
            for op in measuring(setup, seen, [(component, "image")], ASKED, planner.motion)
        ])  # fmt: skip
    one = Operation(
        id=new_id(), primitive=name, component=component, arguments=arguments, resources=(component,), reason=ASKED,
        seconds=seconds,
    )  # fmt: skip
    if wrong := refused(setup, seen, one):
        raise PicoError(wrong)
    return _asked(planner, [with_arm(setup, planner.motion, seen, one) if planner.motion else one])


def measure(planner: Planner, wanted: Sequence[tuple[str, str]], goals: Sequence[Turn] = ()) -> PlanGoal:
    """Return the goal that measures `wanted` and leaves the bench as it was, arms parked.

    Each is a component or camera with one of its `Setup.measurables_of`. `goals`: those that are measured before that
    where their tunables stand, see `pico.planning.verifying`.
    """
    setup, seen, motion = planner.setup, planner.seen, planner.motion
    first = optimizing(setup, seen, goals, motion) if goals else []
    spoken = measured_in(setup, [text for turn in goals for text in turn.texts])
    return _asked(
        planner, [*first, *measured_last(setup, seen, wanted, ASKED, motion, first)],
        left_shut(seen, unlit(setup, seen, [*spoken, *wanted])),
    )  # fmt: skip


def optimize_one(
    planner: Planner, one: Sought, *, first: Sequence[Sought] = (), took: float | None = None,
    right: Sequence[Right] = (),
) -> PlanGoal:  # fmt: skip
    """Return the goal that brings light to what is sought, by those that are sought `first` where it is dark, and
    leaves all else as it is. `right`: benches with the light that it is to have; what is seen to stand otherwise is
    made up for. `took`: the seconds that it is reckoned with, where that is known.

    Raises PicoError for a component that is not seen, for one in storage, through which no light comes, and for
    tunables of which nobody knows where they stand.
    """
    setup, seen = planner.setup, planner.seen
    for component in {address.partition(".")[0] for address in tunables_of(one, first)}:
        _part(setup, seen, component)
    _require_unstored(setup, seen, one)
    texts = [text for stage in (*first, one) for text in stage.goal.texts]
    return _asked(
        planner, optimizing(setup, seen, [Turn(one, tuple(first), took, right=tuple(right))], planner.motion),
        left_shut(seen, unlit(setup, seen, measured_in(setup, texts))),
    )  # fmt: skip


def arm_one(planner: Planner, laser: str) -> PlanGoal:
    """Return the goal that lets a laser emit, arms parked before: it is switched on, and what shuts it opened.

    Raises PicoError for what is no laser here, or is not seen.
    """
    setup, seen = planner.setup, planner.seen
    _part(setup, seen, laser)
    known = setup.type_of(laser).tunables
    gate = laser if "shutter" in known else shutter_of(setup, seen, (), laser)
    wanted: dict[tuple[str, str], Value] = {(laser, "emission"): True} if "emission" in known else {}
    opened = _set(planner, {**wanted, **({(gate, "shutter"): "open"} if gate else {})})
    made = opened.operations or ()
    operations = [replace(op, after=tuple(o.id for o in made[:n])) for n, op in enumerate(made)]
    return replace(opened, operations=parked_first(setup, seen, operations, planner.motion))


def park(planner: Planner) -> PlanGoal:
    """Return the goal that parks the arms that were stopped on their way with an empty hand; others stay."""
    return _asked(planner, parked_first(planner.setup, planner.seen, [], planner.motion))


def teleoperate_one(planner: Planner, component: str, tunable: str | None) -> PlanGoal:
    """Return the goal in which a person steers a component: one of its tunables, `pose`, or for None what motors and
    electronics set of it.

    Raises PicoError for what there is not, what nobody can steer, and what nobody knows where it stands.
    """
    setup, seen = planner.setup, planner.seen
    _part(setup, seen, component)
    steers = teleoperating(setup, seen, component, steered(setup, component, tunable), planner.motion)
    return _asked(planner, steers, cause="teleoperation")


def survey(planner: Planner, shots: Shots, dark: Sequence[str]) -> PlanGoal:
    """Return the goal that reads all `shots`, and frames in the dark of some cameras, and leaves all as it is.

    Raises PicoError for tunables of which nobody knows where they stand.
    """
    return _asked(planner, surveying(planner.setup, planner.seen, shots, dark, planner.motion))


def _set(planner: Planner, values: Mapping[tuple[str, str], Value]) -> PlanGoal:
    """Return the goal that brings tunables to values."""
    setup, seen, changes = planner.setup, planner.seen, list[Change]()
    for (component, tunable), value in values.items():
        _tunable(setup, seen, component, tunable)
        known = seen.components[component].values[tunable]
        before = None if known.status == "unknown" else known.value
        if before != value:
            text = describe_value(setup.type_of(component).tunables[tunable], before, value)
            changes.append(Change(component=component, tunable=tunable, before=before, after=value, text=text))
    operations, notes = value_operations(setup, seen, changes, ASKED)
    wanted = with_values(live_state(setup, seen), {f"{name}.{tunable}": v for (name, tunable), v in values.items()})
    return replace(_asked(planner, operations, notes), wanted=wanted, changes=tuple(changes))


def _asked(
    planner: Planner, operations: Sequence[Operation], notes: Sequence[Diagnostic] = (), cause: str = "single"
) -> PlanGoal:
    """Return the goal of operations that leave the state of the bench as it is."""
    live = live_state(planner.setup, planner.seen)
    return PlanGoal(live, Target(cause=cause), operations=tuple(operations), notes=tuple(notes))


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


def _require_unstored(setup: Setup, seen: Observation, one: Sought) -> None:
    """Raise PicoError where a part of a goal is in storage, where no light is to be found however it is tuned."""
    poses = standing_poses(seen)
    stored = {name: slot_at(setup, poses[name]) for name in poses if setup.movable(name)}
    for name in sorted(goal_light(setup, seen, one.goal).dark):
        if slot := stored.get(name):
            text = f"{name} is in {slot}, and no light of {one.name} comes there"
            hint = f"bring it there first: `pico move {name} x=... y=...`, or `pico apply` of a state with it"
            raise PicoError(error("goal", text, hint=hint, address=name))


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
