"""One operation as a person asks for it (`pico do p2 move x=500 yaw=30`), checked against the bench."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Any

from pico.diagnostics import PicoError, did_you_mean, slot_meant
from pico.kernels.pipeline import spelt
from pico.model.address import renaming_of
from pico.model.catalog import Tunable
from pico.model.measurement import Measurement
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose, wrap
from pico.model.primitive import primitive
from pico.model.quantities import Value
from pico.model.record import as_json, record
from pico.model.setpoint import STEP, read_quantity, read_value, stepped, wrong
from pico.model.setup import Setup
from pico.model.state import LabState, place_of


@record
class PrimitiveRequest:
    """One primitive of one component: `move` to a `pose` or `slot`, `stow`, `set` tunables to `values`, `home` a
    `tunable`, or `measure` a `measurable`; of a plug-in's the `arguments`, numbers in the units that it declares."""

    component: str
    primitive: str
    pose: Pose | None = None
    slot: str | None = None
    tunable: str | None = None
    values: Mapping[str, Value] = field(default_factory=dict)
    measurable: str | None = None
    arguments: Mapping[str, Value] = field(default_factory=dict)


def asked(setup: Setup, seen: Observation, component: str, name: str, arguments: Mapping[str, str]) -> PrimitiveRequest:
    """Return the request that `key=value` arguments amount to; what is not named of a pose stays as observed.

    Raises PicoError naming what is unknown, of the wrong unit, out of range or missing.
    """
    if name == "measure":
        return _measure(setup, component, arguments)
    require_component(setup, component)
    allowed = setup.type_of(component).primitives
    if name not in allowed:
        known = sorted({*allowed, *(("measure",) if setup.measurables_of(component) else ())})
        hint = did_you_mean(name, known) or f"what can be done with it: {', '.join(known)}"
        can = "no arm can move it: only a person can" if name in ("move", "stow") else f"it knows no `{name}`"
        raise wrong(f"{component}: {can}", hint, component)
    if name == "scan":
        raise wrong(f"{name} of {component}: a scan is a step of recipes, which are not there yet", "")
    reader = {"move": _move, "stow": _stow, "set": _set, "home": _home, "auto_range": _auto_range}.get(name)
    return reader(setup, seen, component, dict(arguments)) if reader else _plain(component, name, arguments)


def as_stated(setup: Setup, state: LabState) -> Observation:
    """Return the bench as a state says, to count from: each part where the state has it, at home if it does not name
    it; what the state gives no number is unknown."""
    parts = {}
    for name in setup.lab.inventory:
        own = state.components.get(name)
        values = {k: ObservedValue(value=v) for k, v in own.values.items()} if own else {}
        parts[name] = ObservedComponent(pose=place_of(setup, state, name)[1], values=values)
    return Observation(backend="", components=parts)


def require_component(setup: Setup, name: str) -> None:
    """Raise PicoError where the inventory has no part of that name."""
    if name not in setup.lab.inventory:
        now = renaming_of(setup.lab).get(name)
        hint = f"it is now called `{now}`" if now else ""
        hint = hint or did_you_mean(name, setup.lab.inventory) or "`pico catalog parts` lists them"
        if name in setup.lab.cameras:
            _refuse_on_arm(setup, name)
            hint = f"`{name}` is a camera over the bench: `pico get {name}.frame` peeks at what it sees"
        raise wrong(f"there is no component `{name}` in {setup.lab.name}", hint)


def _refuse_on_arm(setup: Setup, name: str) -> None:
    """Raise PicoError where a camera is on an arm."""
    if robot := setup.lab.cameras[name].robot:
        over = next((c for c, camera in setup.lab.cameras.items() if not camera.robot), None)
        hint = f"over the bench is `{over}`: `pico get {over}.frame` peeks at what it sees" if over else ""
        raise wrong(f"`{name}` is the camera on {robot}, through which only runs look", hint)


def _move(setup: Setup, seen: Observation, name: str, given: dict[str, str]) -> PrimitiveRequest:
    slot = given.pop("slot", None)
    if slot == "home" and slot not in setup.lab.slots:
        return _stow(setup, seen, name, given)
    if slot is not None:
        _only(name, "move", given, ())
        if slot not in setup.lab.slots:
            raise wrong(f"there is no slot `{slot}`", slot_meant(slot, setup.lab.slots), name)
        return PrimitiveRequest(component=name, primitive="move", slot=slot)
    _refuse_names(setup, name, given)
    _only(name, "move", given, primitive("move").arguments)
    if not given:
        raise wrong(f"where to move {name}?", f"`pico move {name} x=500 y=420 yaw=30`, or `slot=NAME`", name)
    if "after" in given or "distance" in given:
        return _after(setup, seen, name, given)
    part = seen.components.get(name)
    if part is None or part.pose is None:
        raise wrong(f"nobody sees {name}, so it can't be moved", "put it where it is seen", name)
    turn = read_quantity(f"turn of {name}", given["turn"], "deg") if "turn" in given else 0.0
    x, y, yaw = (_axis(name, part.pose, axis, given.get(axis)) for axis in ("x", "y", "yaw"))
    return PrimitiveRequest(component=name, primitive="move", pose=Pose(x, y, wrap(stepped(yaw, turn))))


