"""Measuring, seeking a goal and running a recipe from the page, in a real browser, against a bench in the twin."""

from __future__ import annotations

import json
import os
from pathlib import Path

from test_in_a_browser import Served, begun, pytestmark, served

__all__ = ["pytestmark", "served"]
TURNING = """\
apiVersion: pico/v1
kind: Recipe
metadata: {name: turning, title: p1 is turned and looked at}
parameters:
  to: {unit: deg, default: 1, range: [0, 5]}
  often: {unit: deg, default: [1, 2]}
steps:
  - set: {p1.angle: to}
  - foreach: {k: often}
    steps:
      - set: {p1.angle: k}
      - measure: p1.angle
  - move: {p2: {yaw: 31}}
"""
ASKING = """\
apiVersion: pico/v1
kind: Recipe
metadata: {name: asking}
steps:
  - {prompt: Is the cover on?, unattended: skip}
  - {prompt: Read the meter., unit: mW, range: [0, 5], as: read}
  - {prompt: Which sample?, choices: [glass, gold], as: which}
returns: {read: read, which: which}
"""


def test_measuring_a_goal_and_a_recipe(served: Served) -> None:
    (served.lab / "recipes" / "turning.yaml").write_text(TURNING)
    served.said("apply", "e1", "--yes")
    driven("doing.mjs", served)


def test_what_a_recipe_asks_is_answered_in_the_page(served: Served) -> None:
    (served.lab / "recipes" / "asking.yaml").write_text(ASKING)
    made = json.loads(served.said("--json", "token", "invite", "vera", "viewer@shel"))["made"]
    driven("asking.mjs", served, made["secret"])


def driven(script: str, served: Served, *words: str) -> None:
    """Have a script drive the page to its end."""
    pictures: list[str | Path] = [os.environ["PICTURES"]] if "PICTURES" in os.environ else []
    done = begun(script, served.address, *words, *map(str, pictures))
    said, wrong = done.communicate(timeout=400)
    assert done.returncode == 0, said + wrong
    assert "All was done." in said
