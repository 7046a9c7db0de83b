"""What a real bench tells besides pictures: joints, the distance between the pads, set-points, safety inputs."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from pico.backends.hardware.clearing import fault_warnings
from pico.backends.hardware.instruments import Instruments
from pico.backends.last_seen import Taken
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.drivers.driven import UNKNOWN, Emitting, Shut
from pico.drivers.protocols import Grip, SafetyState
from pico.model.catalog import Grasp
from pico.model.instruments.kind import Driven
from pico.model.observation import LACKING, LOST, Observation, ObservedComponent, ObservedRobot, ObservedValue
from pico.model.setup import Setup
from pico.motion.kinematics import tool_of
from pico.motion.types import Joints
from pico.twin.arms import TwinArm

T = TypeVar("T")
LIGHT_ANSWERS = 1.0
"""How long is waited for what a laser or a shutter reads [s]; the guard counts it as silent before that."""
AT_TABLE = ("door", "curtain")
"""Safety inputs that say whether somebody is at the table."""


@dataclass(frozen=True)
class Told:
    """What the instruments of a bench told at one moment: joints of the motors of arms [rad], grips of hands, values by
    address, safety inputs; what could not be asked, with why."""

    joints: Mapping[str, Joints]
    grips: Mapping[str, Grip]
    values: Mapping[str, ObservedValue]
    inputs: Mapping[str, SafetyState]
    problems: tuple[Diagnostic, ...]


async def told(bench: Instruments) -> Told:
    """Ask all instruments at once; raises PicoError where an arm or its gripper can't tell, for nothing is known then
    of what it could hit."""
    problems: list[Diagnostic] = []
    states, grips, values, inputs = await asyncio.gather(
        _every({name: arm.state() for name, arm in bench.arms.items()}),
        _every({name: gripper.grip() for name, gripper in bench.grippers.items()}),
        _every({address: _read(address, one) for address, one in bench.tunables.items()}),
        _every({name: one.read() for name, (_, one) in bench.inputs.items()}),
    )
    if lost := [d for found in (states, grips) for exc in found.values() if isinstance(exc, PicoError)
                for d in exc.diagnostics]:  # fmt: skip
        raise PicoError(lost)
    for name, state in states.items():
        if not isinstance(state, PicoError) and state.lost:
            text = f"{name} was lost, for {state.lost}, and was found again"
            problems.append(warning(LOST, text, hint="it is got ready again by the next run", address=name))
    ill = [name for name, state in states.items() if not isinstance(state, PicoError) and state.fault]
    problems += await fault_warnings(bench, ill)
    for address, found in {**values, **inputs}.items():
        if isinstance(found, PicoError) and found.diagnostics[0].code not in LACKING:  # told once a device
            said = found.diagnostics[0]
            problems.append(
                warning("unread", f"nobody can read {address}: {said.summary}", hint=said.hint, address=address)
            )
    return Told(
        joints={name: tuple(found.joints) for name, found in states.items() if not isinstance(found, PicoError)},
        grips={name: found for name, found in grips.items() if not isinstance(found, PicoError)},
        values={name: UNKNOWN if isinstance(found, PicoError) else found for name, found in values.items()},
        inputs={n: SafetyState(safe=None, age=0.0) if isinstance(s, PicoError) else s for n, s in inputs.items()},
        problems=tuple(problems),
    )


async def _read(address: str, one: Driven) -> ObservedValue:
    """Return what a tunable reads. Who asks whether light is out is not kept waiting by a dead link."""
    if not isinstance(one, Emitting | Shut):
        return await one.read()
    try:
        return await asyncio.wait_for(one.read(), LIGHT_ANSWERS)
    except TimeoutError:
        raise PicoError(error("late", f"it did not answer within {LIGHT_ANSWERS:g} s", address=address)) from None


async def _every(asked: Mapping[str, Awaitable[T]]) -> dict[str, T | PicoError]:
    found = await asyncio.gather(*asked.values(), return_exceptions=True)
    for one in found:
        if isinstance(one, BaseException) and not isinstance(one, PicoError):
            raise one
    return dict(zip(asked, found, strict=True))  # type: ignore[arg-type]


def sensed(
    setup: Setup, arms: Mapping[str, TwinArm], found: Told, kinds: Mapping[str, str], taken: Mapping[str, Taken],
    backend: str, time: float, at: str,
) -> Observation:  # fmt: skip
    """Return what is known of the bench without looking: no part has a pose but one in a hand.

    `arms`: as calibration knows them. `kinds`: of the safety inputs. `taken`: what each hand took last; whether it
    still holds it, the distance between its pads says.
    """
    robots = {
        name: _felt(setup, arms, found, name, taken.get(name)) for name in setup.lab.robots if name in found.joints
    }
    components = {name: ObservedComponent(presence="missing", values=_values(setup, found, name))
                  for name in setup.lab.inventory}  # fmt: skip
    for name, robot in robots.items():
        if robot.holding:
            pose = tool_of(setup.lab.robots[name], robot.joints).compose(taken[name].pose)
            held = replace(components[robot.holding], presence="held", pose=pose, how="gripper")
            components[robot.holding] = held
    return Observation(
        backend=backend, time=time, observed_at=at, components=components, robots=robots,
        person=_person(found, kinds), problems=found.problems,
    )  # fmt: skip


def _values(setup: Setup, found: Told, name: str) -> dict[str, ObservedValue]:
    """The tunables as they were read. Those without a device are left out, so that nobody compares or sets them; but
    light that nobody reads may be there."""
    kept = {t for t in setup.type_of(name).tunables if f"{name}.{t}" in found.values or setup.requests(name, t)}
    return {t: found.values.get(f"{name}.{t}", UNKNOWN) for t in sorted(kept)}


def _felt(
    setup: Setup, arms: Mapping[str, TwinArm], found: Told, name: str, taken: Taken | None
) -> ObservedRobot:  # fmt: skip
    import numpy as np

    opening = found.grips[name].width if name in found.grips else None
    known = taken if taken is not None and taken.component in setup.lab.inventory else None
    grasp = setup.type_of(known.component).geometry.grasp if known else None
    holds = known is not None and grasp is not None and name in found.grips and held(found.grips[name], grasp)
    joints = arms[name].taken(np.array(found.joints[name])) if name in arms else found.joints[name]
    return ObservedRobot(joints=joints, holding=known.component if known and holds else None, opening=opening)


def held(grip: Grip, grasp: Grasp) -> bool:
    """Return whether a hand holds a part, by the distance between its pads, or by its sensor if it knows no width."""
    return grasp.fits(grip.width) if grip.width is not None else grip.holds is True


def _person(found: Told, kinds: Mapping[str, str]) -> bool | None:
    """Whether somebody is at the table, as far as curtains and doors tell; None where none does, or one is unknown."""
    told = [state.safe for name, state in found.inputs.items() if kinds.get(name) in AT_TABLE]
    if False in told:
        return True
    return None if not told or None in told else False
