"""What lets a lab on the network be tried in less time: leases that last less long, with all that goes with them, and
processes that are forked from one that has loaded already what they need."""

from __future__ import annotations

import importlib

SHORTER = 2.5
"""So many times shorter is what is waited."""
LOADED = (
    "mujoco", "cv2", "scipy.optimize", "pico.edge.link.server", "pico.edge.local", "pico.edge.network.uplink",
    "pico.edge.network.line", "pico.edge.network.lapsing", "pico.backends.emulated.bench", "pico.backends.sight",
    "pico.backends.look_again", "pico.backends.occlusion", "pico.backends.hardware.opening", "pico.planning",
    "pico.drivers.xarm.arm", "pico.drivers.xarm.gripper", "pico.drivers.elliptec", "pico.drivers.frames",
    "pico.drivers.switches", "pico.edge.aligning", "pico.edge.surveying", "pico.edge.teleoperating",
    "pico.edge.emission", "pico.execution.conditions", "pico.execution.walk", "pico.server.app", "pico.server.running",
    "pico.history.examples.example", "pico_cli.commands.apply", "pico_cli.commands.plan", "xarm.wrapper",
)  # fmt: skip


def hasten() -> None:
    """Let leases last 4 s, and edges and sockets be asked, and given up, as much sooner; called before anything of the
    coordinator is loaded."""
    from pico.control import leases
    from pico.edge.network import messages

    leases.TTL /= SHORTER
    leases.HEARTBEAT /= SHORTER
    messages.POLL /= SHORTER
    messages.PING /= SHORTER
    messages.SILENT /= SHORTER
    from pico.server import running
    from pico.server.relay import dispatch

    running.PING /= SHORTER
    dispatch.AWAY /= SHORTER
    dispatch.LASTING_AWAY /= SHORTER


def preload() -> None:
    """Load what the processes need, once, before they are forked."""
    for name in LOADED:
        importlib.import_module(name)