def _axis(name: str, pose: Pose, axis: str, text: str | None) -> float:
    """Return a coordinate of a pose as a person writes it: a place, a step from where it is (`+=5`), None for that."""
    here = float(getattr(pose, axis))
    if text is None:
        return here
    step = STEP.fullmatch(text)
    value = read_quantity(f"{axis} of {name}", step[2] if step else text, "deg" if axis == "yaw" else "mm")
    return stepped(here, value if step[1] == "+" else -value) if step else value


def _refuse_names(setup: Setup, name: str, given: Mapping[str, str]) -> None:
    """Raise PicoError for a step under another name, and for a slot that is named by its last word."""
    if "dyaw" in given:
        raise wrong(f"move of {name} takes no `dyaw`", f"`pico move {name} turn={given['dyaw']}`", name)
    for axis in ("x", "y"):
        if (step := given.get(f"d{axis}")) is not None:
            raise wrong(f"move of {name} takes no `d{axis}`", f"`pico move {name} {_step(axis, step)}`", name)
    if given.get("x") in {slot.rpartition("/")[2] for slot in setup.lab.slots}:
        raise wrong(f"there is no slot `{given['x']}`", slot_meant(given["x"], setup.lab.slots), name)


def _step(axis: str, step: str) -> str:
    """Return how a step along an axis is written."""
    return f"{axis}-={step[1:]}" if step.startswith("-") else f"{axis}+={step.removeprefix('+')}"


def _after(setup: Setup, seen: Observation, name: str, given: dict[str, str]) -> PrimitiveRequest:
    _only(name, "move after another", given, ("after", "distance"))
    if len(given) < 2:
        raise wrong(f"where to move {name}?", f"`pico move {name} after=OTHER distance=MM` takes both", name)
    require_seen(setup, seen, name, given["after"])
    distance = read_quantity(f"distance of {name}", given["distance"], "mm")
    pose = place_after(setup, seen, name, given["after"], distance)
    return PrimitiveRequest(component=name, primitive="move", pose=pose)


def _stow(setup: Setup, seen: Observation, name: str, given: dict[str, str]) -> PrimitiveRequest:
    _only(name, "stow", given, ())
    home = setup.lab.inventory[name].home
    if home is None:
        raise wrong(f"{name} has no home slot: the lab fixes its pose", "", name)
    return PrimitiveRequest(component=name, primitive="stow", slot=home)


def _set(setup: Setup, seen: Observation, name: str, given: dict[str, str]) -> PrimitiveRequest:
    tunables = setup.type_of(name).tunables
    for word in given.keys() - tunables.keys():
        raise wrong(f"set of {name} takes no `{word}`", _set_instead(setup, name, word), name)
    if not given:
        text = f"which tunable of {name}?"
        raise wrong(text, f"`pico set {name} {next(iter(tunables), 'TUNABLE')}=VALUE`", name)
    live = seen.components[name].values if name in seen.components else {}
    known = {k: v.value for k, v in live.items() if v.status != "unknown"}
    values = {k: read_value(name, k, tunables[k], text, known.get(k)) for k, text in given.items()}
    return PrimitiveRequest(component=name, primitive="set", values=values)


def value_at(setup: Setup, address: str, text: str) -> Value:
    """Return the value of a tunable by its address (`p1.angle`), from how a person writes it; raises PicoError."""
    component, _, tunable = address.partition(".")
    return read_value(component, tunable, setup.type_of(component).tunables[tunable], text)


def _set_instead(setup: Setup, name: str, word: str) -> str:
    """Return what to type for a word that names no tunable: of a value alone the tunable that may be meant with it."""
    tunables = setup.type_of(name).tunables
    fitting = [k for k, kind in tunables.items() if kind.mover != "none" and _fits(name, k, kind, word)]
    if fitting:
        return " or ".join(f"`pico set {name} {k}={word}`" for k in fitting)
    return did_you_mean(word, tunables)


def _fits(component: str, name: str, kind: Tunable, text: str) -> bool:
    """Return whether a text is a value of a tunable."""
    try:
        read_value(component, name, kind, text, 0.0)
    except PicoError:
        return False
    return True


def _home(setup: Setup, seen: Observation, name: str, given: dict[str, str]) -> PrimitiveRequest:
    _only(name, "home", given, primitive("home").arguments)
    axes = [k for k, t in setup.type_of(name).tunables.items() if t.axis and t.axis.kind != "open_loop"]
    tunable = given.get("tunable") or (axes[0] if len(axes) == 1 else "")
    if tunable not in axes:
        known = f"{name} has " + (f"the axes {', '.join(axes)}" if axes else "no axis that homes")
        raise wrong(f"which axis of {name}?" if not tunable else f"`{tunable}` of {name} does not home", known, name)
    return PrimitiveRequest(component=name, primitive="home", tunable=tunable)


