"""The whole bench over wires: an xArm over TCP, mounts over a serial line, cameras and switches over TCP, each driver
with an emulator at the other end and a simulated world behind. Commands as they are typed."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico, edit

from pico.backends.emulated.bench import PACE
from pico.backends.hardware.links import _open
from pico.bench.bench import Bench
from pico.emulators.xarm.server import XArmEmulator
from pico.model.pose import Pose
from pico.places.bench import BenchPlace

DEVICES = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
there = find_spec("xarm") and find_spec("ElliptecBus")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")]
EMULATED = ("--backend", "hardware", "--emulate")


@pytest.fixture
def wired(shel: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example with its instruments; time goes ten times as fast."""
    shutil.copy(DEVICES, shel)
    monkeypatch.setenv(PACE, "10")
    return shel


def seen_through_an_sdk(root: Path) -> None:
    """Have the cameras over the table be ones of a vendor, reached by its library."""
    path = root / "devices.yaml"
    for port, serial in ((5001, "40000001"), (5002, "40000002")):
        before = f"driver: frames.camera\n    address: {{host: 192.0.2.10, port: {port}}}"
        edit(path, before, f'driver: basler.camera\n    address: {{serial: "{serial}"}}')


def operations(answer: Any) -> list[tuple[Any, ...]]:
    return [
        (o["id"], o["primitive"], o["component"], o["arguments"].get("tunable"), o.get("after"))
        for o in answer.data["operations"]
    ]


def world(root: Path) -> Any:
    found = json.loads((root / ".pico/benches/emulated" / "world.json").read_text())
    del found["sha256"]  # so that it may be edited
    return found


def stands(root: Path, name: str) -> Pose:
    return Pose(**world(root)["components"][name]["pose"])


def applied(pico: Pico, *words: str) -> None:
    answer = pico(*EMULATED, "apply", *words, "--auto-approve")
    assert answer.code == 0, answer.out + answer.err


def test_what_was_applied_is_there_and_nothing_is_left_to_do(wired: Path, pico: Pico) -> None:
    applied(pico, "C2")
    assert stands(wired, "p1").distance(Pose(290, 420, 0)) < 0.1
    again = pico(*EMULATED, "plan", "C2", "--detailed-exitcode")
    assert again.code == 0, again.out
    assert not (wired / ".pico/benches/sim").exists(), "the simulator's table is another"
    assert "  emulated  " in pico(*EMULATED, "runs").out and "No run here" in pico("runs").out


def literally(pico: Pico, said: str, verb: str) -> None:
    """Run the command with a verb that a text names between backticks, as it stands there."""
    (command,) = [c for c in re.findall(r"`pico ([^`]*)`", said) if verb in c.split()]
    words = [word for word in shlex.split(command) if word != "RUN"]
    answer = pico(*words, *(() if verb == "capture" else ("--auto-approve",)))
    assert answer.code == 0, answer.out + answer.err


def test_the_commands_that_it_prints_reach_the_same_bench(wired: Path, pico: Pico) -> None:
    """Each is run as it is printed: the emulated bench moves, and the simulator's is never made."""
    literally(pico, " ".join(pico(*EMULATED, "plan", "C2").out.split()), "apply")
    assert stands(wired, "p1").distance(Pose(290, 420, 0)) < 0.1
    done = pico(*EMULATED, "set", "p1", "angle=5", "--auto-approve")
    assert world(wired)["components"]["p1"]["values"]["angle"]["value"] == pytest.approx(5, abs=0.1)
    literally(pico, " ".join(done.out.split()), "capture")
    assert re.search(r"p1:(\n    .*)*\n    angle: (5|4\.9\d*|5\.0\d*)\n", (wired / "state" / "table.yaml").read_text())
    assert not (wired / ".pico" / "sim").exists(), "a command reached the simulator"


