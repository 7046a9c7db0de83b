"""Arms that follow joint trajectories."""

from __future__ import annotations

from pico.drivers.protocols import Arm
from pico.model.instruments.kind import InstrumentKind


async def _reads(arm: Arm) -> str:
    state = await arm.state()
    said = f"{'enabled' if state.enabled else 'not enabled'}, heard of {state.age:.1f} s ago"
    return said + (", moving" if state.moving else "") + (f", fault {state.fault}" if state.fault else "")


KIND = InstrumentKind(
    name="arm", about="an arm that follows joint trajectories", protocol=Arm, reads=_reads, role="arm", datatypes=()
)
