"""From pictures to an observation: where the cameras see the components, and what they can't tell. For every backend.

Nothing is guessed: a component has a pose where its marker was read, where the lab bolts it down, where a gripper holds
it, or where it was last and something that is known hides the place. Anything else that was seen is an obstacle.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from pico.backends.last_seen import LastSeen
from pico.backends.occlusion import Occluders
from pico.backends.unidentified import swapped, with_unidentified
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.model.catalog import Footprint
from pico.model.observation import NO_VIEW, UNLOOKED, Observation, ObservedComponent, ObservedRobot, UnknownObject
from pico.model.observation import Uncertainty as Sigma
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.vision.anchor import SHARED, Drifting, anchored
from pico.vision.calibration import Calibration
from pico.vision.datums import ENOUGH, check, farthest_datum, offset
from pico.vision.localize import recognize, replace_dark
from pico.vision.nominal import camera_models
from pico.vision.rigid import apart
from pico.vision.sighting import CameraMoved, Finding, Sighting

if TYPE_CHECKING:
    from pico.vision.camera import CameraModel
    from pico.vision.frame import Frame
    from pico.vision.markers import Markers

BLIND = frozenset({"calibration-drift", "marker-dark", "no-camera"})
"""What makes every position worthless: nothing is captured, planned or moved."""
_FAR = 5.0  # standard deviations that a camera may be off where the lab says it is, before it counts as moved
_ROOM = 5.0  # mm that an object may reach beyond its marker
_OF_A_LOOK = ("marker-hidden", "marker-none")
_NAMED = 4
_LARGE = 45.0  # mm, radius of an object of which nothing is known, where the lab's own parts are smaller


@dataclass(frozen=True, eq=False)
class Look:
    """One look at the bench: the observation, what the cameras made of it, their pictures, and the cameras as put
    right."""

    observation: Observation
    sighting: Sighting
    frames: tuple[Frame, ...]
    calibration: Calibration


def look(
    setup: Setup,
    frames: Sequence[Frame],
    calibration: Calibration | None,
    known: Observation,
    last: Mapping[str, LastSeen],
) -> Look:
    """Return what `frames`, one a camera that stands over the table, show of a bench.

    `calibration`: None where the cameras were never calibrated; then they are where the lab says, about. `known`: what
    is known without them, clocks, robots and the values of tunables; no pose is taken from it. `last`: where parts were
    seen or put down before.
    """
    held = {robot.holding for robot in known.robots.values() if robot.holding}
    calibration = _of_all(frames, calibration)
    sighting, cameras = seen_by(setup, frames, calibration, held)
    seen = _observation(setup, sighting, cameras, known, last, calibration is not None)
    if not any(problem.code in BLIND for problem in seen.problems):
        seen = with_unidentified(setup, seen, frames, cameras.cameras)
    return Look(seen, sighting, tuple(frames), cameras)


def _of_all(frames: Sequence[Frame], calibration: Calibration | None) -> Calibration | None:
    """Return the calibration if it knows every camera that took a picture; one of axes or arms alone, or of some of the
    cameras, says nothing of the others."""
    known = calibration.cameras.keys() if calibration is not None else ()
    return calibration if all(frame.camera in known for frame in frames) else None


def require_trusted(seen: Observation) -> Observation:
    """Return the observation; raises PicoError where the cameras were dark or have moved, so that nothing counts."""
    found = [problem for problem in seen.problems if problem.code in BLIND]
    if found:
        raise PicoError(found, ExitCode.ERROR)
    return seen


def seen_by(
    setup: Setup, frames: Sequence[Frame], calibration: Calibration | None, held: set[str]
) -> tuple[Sighting, Calibration]:
    """Return what the cameras saw, and the cameras put right by the datums in their own pictures.

    Cameras that have moved since they were calibrated are not put right: they are reported, see `Sighting.drift`.
    """
    from pico.vision.markers import detect

    dark = tuple(frame.camera for frame in frames if frame.black)
    pictures = [detect(frame) for frame in frames if not frame.black]
    calibration = _of_all(frames, calibration)
    basis = calibration or Calibration(camera_models(setup))
    right = {p.camera: anchored(setup, basis.cameras[p.camera], p) for p in pictures}
    cameras = replace(basis, cameras={**basis.cameras, **right})
    off: dict[str, float] = {}
    if calibration is None:
        drift = _displaced(setup, pictures, basis)
    else:
        off = {p.camera: farthest for p in pictures if (farthest := farthest_datum(setup, p, basis.cameras[p.camera]))}
        drift, loose = _drifted(setup, pictures, basis)
        cameras = basis if drift or loose else cameras
    sighting = replace(recognize(setup, pictures, cameras, held), drift=drift, datums=off)
    return replace_dark(sighting, dark), cameras


def _drifted(setup: Setup, pictures: Sequence[Markers], basis: Calibration) -> tuple[tuple[CameraMoved, ...], bool]:
    """The cameras that have moved since they were calibrated, and whether a datum came loose."""
    checked = [check(setup, p, basis.cameras[p.camera], basis.accuracy) for p in pictures]
    return tuple(d for d, _ in checked if d), any(f.kind == "datum" for _, found in checked for f in found)


def _displaced(setup: Setup, pictures: Sequence[Markers], basis: Calibration) -> tuple[CameraMoved, ...]:
    """The cameras that are farther from where the lab has them than a mount is ever off."""
    usual, found = Drifting(), []
    for picture in pictures:
        by_number = {datum.marker: datum for datum in setup.lab.datums.values()}
        seen = [(by_number[m.number], m) for m in picture.markers if m.number in by_number]
        if len(seen) < ENOUGH:
            continue
        was: CameraModel = basis.cameras[picture.camera]
        shift, turn = apart(was.pose, anchored(setup, was, picture, usual, SHARED).pose)
        if shift > _FAR * usual.position or turn > _FAR * usual.turn:
            effect = max(offset(datum, was, marker) for datum, marker in seen)
            found.append(CameraMoved(camera=picture.camera, shift=shift, turn=turn, effect=effect))
    return tuple(found)


def _observation(
    setup: Setup,
    sighting: Sighting,
    cameras: Calibration,
    known: Observation,
    last: Mapping[str, LastSeen],
    calibrated: bool,
) -> Observation:
    places = {name: seen.pose for name, seen in sighting.components.items()}
    occluders = Occluders(setup, places, {n: r.joints for n, r in known.robots.items()}, cameras.cameras, sighting.dark)
    components: dict[str, ObservedComponent] = {}
    problems = [*known.problems, *(d.diagnostic() for d in sighting.drift)]
    problems += [_finding(f) for f in sighting.findings if f.kind not in ("hidden", "datums")]
    problems += [_unwatched(f, calibrated) for f in sighting.of("datums")]
    for name in setup.lab.inventory:
        part, problem = _component(setup, name, sighting, known, last.get(name), occluders)
        values = known.components[name].values if name in known.components else {}
        components[name] = replace(part, values=values)
        problems += [problem] if problem else []
    problems += swapped(components, last)
    unknown = _strangers(setup, sighting, components)
    return replace(known, components=components, unknown=unknown, problems=tuple(problems))


def _finding(finding: Finding) -> Diagnostic:
    """A part that leans is an obstacle and no reason to refuse everything else."""
    said = finding.diagnostic()
    return replace(said, severity="warning") if finding.kind == "tilted" else said


def _unwatched(finding: Finding, calibrated: bool) -> Diagnostic:
    said = finding.diagnostic()
    return said if calibrated else replace(said, severity="note")


def _component(
    setup: Setup, name: str, sighting: Sighting, known: Observation, last: LastSeen | None, occluders: Occluders
) -> tuple[ObservedComponent, Diagnostic | None]:
    part, plate = setup.lab.inventory[name], setup.type_of(name).geometry.marker
    holder = next((key for key, robot in known.robots.items() if robot.holding == name), None)
    if holder is not None:
        told = known.components.get(name)
        return (told if told and told.how == "gripper" else _held(setup, holder, known.robots[holder])), None
    if name in sighting.components:
        seen = sighting.components[name]
        return ObservedComponent(pose=seen.pose, uncertainty=seen.uncertainty, how=seen.how), None
    if part.marker is None or plate is None:
        if part.pose is not None:
            return ObservedComponent(pose=part.pose, how="fixed"), None
        hint = "give it a `marker`, and stick that on: `pico calibrate markers` prints it"
        text = f"{name} carries no marker, so no camera can find it"
        return ObservedComponent(presence="missing"), warning("marker-none", text, hint=hint, address=name)
    wrong = next((f for f in sighting.findings if f.component == name and f.kind != "hidden"), None)
    if wrong is not None:
        lies = wrong.kind == "tilted" and wrong.at
        pose = Pose(*wrong.at[0]) if lies else None
        sigma = Sigma(position=setup.type_of(name).geometry.height, yaw=180.0)
        lying = ObservedComponent(presence="toppled", pose=pose, uncertainty=sigma)
        return (lying if lies else ObservedComponent(presence="missing")), None
    return _hidden(setup, name, known.time, last, occluders)


def _hidden(
    setup: Setup, name: str, now: float, last: LastSeen | None, occluders: Occluders
) -> tuple[ObservedComponent, Diagnostic | None]:
    """A part whose marker nobody sees: still where it was, if something hides that place; else it is gone."""
    fixed, marker = setup.lab.inventory[name].pose, setup.lab.inventory[name].marker
    pose = last.pose if last else fixed
    unseen = f"{name}: no camera sees its marker {marker}"
    if pose is None:
        hint = "put it where a camera sees it, or look behind what hides the view"
        return ObservedComponent(presence="missing"), warning("marker-hidden", unseen, hint=hint, address=name)
    age = max(0.0, now - last.time) if last else 0.0
    when = f"it was last at {pose}, {duration(age)} ago" if last else f"the lab has it fixed at {pose}"
    behind = occluders.hides(name, pose)
    if behind is None:
        hint = "put it back where a camera sees it"
        text = f"{unseen}, and its place is in plain view: {when}"
        return ObservedComponent(presence="missing"), warning("marker-hidden", text, hint=hint, address=name)
    sigma = last.uncertainty if last else Sigma()
    text = f"{unseen}: {when}, where {behind} hides it; taken to be there still"
    kept = ObservedComponent(pose=pose, uncertainty=sigma, age=age, how=last.kept if last else "fixed")
    return kept, warning("marker-hidden", text, hint=f"move {behind} away and look again", address=name)


def _held(setup: Setup, name: str, robot: ObservedRobot) -> ObservedComponent:
    from pico.motion.kinematics import tool_of

    return ObservedComponent(presence="held", pose=tool_of(setup.lab.robots[name], robot.joints), how="gripper")


def _strangers(
    setup: Setup, sighting: Sighting, components: Mapping[str, ObservedComponent]
) -> dict[str, UnknownObject]:
    """What takes room and is nothing that could be moved: unknown markers, and parts that can't be told for sure."""
    movable = [setup.type_of(name).geometry for name in setup.lab.inventory if setup.movable(name)]
    radius = max([_LARGE, *(geometry.footprint.radius for geometry in movable)])
    tall = max([100.0, *(geometry.height for geometry in movable)])
    found = {}
    for name, seen in sighting.unknown.items():
        size = radius + min(2 * radius, 3 * seen.uncertainty.position)
        footprint = Footprint(disc=math.ceil(size))
        found[name] = UnknownObject(pose=seen.pose, footprint=footprint, height=max(50.0, seen.height + _ROOM))
    missing = any(part.presence == "missing" for part in components.values())
    for finding in sighting.findings:
        doubt = finding.kind in ("duplicate", "conflict", "height") or (finding.kind == "half-seen" and missing)
        for number, (x, y) in enumerate(finding.at if doubt else (), 1):
            base = f"unknown/{finding.marker if finding.marker is not None else 'unread'}"
            name = base if number == 1 and base not in found else f"{base}_{len(found) + 1}"
            found[name] = UnknownObject(pose=Pose(x, y), footprint=Footprint(disc=math.ceil(radius)), height=tall)
    return found


def unlooked(seen: Observation) -> Observation:
    """Return what is known of a bench when no camera over its table can be used: where parts stand that only a camera
    finds is unknown, which is told once; nothing says that they are gone."""
    names = [name for name, part in seen.components.items() if part.presence == "missing"]
    if not names:
        return seen
    blind = {name: replace(seen.components[name], how=UNLOOKED) for name in names}
    rest = tuple(p for p in seen.problems if not (p.code in _OF_A_LOOK and p.address in names))
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    text = f"no camera over the table can be used; of unknown place: {', '.join(names[:_NAMED])}{more}"
    told = warning(NO_VIEW, text, hint="`pico devices check` says what is wrong with the cameras")
    return replace(seen, components={**seen.components, **blind}, problems=(told, *rest))


def no_cameras(setup: Setup) -> PicoError:
    """Return why a lab without cameras over its table can't be looked at."""
    text = f"{setup.lab.name} has no camera over its table, so nothing can be seen"
    hint = "describe two under `cameras`, or set `sim: {observe: exact}`"
    return PicoError(error("no-camera", text, hint=hint))


def duration(seconds: float) -> str:
    """Return a time as a person says it: `3 s`, `4 min`, `2 h`."""
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.0f} h"
