"""A teleoperation as an operation: what a person steers of a component, and by which hand."""

from __future__ import annotations

from dataclasses import replace

from pico.diagnostics import Diagnostic, ExitCode, PicoError, did_you_mean, error, warning
from pico.model.catalog import Tunable
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason, new_id
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.motion.types import Blocked, Motion
from pico.planning.checks.emission import lets_out
from pico.planning.parts.movers import standing_obstacles
from pico.planning.parts.setdown import park_operation
from pico.planning.passes.draft import Draft

ASKED = Reason(kind="asked")
SECONDS = 30.0
"""What a plan reckons with for as long as a person may take [s]."""
POSE = "pose"


def steered(setup: Setup, component: str, tunable: str | None) -> tuple[str, ...]:
    """Return what of a component a person steers: the tunable that is named, else all that a motor or electronics set
    as numbers; where there are none, `pose`. Raises PicoError for what nobody can steer."""
    kind = setup.type_of(component)
    able = tuple(name for name, one in sorted(kind.tunables.items()) if _steerable(one))
    if tunable is None:
        return able or (POSE,)
    if tunable in able or tunable == POSE:
        return (tunable,)
    if tunable in kind.tunables:
        text = f"{component}.{tunable} is not steered: only numbers that a motor or electronics set are"
        raise PicoError(error("usage", text, hint=f"`pico set {component} {tunable}=VALUE` sets it", address=component))
    known = (*able, POSE)
    hint = did_you_mean(tunable[:40], known) or f"what is steered: {', '.join(known)}"
    raise PicoError(error("unknown-tunable", f"{component} has no tunable `{tunable[:40]}`", hint=hint))


def _steerable(kind: Tunable) -> bool:
    return kind.datatype == "float" and kind.mover in ("motor", "electronics")


def teleoperating(
    setup: Setup, seen: Observation, component: str, tunables: tuple[str, ...], motion: Motion | None
) -> list[Operation]:
    """Return the operations in which a person steers a component.

    Raises PicoError where nobody knows where something stands, and where no hand can take the part.
    """
    if tunables == (POSE,):
        return _by_arm(setup, seen, component, motion)
    kinds = setup.type_of(component).tunables
    begin = {}
    for name in tunables:
        live = seen.components[component].values.get(name)
        if live is None or live.status == "unknown" or not isinstance(live.value, int | float):
            hint = f"`pico do {component} home {name}` finds out"
            raise PicoError(error("unknown", f"nobody knows where {component}.{name} stands", hint=hint))
        begin[f"{component}.{name}"] = float(live.value)
    bounds = {f"{component}.{name}": _bounds(kinds[name]) for name in tunables}
    held = [f"motor/{a}" if kinds[a.partition(".")[2]].mover == "motor" else a for a in bounds]
    return [Operation(
        id=new_id(), primitive="teleoperate", component=component, reason=ASKED, seconds=SECONDS,
        arguments={"what": {"tunables": bounds}, "from": begin},
        resources=(*held, component, *sorted(setup.lab.robots)),
    )]  # fmt: skip


def _bounds(kind: Tunable) -> list[float] | None:
    """The range over which something is steered, and over which the beam audit judges it; None where it has none."""
    if kind.range is not None:
        return [*kind.range]
    return [-kind.period / 2, kind.period / 2] if kind.period else None


def _by_arm(setup: Setup, seen: Observation, component: str, motion: Motion | None) -> list[Operation]:
    robot, yaw = _hand(setup, seen, component, motion)
    pose = seen.components[component].pose
    steer = Operation(
        id=new_id(), primitive="teleoperate", component=component, robot=robot, reason=ASKED, seconds=SECONDS,
        arguments={
            "what": {"tunables": {f"{component}.{POSE}": None}}, "from": {"pose": as_json(pose)}, "grasp_yaw": yaw,
        },
        resources=(robot, component, *(other for other in sorted(setup.lab.robots) if other != robot)),
    )  # fmt: skip
    return [steer, park_operation(setup, seen, robot, (steer.id,), motion)]


def _hand(setup: Setup, seen: Observation, component: str, motion: Motion | None) -> tuple[str, float]:
    """Return the first robot, with the direction in which its jaws close, that can take a component where it stands."""
    pose, grasp = seen.components[component].pose, setup.type_of(component).geometry.grasp
    assert pose is not None and motion is not None  # the caller looked, and arms are to move
    if not setup.movable(component) or grasp is None:
        text = f"no arm can move {component}: only a person can"
        raise PicoError(error("operator", text, address=component), ExitCode.IMPOSSIBLE)
    standing = {o.name: o.standing for o in standing_obstacles(setup, seen, {})}
    why: Diagnostic | None = None
    for robot, state in sorted(seen.robots.items()):
        if state.holding:
            text = f"{robot} holds {state.holding}"
            why = why or error("hand-full", text, hint="`pico recover` sets it down", address=state.holding)
            continue
        others = {name: other.joints for name, other in seen.robots.items() if name != robot}
        for yaw in grasp.yaws:
            found = motion.take(robot, component, pose, yaw, standing, state.joints, others)
            if not isinstance(found, Blocked):
                return robot, yaw
            text = f"{component} cannot be taken in hand: {found.text}"
            why = why or error("impossible", text, hint=found.help, address=component)
    none = error("operator", f"no arm of this lab can take {component}", address=component)
    raise PicoError(why or none, ExitCode.IMPOSSIBLE)


def kept_dark(draft: Draft) -> Draft:
    """Return the plan without what lets light out again after an arm that a person steers, and with what is said of
    each: where its part ends nobody knows, so that nothing could be said of the light."""
    steers = any(op.primitive == "teleoperate" and op.robot for op in draft.operations)
    shut = {op.id: op.component for op in draft.operations if steers and lets_out(draft.setup, op)}
    kept = (op for op in draft.operations if op.id not in shut)
    left = (replace(op, after=tuple(e for e in op.after if e not in shut)) for op in kept)
    return replace(draft, operations=tuple(left)).told(*(
        warning(
            "shut", f"{name} stays shut afterwards: where its light goes then is not known yet",
            hint=f"`pico set {name} shutter=open` lets it out, after the beam audit", address=f"{name}.shutter",
        )
        for name in shut.values()
    ))  # fmt: skip
