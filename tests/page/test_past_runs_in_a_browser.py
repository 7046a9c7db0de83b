"""Past runs on the page, in a real browser: a plot with its bars, the pictures of cameras, how a goal was sought."""

from __future__ import annotations

import os

from test_in_a_browser import Served, begun, pytestmark, served

__all__ = ["pytestmark", "served"]
OFTEN = """\
apiVersion: pico/v1
kind: Recipe
metadata: {name: often, title: the spot is measured often}
steps:
  - foreach: {k: [1, 2, 3, 4]}
    steps:
      - measure: cam.centroid
"""


def test_what_runs_measured_and_kept_is_seen(served: Served) -> None:
    (served.lab / "recipes" / "often.yaml").write_text(OFTEN)
    served.said("apply", "e1", "--yes")
    for part, value in (("p1", "angle=90"), ("hwp", "angle=2"), ("cam", "exposure=0.2")):
        served.said("set", part, value, "--yes")
    served.said("run", "often", "--yes")
    served.said("measure", "cam.image", "--yes")
    served.said("set", "ly_150", "stage_y=0.5", "--yes")
    served.said("optimize", "ly_150_centred", "--yes")
    pictures = [os.environ["PICTURES"]] if "PICTURES" in os.environ else []
    done = begun("kept.mjs", served.address, *pictures)
    said, wrong = done.communicate(timeout=400)
    assert done.returncode == 0, said + wrong
    assert "All was seen." in said
