"""The pose of a part, as the cameras over the bench see it now; nothing is remembered."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup

KERNEL, VERSION = "markers", "1"
SEEN = ("stereo", "known height")
"""How a pose is known that was measured and not merely known."""


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the pose of a part with a marker, on a bench that a camera watches."""
    part = setup.lab.inventory.get(component)
    marked = part is not None and part.marker is not None and setup.type_of(component).geometry.marker is not None
    return marked and measurable == "pose" and any(c.robot is None for c in setup.lab.cameras.values())


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return x, y [mm] and yaw [deg]."""
    from pico.backends.sight import BLIND
    from pico.backends.sim.sight import see

    found = see(table.setup, table.place, table.world, "sim", "", {})
    problems = found.observation.problems
    if blind := [p for p in problems if p.code in BLIND]:
        raise Failed(blind[0])
    part = found.observation.components[component]
    if part.pose is None or part.how not in SEEN:
        said = next((p for p in problems if p.address == component), None)
        text = f"the cameras do not see {component}"
        raise Failed(said or error("unseen", text, hint="`pico look` shows what they see", address=component))
    pose, sigma = part.pose, part.uncertainty
    return Reading(
        {"x": pose.x, "y": pose.y, "yaw": pose.yaw},
        sigma={"x": sigma.position, "y": sigma.position, "yaw": sigma.yaw},
        settings={"seen by": part.how},
        kernel=KERNEL,
        kernel_version=VERSION,
    )
