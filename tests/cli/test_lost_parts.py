"""After an operation that let go of a part: its result says what was seen then, and `drift` calls that the run's."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from commanding import Brought, Pico, apply_manifest

from pico.model.pose import Pose

OPERATION = re.compile(r"(?m)^ *([↻✗✓]) \d+/\d+ (\w+) .*$")
STANDS = re.compile(r"it stands at (\([^)]*\))")


def where(text: str) -> Pose:
    x, y, yaw = (float(v) for v in text.strip("()").replace("°", "").split(","))
    return Pose(x, y, yaw)


def world(root: Path) -> dict[str, dict]:  # type: ignore[type-arg]
    return json.loads((root / ".pico/benches/sim/world.json").read_text())["components"]


def true_to_the_world(root: Path, told: str) -> int:
    """Compare where a run says that parts stand which it lost with where they do; return how many it says that of."""
    last = {found[2]: STANDS.search(found[0]) for found in OPERATION.finditer(told)}
    places = {name: said[1] for name, said in last.items() if said}
    for name, text in places.items():
        assert where(text).distance(Pose(**world(root)[name]["pose"])) < 1.0, (name, text)
    return len(places)


@pytest.mark.parametrize("seed", [pytest.param(3, marks=pytest.mark.slow), pytest.param(4, marks=pytest.mark.slow), 5])
def test_a_part_that_was_lost_is_told_where_it_is_and_drift_blames_no_hand(
    shel: Path, pico: Pico, brought: Brought, seed: int
) -> None:
    brought(apply_manifest)
    assert pico("commit", "-m", "base").code == 0
    pico("sim", "faults", "drop=0.5", f"seed={seed}")
    answer = pico("apply", "e1", "--fidelity", "physics", "--yes")
    assert "dropped" in answer.out and "(200, 310, 0°)" not in answer.out + answer.err, "that is where it was picked"
    true_to_the_world(shel, answer.out)
    for name, part in world(shel).items():
        lost = re.search(rf"failed: .*dropped {name} .*no camera shows where it is now", answer.out)
        assert not lost or part.get("presence") in ("toppled", "missing"), name
    drifted = pico("drift").out
    if seed == 5:
        assert "which pushed it" in drifted and "in which an arm lost it" in drifted, drifted
    assert "by an operation" in drifted and "moved by hand" not in drifted, drifted
