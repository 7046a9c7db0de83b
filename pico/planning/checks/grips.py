"""Types that no gripper of the lab can hold, and places that no arm reaches: told of the files, before any plan. mm."""

from __future__ import annotations

from collections.abc import Iterator

from pico.diagnostics import Diagnostic, SourceRange, error, warning
from pico.geometry import Shape, disc, finger_height, finger_zones, placed, polygon, separation
from pico.manifest.load import Manifests
from pico.manifest.text.places import find, where
from pico.model.body import Body
from pico.model.catalog import ComponentType, Geometry, Grasp
from pico.model.pose import Pose
from pico.model.robot import Gripper
from pico.motion.reach import out_of_reach

_TOUCHING = 0.5
"""How far a body may reach into the fingers' place: they press on it."""


def check_grips(read: Manifests) -> Iterator[Diagnostic]:
    """Yield an error for each type that an arm is to move and no gripper can hold at any yaw of its grasp."""
    setup, _ = read.require()
    grippers = [robot.gripper for _, robot in sorted(setup.lab.robots.items())]
    for name in sorted({setup.lab.inventory[part].type for part in setup.lab.inventory if setup.movable(part)}):
        kind = setup.catalog[name]
        reasons = [reason for gripper in grippers if (reason := refused(kind.geometry, gripper))]
        if grippers and len(reasons) == len(grippers):
            hint = "`bodies` say what it looks like where the jaws close; or another `grasp.height`, `width` or `yaws`"
            yield error("grip", f"{name} can't be gripped: {reasons[0]}", hint=hint, source=_place(read, kind))


def refused(geometry: Geometry, gripper: Gripper) -> str:
    """Return which body of a part stands where the fingers have to be at every yaw at which the jaws may close; empty
    where there is a yaw at which none does."""
    grasp = geometry.grasp
    if grasp is None or gripper.fingers == "none":
        return ""
    return min((_inside(geometry, grasp, gripper, yaw) for yaw in grasp.yaws), key=len, default="")


def _inside(geometry: Geometry, grasp: Grasp, gripper: Gripper, yaw: float) -> str:
    """Return which body stands where a finger has to be, and how far; empty for none."""
    lowest, zones = finger_height(grasp, gripper), finger_zones(grasp, gripper, yaw, Pose(0.0, 0.0))
    shapes = [(body.name, _outline(body)) for body in geometry.bodies if _top(body) > lowest]
    if not geometry.bodies and geometry.height > lowest:
        shapes = [("its footprint, which is as high as all of it,", placed(geometry.footprint, Pose(0.0, 0.0)))]
    deepest = max(((-separation(shape, zone), name) for name, shape in shapes for zone in zones), default=(0.0, ""))
    if deepest[0] <= _TOUCHING:
        return ""
    return f"{deepest[1]} stands {deepest[0]:.3g} mm inside the place of a finger that closes to {grasp.width:g} mm"


def _outline(body: Body) -> Shape:
    """Return what a body covers, seen from above."""
    x, y, _ = body.at
    if body.shape == "cylinder" and body.axis == "z":
        return disc(x, y, body.size[0] / 2)
    along, across = (body.size[1], body.size[0]) if body.shape == "cylinder" else (body.size[0], body.size[1])
    width, depth = (across, along) if body.shape == "cylinder" and body.axis == "y" else (along, across)
    pose = Pose(x, y, body.yaw)
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return polygon(tuple(pose.apply(sx * width / 2, sy * depth / 2) for sx, sy in corners))


def _top(body: Body) -> float:
    tall = body.size[2] if body.shape == "box" else body.size[1] if body.axis == "z" else body.size[0]
    return body.at[2] + tall / 2


def _place(read: Manifests, kind: ComponentType) -> SourceRange | None:
    """Return where the grasp of a type stands; where the lab uses it, for one that comes with PICO."""
    for document in read.documents.get("ComponentType", ()):
        name = find(document, "metadata", "name")
        if name and getattr(name[1], "text", "") == kind.name:
            return where(document, "geometry", "grasp")
    setup, _ = read.require()
    return read.source(f"inventory.{next(n for n, p in sorted(setup.lab.inventory.items()) if p.type == kind.name)}")


def check_reach(read: Manifests) -> Iterator[Diagnostic]:
    """Yield a warning for each slot, and each place at which an arm should put a part, that no arm reaches."""
    setup, state = read.require()
    arms = [robot for _, robot in sorted(setup.lab.robots.items()) if robot.model == "xarm7"]
    if not arms or len(arms) < len(setup.lab.robots):
        return
    for name, slot in sorted(setup.lab.slots.items()):
        if far := out_of_reach(arms, slot.x, slot.y):
            hint = "nothing can be put there by an arm; `pico render --view top` draws the reach"
            yield warning("slot-reach", f"no arm reaches {name}: {far}", hint=hint, source=read.source(f"slots.{name}"))
    for name, part in sorted(state.components.items()):
        if part.pose is None or name not in setup.lab.inventory or not setup.movable(name):
            continue
        if far := out_of_reach(arms, part.pose.x, part.pose.y, setup.type_of(name).geometry):
            hint = "an arm can't bring it there; `pico render --view top` draws the reach"
            text = f"no arm reaches {name} at {part.pose}: {far}"
            yield warning("reach", text, hint=hint, source=read.source(f"{name}.pose.x"), address=name)
