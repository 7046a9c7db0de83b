"""What goes wrong at the other end of a wire is told as a failure of a component in an operation; what comes next finds
the bench as it is and goes on."""

from __future__ import annotations

import json
import shutil
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from commanding import Answer, Pico, Typed

from pico.backends.emulated.bench import PACE
from pico.backends.hardware import links
from pico.model.pose import Pose

DEVICES = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
EMULATED = ("--backend", "hardware", "--emulate")
there = find_spec("xarm") and find_spec("ElliptecBus")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(not there, reason="the extras xarm and thorlabs")]


@pytest.fixture
def wired(shel: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico) -> Path:
    """The example with its instruments, as C1 has it; time goes ten times as fast."""
    shutil.copy(DEVICES, shel)
    monkeypatch.setenv(PACE, "10")
    answer = applied(pico, "C1")
    assert answer.code == 0, answer.out + answer.err
    return shel


def applied(pico: Pico, *words: str) -> Answer:
    return pico(*EMULATED, "apply", *words, "--auto-approve")


def arm() -> Any:
    """The emulated arm of the bench that is open in this process."""
    (found,) = links._open.values()
    assert found.emulators is not None
    return next(one for one in found.emulators._running if hasattr(one, "joints"))


def holds() -> bool:
    (found,) = links._open.values()
    world: Any = found.world
    return world is not None and bool(world.world().robots["arm1"].holding)


@contextmanager
def once(condition: Callable[[], bool], act: Callable[[], object]) -> Iterator[None]:
    """Do something as soon as something holds of the bench, beside what goes on."""
    over = threading.Event()
    done = threading.Event()

    def wait() -> None:
        while not over.is_set():
            try:
                if condition():
                    act()
                    done.set()
                    return
            except (ValueError, StopIteration, AssertionError):  # no bench is open yet
                pass
            time.sleep(0.005)

    thread = threading.Thread(target=wait)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
    assert done.is_set(), "it never came to that"


def world(root: Path) -> Any:
    found = json.loads((root / ".pico/benches/emulated" / "world.json").read_text())
    del found["sha256"]  # so that it may be edited
    return found


def test_a_collision_on_the_way_is_cleared_by_a_person_and_the_part_is_set_down(
    wired: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    with once(lambda: holds() and arm().box.state == 1, lambda: arm().fault(31)):
        answer = applied(pico, "C2")
    assert answer.code == 1
    assert "move of p1, failed" in answer.err and "C31" in answer.err, answer.err
    assert world(wired)["robots"]["arm1"]["holding"] == "p1"
    refused = applied(pico, "C2")
    assert refused.code == 1 and "recover` clears it" in refused.err, refused.err
    monkeypatch.setattr("sys.stdin", Typed("y\ny\n"))
    cleared = pico(*EMULATED, "recover")
    assert cleared.code == 0 and "Cleared C31" in cleared.out, cleared.out + cleared.err
    assert world(wired)["robots"]["arm1"].get("holding") is None
    again = applied(pico, "C2")
    assert again.code == 0, again.out + again.err
    assert Pose(**world(wired)["components"]["p1"]["pose"]).distance(Pose(290, 420, 0)) < 0.1


def test_an_arm_that_is_lost_on_the_way_is_told(wired: Path, pico: Pico) -> None:
    with once(holds, lambda: arm().kill()):
        answer = applied(pico, "C2")
    assert answer.code == 1
    assert "move of p1, failed" in answer.err and "arm1" in answer.err, answer.err
    again = applied(pico, "C2")
    assert again.code == 0, again.out + again.err


def test_a_mount_that_is_stuck_is_told_by_its_tunable(wired: Path, pico: Pico) -> None:
    path = wired / ".pico/benches/emulated" / "world.json"
    path.write_text(json.dumps({**world(wired), "stuck": ["hwp.angle"]}))
    answer = pico(*EMULATED, "set", "hwp", "angle=40", "--auto-approve")
    assert answer.code == 1 and "set of hwp.angle, failed" in answer.err, answer.out + answer.err
