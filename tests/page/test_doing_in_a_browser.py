"""Measuring, seeking a goal and running a recipe from the page, in a real browser, against a bench in the twin."""

from __future__ import annotations

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
  - prompt: Put the sample in.
"""


def test_measuring_a_goal_and_a_recipe(served: Served) -> None:
    for name, text in (("turning", TURNING), ("asking", ASKING)):
        (served.lab / "recipes" / f"{name}.yaml").write_text(text)
    served.said("apply", "e1", "--yes")
    pictures: list[str | Path] = [os.environ["PICTURES"]] if "PICTURES" in os.environ else []
    done = begun("doing.mjs", served.address, *map(str, pictures))
    said, wrong = done.communicate(timeout=400)
    assert done.returncode == 0, said + wrong
    assert "All was done." in said