def test_a_restoration_is_the_one_that_the_simulator_makes(wired: Path, pico: Pico) -> None:
    """E3-2 to E1-1: same plan, same operations, and the table is the commit's within tolerance; stereo cameras through
    a camera's own library where that is there."""
    if find_spec("pypylon"):
        seen_through_an_sdk(wired)
    applied(pico, "E3-2")
    assert pico("apply", "E3-2", "--auto-approve").code == 0
    assert operations(pico(*EMULATED, "--json", "plan", "E1-1")) == operations(pico("--json", "plan", "E1-1"))
    applied(pico, "E1-1")
    for name, goal in (("lx_125", Pose(395, 420, 0)), ("p2", Pose(520, 420, 0)), ("p1", Pose(290, 420, 0))):
        assert stands(wired, name).distance(goal) < 0.1, name
    assert world(wired)["components"]["p1"]["values"]["angle"]["value"] == pytest.approx(90, abs=0.1)
    assert pico(*EMULATED, "plan", "E1-1", "--detailed-exitcode").code == 0


def test_what_a_kill_in_the_midst_of_a_move_left_is_found_and_finished(wired: Path, pico: Pico) -> None:
    """The process dies with a part in the hand; who comes next finds it there, sets it down, and goes on."""
    main = [sys.executable, "-c", "import sys; from pico_cli.main import main; sys.exit(main())"]
    going = subprocess.Popen(
        [*main, *EMULATED, "apply", "C2", "--auto-approve"], cwd=wired, stdout=subprocess.DEVNULL, env=os.environ
    )
    try:
        ends = time.monotonic() + 120
        while time.monotonic() < ends and going.poll() is None:
            try:
                if any(robot.get("holding") for robot in world(wired)["robots"].values()):
                    break
            except (OSError, ValueError):
                pass
            time.sleep(0.02)
        assert going.poll() is None, "it was over before it was killed"
        os.kill(going.pid, signal.SIGKILL)
    finally:
        going.kill()
        going.wait()
    assert world(wired)["robots"]["arm1"]["holding"] == "p1"
    applied(pico, "C2")
    assert stands(wired, "p1").distance(Pose(290, 420, 0)) < 0.1
    assert world(wired)["robots"]["arm1"].get("holding") is None
    assert pico(*EMULATED, "plan", "C2", "--detailed-exitcode").code == 0


def test_a_control_box_that_was_away_while_nobody_asked_is_told_and_got_ready_again(wired: Path) -> None:
    with Bench.open(wired, backend="emulated") as bench:
        assert bench.apply("C1").outcome == "done"
        links = _open[BenchPlace(wired.resolve(), "emulated")]
        assert links.emulators is not None
        (arm,) = (one for one in links.emulators._running if isinstance(one, XArmEmulator))
        (bus,) = (bus for key, bus in links._buses._buses.items() if key[0] == "xarm")
        bus.lost = ""
        arm.restart()
        for _ in range(6000):  # until that is missed
            if bus.lost:
                break
            time.sleep(0.01)
        (said,) = (told for told in bench.drift.status().cut_short if told.code == "arm-lost")
        assert bus.lost in said.summary and said.address == "arm1"
        assert bench.apply("C2").outcome == "done"
        assert not [told for told in bench.drift.status().cut_short if told.code == "arm-lost"]


def test_somebody_at_the_table_keeps_the_arm_from_moving(wired: Path, pico: Pico) -> None:
    applied(pico, "C1")
    path = wired / ".pico/benches/emulated" / "world.json"
    path.write_text(json.dumps({**world(wired), "person": True}))
    answer = pico(*EMULATED, "apply", "C2", "--auto-approve")
    assert answer.code == 7 and "nobody_near_the_arm" in answer.out + answer.err


def test_a_bench_without_instruments_says_what_is_missing(shel: Path, pico: Pico) -> None:
    answer = pico(*EMULATED, "plan")
    assert answer.code == 1 and "no driver for the arm arm1 (xarm7)" in answer.err
