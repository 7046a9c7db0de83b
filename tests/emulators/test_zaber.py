"""An emulated stage tells what is so at one moment: its driver takes it for at rest where it says so."""

from __future__ import annotations

from itertools import count

from pico.emulators.behind import Alone
from pico.emulators.zaber import Stage
from pico.model.wiring import DeviceEntry


def test_a_stage_that_is_idle_tells_where_it_came_to_rest() -> None:
    ticks = count()
    behind = Alone({"position": 0.0, "homed": True}, clock=lambda: next(ticks) * 0.01)
    stage = Stage(
        DeviceEntry(driver="zaber.stage", settings={"counts_per_unit": 1000.0, "emulated_speed": 26.0}), behind
    )
    told = [stage.reply(["move", "abs", "10000"]).split()]
    while told[-1][1] == "BUSY":
        told.append(stage.reply(["get", "pos"]).split())
    assert told[-1] == ["OK", "IDLE", "--", "10000"]
    assert 0 < int(told[-2][3]) < 10000
