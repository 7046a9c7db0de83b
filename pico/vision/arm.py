"""How an arm differs from what the lab says of it: as it is built, or as calibration finds it. mm, deg."""

from __future__ import annotations

from pico.model.record import record


@record
class ArmOffsets:
    """How far an arm is off: its base by `shift` [mm] and by the rotation vector `turn` [deg], along the axes of the
    table; `zeros`: what its joints have turned where their encoders read zero [deg]; `tool`: where its tool center
    point is, seen from where it should be, along the axes of the tool [mm]."""

    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    zeros: tuple[float, ...] = (0.0,) * 7
    tool: tuple[float, float, float] = (0.0, 0.0, 0.0)


NOMINAL = ArmOffsets()
"""An arm just as the lab says."""


@record
class FoundArm:
    """An arm as calibration found it. `position` [mm], `turn` [deg]: how far its tool may still be off, one standard
    deviation."""

    offsets: ArmOffsets
    position: float
    turn: float


UNKNOWN = FoundArm(offsets=NOMINAL, position=3.0, turn=0.4)
"""An arm of which nothing was found: what a mount 2 mm and 0.3 deg off, zeros 0.1 deg off do to a tool."""
