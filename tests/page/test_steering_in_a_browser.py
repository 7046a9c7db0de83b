"""Who steers in a browser and lets go, or is gone: the bench's own record says when it moved last."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from threading import Timer
from typing import Any

from test_in_a_browser import begun, pytestmark

sys.path.append(str(Path(__file__).resolve().parent.parent / "server"))
from desks import desked

from pico.history.examples.example import make_example

__all__ = ["pytestmark"]
WITHIN, QUIET = 0.2, 0.6
"""Seconds in which motion is over, and for which it is looked whether any follows."""
JUST = 0.5
"""Seconds before the end of a hold in which something moved."""
WAYS = {"key", "blur", "hidden", "minimized", "cut", "silent", "killed"}
"""Whatever ends a hold: the key goes up; the window is told that it lost the focus; another tab is in front; the window
is minimized; the line is cut, or says nothing more; the page's process is killed."""
LONGEST = 400.0
"""Seconds after which the browser is ended."""


class Motion:
    """When the table of an edge was not as before, in seconds since 1970."""

    def __init__(self, edge: Any) -> None:
        self.times, self._before = list[float](), list[Any]()
        watch = edge.device.watch
        edge.device.watch = lambda _: watch(lambda _: self._look(edge))

    def _look(self, edge: Any) -> None:
        now = [{n: b.values for n, b in edge.device._session.world().components.items()}]
        if now != self._before:
            self._before = now
            self.times.append(time.time())

    def after(self, moment: float) -> float:
        """Return for how long something moved after a moment [s]."""
        return max((at - moment for at in self.times if at > moment), default=0.0)


def test_whatever_ends_a_hold_ends_the_motion(tmp_path: Path) -> None:
    pictures = [os.environ["PICTURES"]] if "PICTURES" in os.environ else []
    with desked(tmp_path / "books", make_example("shel", tmp_path / "shel").root) as desk:
        assert desk.edge.edge.world is not None
        desk.edge.edge.world.nudge("p2", dx=62.0, dy=22.0)
        motion = Motion(desk.edge.edge)
        desk.served.person("ann", "operator", "teleop")
        code = desk.served.books.people.issued("ann", 600.0, by="test", kind="code").secret
        going = begun("steer.mjs", f"http://127.0.0.1:{desk.served.port}/#code={code}", *pictures)
        assert going.stdin is not None and going.stdout is not None
        limit = Timer(LONGEST, going.kill)
        limit.start()
        found = dict[str, float]()
        try:
            for line in going.stdout:
                how, _, at = line.strip().partition(" ")
                if how not in WAYS:
                    continue
                time.sleep(QUIET)
                if moved := motion.after(float(at) - JUST) > 0:
                    found[how] = motion.after(float(at))
                print("on" if moved else "again", file=going.stdin, flush=True)
            assert going.wait(60) == 0, going.stderr and going.stderr.read()
        finally:
            limit.cancel()
            going.kill()
            going.wait()
    print({how: f"{1000 * seconds:.0f} ms" for how, seconds in found.items()})
    assert set(found) == WAYS
    assert all(seconds <= WITHIN for seconds in found.values()), found
