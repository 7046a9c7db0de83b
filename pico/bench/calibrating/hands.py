"""The step `hands`: lens and place of a camera in a hand, which looks at the board on the table from many postures."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.backends.attempt import Failed
from pico.backends.hardware.walking import FIRST_SPEED
from pico.bench.calibrating.arms import resting, ways_from
from pico.bench.calibrating.at_table import AtTable, Stopped
from pico.bench.calibrating.pictured import corners_drawn
from pico.bench.calibrating.table import names_of, of_pose
from pico.cameras.postures import seen_by
from pico.diagnostics import PicoError, error
from pico.model.calibration.results import Provenance
from pico.model.commissioning import NEAR
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.built.poses import reached
from pico.motion.types import MovePath
from pico.vision.arm import FoundArm
from pico.vision.camera import CameraModel
from pico.vision.charuco import BoardView, find_board
from pico.vision.hand_eye import HandEye, hand_eye, scattered
from pico.vision.lens import LENS, board_in
from pico.vision.nominal import camera_models
from pico.vision.rigid import upright

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

PROCEDURE = "hands/1"
AWAY = 330.0
"""How far from the base of its arm the board lies [mm]."""


@dataclass(frozen=True, eq=False)
class Glances:
    """The board as the camera in a hand saw it, and the pose (4, 4) of the tool for each."""

    views: Sequence[BoardView]
    tools: Sequence[Array]


def hand_of(
    at: AtTable, name: str, cameras: Mapping[str, CameraModel], arm: FoundArm
) -> tuple[HandEye, Provenance, str]:
    """Find the camera `name` in a hand: how, and in words. Cameras over the table see where the board lies, the
    calibrated `arm` where the hand is. Raises PicoError; Stopped if a person says no."""
    import numpy as np

    nominal = camera_models(at.device.setup)[name]
    robot, over = nominal.robot or "", {n: camera for n, camera in cameras.items() if camera.robot is None}
    there = board_lies(at.device.setup, robot)
    home, paths = ways_from(at, robot, lambda tool: seen_by([nominal.placed(tool)], there) == 1)
    x, y = there[:2, 3]
    text = f"Lay the board flat on the table, its middle near x = {x:.0f}, y = {y:.0f} mm, its upper edge away from you"
    if not at.hands.lay(there, at.board, text):
        raise Stopped
    try:
        lies = _lies(at, over)
        speed = FIRST_SPEED if robot in at.wait(at.device.untried()) else NEAR
        at.asks.say(f"{robot} looks at the board from {len(paths)} postures, its tool at {speed:g} mm/s at most.")
        question = "Is the table empty except for the board, everyone out of reach, and a hand on the hard-wired stop?"
        if not at.asks.confirm(question, by_person=True):
            raise Stopped
        seen = at.wait(_glances(at, name, robot, home, paths, speed, arm))
    finally:
        at.hands.away()
    found = hand_eye(seen.views, seen.tools, nominal, lies)
    sigmas, out = scattered(seen.views, seen.tools, nominal, lies, found)
    sigmas = np.hypot(sigmas, [*(0.0,) * LENS, *(arm.position,) * 3, *(math.radians(arm.turn),) * 3])
    devices = (*at.devices_of(name), *at.devices_of(robot), *(d for n in over for d in at.devices_of(n)))
    how = at.provenance(
        PROCEDURE, devices, residual=found.residual, held_out=out, unit="px",
        uncertainty=dict(zip(names_of(found.camera), map(float, sigmas[:LENS]), strict=True)) | of_pose(sigmas[LENS:]),
    )  # fmt: skip
    place = ", ".join(f"{v:.2f} ± {s:.2f}" for v, s in zip(found.camera.pose[:3, 3], sigmas[LENS:], strict=False))
    said = f"{name}: at ({place}) mm in the hand of {robot} by {len(seen.views)} pictures"
    return found, how, f"{said}, {found.residual:.2f} px are left, {out:.2f} px of pictures held out"


def board_lies(setup: Setup, robot: str) -> Array:
    """Return the pose (4, 4) of the board where a hand looks at it, from the base of its arm toward the middle of the
    table [mm]."""
    (width, depth), mount = setup.lab.table.size, setup.lab.robots[robot].mount
    away = math.hypot(width / 2 - mount.x, depth / 2 - mount.y) or 1.0
    share = min(1.0, AWAY / away)
    return upright(Pose(mount.x + share * (width / 2 - mount.x), mount.y + share * (depth / 2 - mount.y), 0.0), 0.0)


def _lies(at: AtTable, over: Mapping[str, CameraModel]) -> Array:
    """Where the board lies (4, 4), as cameras over the table see it; raises PicoError if none does."""
    views = {name: find_board(at.wait(at.device.picture(name)), at.board) for name in over}
    seen = [view for view in views.values() if view is not None]
    if not seen:
        text, hint = "no camera over the table sees the board", "lay it where it was asked for, its print up"
        raise PicoError(error("calibration-board", text, hint=hint))
    return board_in(seen, [over[view.camera] for view in seen])[0]


async def _glances(
    at: AtTable, name: str, robot: str, home: MovePath | None, paths: Sequence[MovePath], speed: float, arm: FoundArm
) -> Glances:
    """Have the arm look at the board from each posture."""
    import numpy as np

    lease = await at.edge.acquire("pico calibrate")
    views, read = list[BoardView](), []
    try:
        if home is not None:
            await at.device.walk(home, speed)
        for number, path in enumerate(paths):
            joints, frames = await resting(at, robot, path, (name,), speed)
            view = await asyncio.to_thread(find_board, frames[name], at.board)
            await at.device.walk(path, speed)
            if view is not None:
                views.append(view)
                read.append(joints)
                shown = [one.pixels for one in views]
                corners_drawn(frames[name].gray, shown, at.pictures / f"hands-{name}.png")
            at.asks.say(f"  {number + 1}/{len(paths)}: {'seen' if view is not None else 'not seen'}")
    except Failed as exc:
        raise PicoError(exc.diagnostic) from exc
    finally:
        await at.edge.release(lease)
    known = at.device.setup.lab.robots[robot]
    tools = reached(known, np.array(read).reshape(-1, 7), arm.offsets).tools
    return Glances(views, list(tools))