def _auto_range(setup: Setup, seen: Observation, name: str, given: dict[str, str]) -> PrimitiveRequest:
    tunable = given.get("tunable", "exposure")
    if tunable not in setup.type_of(name).tunables:
        raise wrong(f"{name} has no tunable `{tunable}`", "auto_range sets the exposure of a camera", name)
    return PrimitiveRequest(component=name, primitive="auto_range", arguments={"tunable": tunable})


def _measure(setup: Setup, name: str, given: Mapping[str, str]) -> PrimitiveRequest:
    """A camera over the bench can be asked as a component can; one measurable of a type need not be named."""
    if name in setup.lab.cameras:
        _refuse_on_arm(setup, name)
    else:
        require_component(setup, name)
    known = setup.measurables_of(name)
    _only(name, "measure", given, primitive("measure").arguments)
    own = setup.type_of(name).measurables if name in setup.lab.inventory else known
    read = [n for n, m in own.items() if m.kernel is None and n != "dark"]
    measurable = spelt(given.get("measurable") or (read[0] if len(read) == 1 else ""))
    setup.measurable_of(name, measurable)
    return PrimitiveRequest(component=name, primitive="measure", measurable=measurable)


def _plain(name: str, asked: str, given: Mapping[str, str]) -> PrimitiveRequest:
    """Return the request for a primitive of which only its arguments are known, all of which it wants."""
    known = primitive(asked).arguments
    _only(name, asked, given, known)
    if missing := [key for key in known if key not in given]:
        raise wrong(f"{asked} of {name} wants `{missing[0]}`", f"`pico do {name} {asked} {missing[0]}=...`", name)
    units = {key: known[key] for key in given}
    read = {k: v if (u := units[k]) is None else read_quantity(f"{k} of {name}", v, u) for k, v in given.items()}
    return PrimitiveRequest(component=name, primitive=asked, arguments=read)


def _only(name: str, asked: str, given: Mapping[str, str], known: Iterable[str]) -> None:
    names = tuple(known)
    for key in given:
        if key not in names:
            hint = did_you_mean(key, names) or (f"known: {', '.join(names)}" if names else "it takes no arguments")
            raise wrong(f"{asked} of {name} takes no `{key}`", hint, name)


def place_after(setup: Setup, where: Observation | LabState, name: str, other: str, distance_mm: float) -> Pose:
    """Return the pose at which the optical center of `name` lies `distance_mm` behind that of `other`, along the beam
    axis of `other` (its local +x), facing the same way.

    Raises KeyError for a component that the lab does not have, or that is not seen.
    """
    pose = _pose(setup, where, other)
    x, y, _ = setup.type_of(other).frames.optical
    center = pose.apply(x + distance_mm, y)
    own_x, own_y, _ = setup.type_of(name).frames.optical
    c, s = math.cos(math.radians(pose.yaw)), math.sin(math.radians(pose.yaw))
    return Pose(center[0] - (c * own_x - s * own_y), center[1] - (s * own_x + c * own_y), pose.yaw)


def _pose(setup: Setup, where: Observation | LabState, name: str) -> Pose:
    if isinstance(where, LabState):
        return place_of(setup, where, name)[1]
    pose = where.components[name].pose
    if pose is None:
        raise KeyError(name)
    return pose


def require_seen(setup: Setup, seen: Observation, *names: str) -> None:
    """Raise PicoError where the inventory lacks one of the components or nobody sees it."""
    for name in names:
        require_component(setup, name)
        part = seen.components.get(name)
        if part is None or part.pose is None or part.presence != "seen":
            raise wrong(f"nobody sees {name}", "put it where it is seen", name)


def read_peeked(measurement: Measurement) -> dict[str, Any]:
    """Return what was peeked at as `read_values` does a tunable, with all that is known of it under `measurement`."""
    found = as_json(measurement)
    return {"value": found.get("value"), "unit": measurement.unit, "status": "peeked", "measurement": found}


def read_values(
    setup: Setup, seen: Observation, component: str, tunable: str | None = None
) -> dict[str, dict[str, Any]]:
    """Return the pose and the tunables of a component as observed, each with `value`, `unit` and `status`.

    Raises PicoError for a component or tunable that there is not.
    """
    require_component(setup, component)
    kinds = setup.type_of(component).tunables
    if tunable is not None and tunable != "pose" and tunable not in kinds:
        raise wrong(f"{component} has no tunable `{tunable}`", did_you_mean(tunable, ["pose", *kinds]), component)
    part = seen.components.get(component)
    presence = part.presence if part else "missing"
    pose = as_json(part.pose) if part and part.pose else None
    found: dict[str, dict[str, Any]] = {
        "pose": {"value": pose, "unit": "", "status": "known" if presence == "seen" else presence}
    }
    for name, kind in kinds.items():
        live = part.values.get(name) if part else None
        status = live.status if live else "not modelled"
        found[name] = {"value": live.value if live else None, "unit": kind.unit, "status": status}
    return {name: value for name, value in found.items() if tunable in (None, name)}
