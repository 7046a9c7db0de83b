"""The step `arms`: how an arm is built, from where the calibrated cameras see the board in its hand."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.backends import checks, ways
from pico.backends.attempt import Failed
from pico.backends.hardware.walking import FIRST_SPEED
from pico.bench.calibrating.at_table import AtTable, Stopped
from pico.bench.calibrating.pictured import corners_drawn
from pico.bench.calibrating.progress import Posture, Progress
from pico.bench.calibrating.table import ABOVE
from pico.cameras.postures import postures, seen_by
from pico.diagnostics import PicoError, error
from pico.model.calibration.results import Provenance
from pico.model.commissioning import NEAR
from pico.motion.built.fitting import LEAST, fitted, grip
from pico.motion.built.poses import reached
from pico.motion.deferred import DeferredMotion
from pico.motion.types import Blocked, MovePath
from pico.vision.arm import FoundArm
from pico.vision.calibration import Calibration
from pico.vision.camera import CameraModel
from pico.vision.charuco import find_board
from pico.vision.lens import board_in

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.vision.frame import Frame

    Array = NDArray[np.float64]

PROCEDURE = "arms/1"
POSTURES = 24
"""Postures in which the board is shown."""
TAKES = 3
"""How often the hand takes the board: it sits a little askew each time."""
SPARE = 12
"""Postures that are looked for besides, for those that no free way leads to."""
SETTLED = 1.0
"""How long an arm rests before pictures are taken [s]."""
READS = 10
"""How often joints are read at rest."""
MISFIT = 0.5
"""Corners that are farther off than this [pixels] are of a board that moved while it was looked at."""


def arm_of(at: AtTable, robot: str, known: Calibration) -> tuple[FoundArm, Provenance, str]:
    """Find how an arm is built: how, and in words. It shows the board to the cameras over the table, which are `known`.
    Raises PicoError; Stopped if a person says no."""
    import numpy as np

    over = {name: camera for name, camera in known.cameras.items() if camera.robot is None}
    least, board = min(2, len(over)), grip()
    home, paths = ways_from(at, robot, lambda tool: seen_by(list(over.values()), tool @ board) >= least)
    speed = FIRST_SPEED if robot in at.wait(at.device.untried()) else NEAR
    at.asks.say(
        f"{robot} goes to {len(paths)} postures with the board in its hand and parks between them, its tool at "
        f"{speed:g} mm/s at most. It reckons with what stands on the table, but not with the board."
    )
    question = "Is the table empty where the arm reaches, everyone out of reach, and a hand on the hard-wired stop?"
    if not at.asks.confirm(question, by_person=True):
        raise Stopped
    at.require_dark("an arm that moves")
    at.wait(_show_all(at, robot, home, paths, over, speed))
    shown, nominal = at.progress.postures[robot], at.device.setup.lab.robots[robot]
    at.keep(replace(at.progress, postures={n: one for n, one in at.progress.postures.items() if n != robot}))
    read, takes = np.array([one.read for one in shown if one.board is not None]), _numbered(shown)
    boards = np.array([one.board for one in shown if one.board is not None])
    read, boards = read.reshape(-1, 7), boards.reshape(-1, 4, 4)
    found = fitted(robot, nominal, read, boards, takes)
    out = _held_out(robot, nominal, read, boards, takes)
    found = replace(found, position=round(math.hypot(found.position, _seen_to(known, over)), 3))
    how = at.provenance(
        PROCEDURE, (*at.devices_of(robot), *(d for name in over for d in at.devices_of(name))), residual=found.position,
        held_out=out, unit="mm", uncertainty={"position_mm": found.position, "turn_deg": found.turn},
    )  # fmt: skip
    shift = float(np.linalg.norm(found.offsets.shift))
    said = f"{robot}: mount off by {shift:.2f} mm, tool by {float(np.linalg.norm(found.offsets.tool)):.2f} mm"
    held = "" if out is None else f", {out:.3f} mm in postures held out"
    return found, how, f"{said}; its tool is known to {found.position:.3f} mm, {found.turn:.3f} deg{held}"


def _seen_to(known: Calibration, over: Mapping[str, CameraModel]) -> float:
    """How well cameras know where a board above the table is [mm]: what they all have wrong shows in no residual."""
    hows = (known.provenance.get(f"extrinsics/{name}") for name in over)
    return max((how.uncertainty.get(ABOVE, 0.0) for how in hows if how), default=0.0)


def _numbered(shown: Sequence[Posture]) -> list[int]:
    """How often the hand had taken the board in each posture in which it was seen, without gaps."""
    seen = [one.take for one in shown if one.board is not None]
    return [sorted(set(seen)).index(take) for take in seen]


def ways_from(
    at: AtTable, robot: str, seen_in: Callable[[Array], bool]
) -> tuple[MovePath | None, list[MovePath]]:  # fmt: skip
    """Return the way of the arm to its park pose from where it stands, None if it is there, and free ways there from
    postures in which the board is seen, as `seen_in` says of the pose (4, 4) of the tool. Raises PicoError."""
    import numpy as np

    setup, seen = at.device.setup, at.wait(at.edge.observe())
    try:
        checks.require_empty(seen, robot)
    except Failed as exc:
        raise PicoError(exc.diagnostic) from exc
    joints = postures(setup, robot, POSTURES + SPARE, seen_in, np.random.default_rng(11))
    motion, standing = DeferredMotion(setup), checks.standing(setup, seen)
    others = {name: other.joints for name, other in seen.robots.items() if name != robot}
    now = seen.robots[robot].joints
    home = None if setup.lab.robots[robot].is_parked(now) else motion.park(robot, now, standing, others)
    if isinstance(home, Blocked):
        text = f"{robot} can't park: {home.text}"
        raise PicoError(error("calibration-arm", text, hint="clear the table", address=robot))
    found: list[MovePath] = []
    for posture in joints:
        path = motion.park(robot, tuple(float(q) for q in posture), standing, others)
        if not isinstance(path, Blocked):
            found.append(path)
        if len(found) == POSTURES:
            break
    if len(found) < LEAST:
        text = f"{robot} has free ways to {len(found)} postures in which its board would be seen; {LEAST} is the least"
        raise PicoError(error("calibration-arm", text, hint="clear the table", address=robot))
    return home, found


async def _show_all(
    at: AtTable, robot: str, home: MovePath | None, paths: Sequence[MovePath], cameras: Mapping[str, CameraModel],
    speed: float,
) -> None:  # fmt: skip
    """Have the arm go through the postures that are left, and keep what is seen in each."""
    lease = await at.edge.acquire("pico calibrate")
    try:
        bench: Any = await at.device.links.instruments()
        fingers, stroke = bench.grippers[robot], at.device.setup.lab.robots[robot].gripper.stroke
        if home is not None:
            await at.device.walk(home, speed)
        take, held = max((one.take for one in at.progress.postures.get(robot, ())), default=-1), False
        for number in range(len(at.progress.postures.get(robot, ())), len(paths)):
            if not held or number % -(-len(paths) // TAKES) == 0:
                take, held = take + 1, True
                await fingers.move_to(stroke)
                text = f"Hold the block behind the board between the fingers of {robot}"
                if not await asyncio.to_thread(at.hands.give, robot, at.board, text):
                    raise Stopped
                await fingers.move_to(0.0)
            one = await _showing(at, robot, paths[number], cameras, speed, take)
            at.keep(_with_posture(at.progress, robot, one))
            said = "seen" if one.board is not None else "not seen well enough"
            at.asks.say(f"  {number + 1}/{len(paths)}: {said}")
        await fingers.move_to(stroke)
    except Failed as exc:
        raise PicoError(exc.diagnostic) from exc
    finally:
        await asyncio.to_thread(at.hands.away)
        await at.edge.release(lease)


def _with_posture(progress: Progress, robot: str, one: Posture) -> Progress:
    return replace(progress, postures={**progress.postures, robot: (*progress.postures.get(robot, ()), one)})


async def _showing(
    at: AtTable, robot: str, path: MovePath, cameras: Mapping[str, CameraModel], speed: float, take: int
) -> Posture:
    """Bring the arm to where a path begins, look, and go back along it."""
    read, frames = await resting(at, robot, path, tuple(cameras), speed)
    board = await asyncio.to_thread(_board, at, robot, frames, cameras)  # the loop hears of the arm meanwhile
    await at.device.walk(path, speed)
    return Posture(take, read, board)


async def resting(
    at: AtTable, robot: str, path: MovePath, cameras: Sequence[str], speed: float
) -> tuple[Array, dict[str, Frame]]:
    """Bring an arm from its park pose to where a path begins, and return what its encoders read there (7,) [rad] and
    what `cameras` see. Raises Failed and PicoError."""
    import numpy as np

    at.require_dark("an arm that moves")
    park = at.device.setup.lab.robots[robot].park_joints
    await at.device.walk(ways.backwards(path, park), speed)
    await at.device.links.pause(SETTLED)
    arm = (await at.device.links.instruments()).arms[robot]
    read = np.mean([(await arm.state()).joints for _ in range(READS)], axis=0)
    return read, {name: await at.device.picture(name) for name in cameras}


def _board(at: AtTable, robot: str, frames: Mapping[str, Frame], cameras: Mapping[str, CameraModel]) -> Array | None:
    """Where the board is (4, 4) that these pictures show; None if it is not seen well enough."""
    found = {name: view for name, frame in frames.items() if (view := find_board(frame, at.board)) is not None}
    for name, view in found.items():
        corners_drawn(frames[name].gray, [view.pixels], at.pictures / f"arms-{robot}-{name}.png")
    if len(found) < min(2, len(cameras)):
        return None
    board, left = board_in(list(found.values()), [cameras[name] for name in found])
    return board if left < MISFIT else None


def _held_out(robot: str, known: Any, read: Array, boards: Array, takes: Sequence[int]) -> float | None:
    """How far the board is from where the arm has it in the last take, by a fit to the others, root mean square [mm];
    how it sits in the hand then is its mean there. None if too few postures are left."""
    import numpy as np

    last = np.array(takes) == max(takes)
    if max(takes) == 0 or np.count_nonzero(~last) < LEAST or np.count_nonzero(last) < 3:
        return None
    found = fitted(robot, known, read[~last], boards[~last], [take for take in takes if take != max(takes)])
    in_tool = np.linalg.inv(reached(known, read[last], found.offsets).tools) @ boards[last]
    away = in_tool[:, :3, 3] - in_tool[:, :3, 3].mean(axis=0)
    return float(np.sqrt(np.mean(np.sum(away**2, axis=1))))
