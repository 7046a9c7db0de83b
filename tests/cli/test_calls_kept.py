"""What is called and approved is kept from the approval on, whichever command may start a run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from commanding import Brought, Pico, apply_e1
from pico_cli.app import build

from pico.bench.undo import intention

CALLS: dict[str, tuple[str, ...]] = {
    "apply": ("e2",), "checkout": ("e2",), "do": ("cam", "set", "exposure=3"), "drift": ("--watch", "--heal"),
    "measure": ("cam.image",), "morning": (), "move": ("p2", "home"), "optimize": ("peak", "p1", "cam"),
    "recover": (), "redo": (), "resume": (), "run": ("tilt_scan",), "set": ("cam", "exposure=3"), "undo": (),
    "verify": ("--measure",), "teleop": ("p1.angle", "--begin"), "commission": (), "laser arm": ("laser",),
    "runs replay": (), "bisect run": ("e1", "e1~2", "--expect", "p2.pose.yaw < 10"),
    "bisect start": ("e1", "e1~2", "--expect", "p2.pose.yaw < 10"), "bisect continue": (), "bisect good": (),
    "bisect bad": (), "bisect skip": (), "bisect step": ("--expect", "p2.pose.yaw < 10"),
}  # fmt: skip
"""Each command that may start a run, with words that are enough for it."""
NO_RUN = {"bench update", "calibrate steps", "lease steal", "swap"}
"""Commands that ask, and never start a run."""


def asking(command: Any, name: str = "") -> Iterator[str]:
    """Yield the commands that take `--yes`."""
    if any(p.name == "auto_approve" for p in command.params):
        yield name
    for below in command.list_commands(None) if hasattr(command, "list_commands") else ():
        one = command.get_command(None, below)
        if not one.hidden:
            yield from asking(one, f"{name} {below}".strip())


class Killed(BaseException):
    """The command ends here, as if killed."""


def test_each_command_that_asks_is_one_of_these() -> None:
    assert set(asking(build())) == set(CALLS) | NO_RUN


@pytest.mark.parametrize("name", CALLS)
def test_a_command_that_is_approved_is_kept_before_anything_else(
    brought: Brought, shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    brought(apply_e1)
    heard = list[str]()

    def keep(_: object, command: str) -> Any:
        heard.append(command)
        raise Killed

    monkeypatch.setattr(intention, "keep", keep)
    words = (*name.split(), *CALLS[name])
    with pytest.raises(Killed):
        pico("--bench", "sim", *words, "-y")
    assert [one.split() for one in heard] == [" ".join(heard).split()]
    assert heard[0].split()[: len(name.split())] == name.split()
    assert not {"--bench", "sim", "-y"} & set(heard[0].split())
