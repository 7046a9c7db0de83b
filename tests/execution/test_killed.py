"""A process that is killed in the middle of a move leaves the bench free, and everything needed to go on."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
from pathlib import Path

from benches import apply, shel, sim
from tables import change_world

from pico.backends.sim.hand import nudge, remove

KILLED = """
import asyncio, os, signal, sys
from pathlib import Path
from benches import plan_to, shel, sim
from benches import run

async def go():
    setup, state = shel("gantry")
    bench = sim(setup, Path(sys.argv[1]))
    planned, moves = await plan_to(bench, state), 0
    async for event in run(planned, bench, run_id="r1"):
        moves += event.kind == "operation_done" and "error_mm" in event.data
        if moves == 1 and event.data.get("phase") == "transit":
            os.kill(os.getpid(), signal.SIGKILL)

asyncio.run(go())
"""


def test_what_was_under_way_is_known_what_was_done_is_not_repeated_and_the_next_apply_goes_on(tmp_path: Path) -> None:
    beside = Path(__file__).resolve().parent
    environment = {**os.environ, "PYTHONPATH": str(beside.parent)}
    killed = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], cwd=beside, env=environment, check=False)
    assert killed.returncode == -signal.SIGKILL
    setup, state = shel("gantry")
    bench = sim(setup, tmp_path)
    (cut,) = (u.operation for u in bench.journal.unsettled() if u.operation.primitive == "move")
    assert [r.outcome for r in bench.journal.runs()] == [None]
    first = "p2" if cut.component == "p1" else "p1"
    seen = asyncio.run(bench.observe())
    assert seen.components[first].pose == state.components[first].pose
    if seen.components[cut.component].presence == "held":  # a hand takes it out of the gripper and puts it home
        change_world(setup, tmp_path, "test", lambda w: nudge(setup, remove(setup, w, cut.component), cut.component))
    planned, result, _ = apply(bench, state, "r2")
    assert result.outcome == "done"
    assert [op.component for op in planned.operations if op.primitive == "move"] == [cut.component]
