"""What `pico lease show` says of a coordinator whose clock is another one than that of this computer."""

from __future__ import annotations

import time

from pico_cli.views.lease import text


def test_since_when_goes_by_the_coordinators_clock_alone() -> None:
    holder = {"who": "bob", "since": time.time() + 7200, "had": 190.0, "fenced": True, "run": ""}
    assert text("shel/bench1", {"holder": holder, "mine": False}) == "bob has shel/bench1 since 3 min ago."
