"""Merges of random manifests, kept as text: see `kept`."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from merging_cases import case

sys.path.append(str(Path(__file__).resolve().parent.parent))

from kept import differs

from pico.history.merge.manifests import Merged, merge

GROUPS = {f"c{n:02d}": (("angle", "exposure", "tip", "tilt"),) for n in range(12)}


def told(found: Merged) -> list[str]:
    lines = [f"  {c.address}: {c.base} | {c.ours} | {c.theirs} | {c.keys}" for c in found.conflicts]
    lines += [f"  coupled: {c.component} {c.ours} {c.theirs}" for c in found.coupled]
    return [f"clean {found.clean}", *lines, *found.data.decode().splitlines()]


@pytest.mark.parametrize("strict", [False, True])
def test_merges_of_random_manifests_are_the_ones_kept(strict: bool) -> None:
    lines: list[str] = []
    for seed in range(40, 58):
        c = case(seed)
        texts = [text.encode() for text in (c.base, c.ours, c.theirs)]
        lines += [f"--- seed {seed}", *told(merge(*texts, groups=GROUPS, strict=strict))]
    assert not differs(f"merges_{'strict' if strict else 'lenient'}.txt", "\n".join(lines) + "\n")


BASE = """apiVersion: pico/v1
kind: LabState
metadata: {lab: bench}
components:
  # first
  m1:
    slot: a1
    tip: 1.0  # mrad
  # second
  m2: {slot: a2, tilt: 2}
  m3:
    pose: {x: 1, y: 2, yaw: 3}  # by hand
# the end
"""

LONG = "[" + ", ".join(f"{{that: m{n}.tip > 0}}" for n in range(1, 4)) + "]"
CHANGES = {
    "both move it": ("slot: a1", "slot: b1", "slot: c1"),
    "a slot against a pose": ("slot: a1", "pose: {x: 9, y: 9, yaw: 0}", "slot: c1"),
    "taken out and changed": ("  m2: {slot: a2, tilt: 2}\n", "", "  m2: {slot: a2, tilt: 5}\n"),
    "taken out with a new comment": ("  m2: {slot: a2, tilt: 2}\n", "", "  m2: {slot: a2, tilt: 2}  # wobbly\n"),
    "all taken out": ("    slot: a1\n    tip: 1.0  # mrad\n", "    slot: a1\n", "    slot: a1\n    tip: 1.0  # worn\n"),
    "in braces": ("{slot: a2, tilt: 2}", "{slot: b2, tilt: 2}", "{slot: a2, tilt: 3}"),
    "in braces and out of them": ("{slot: a2, tilt: 2}", "{slot: b2, tilt: 2}", "\n    slot: a2\n    tilt: 3"),
    "both comment": ("# mrad", "# of ours", "# of theirs"),
    "both comment above": ("  # second\n", "  # second, ours\n", "  # second\n  # and theirs\n"),
    "both add": ("# the end\n", "  n1: {slot: x}\n# the end\n", "  n1: {slot: y}\n  n2: {slot: z}\n# the end\n"),
    "both add the same": ("# the end\n", "  n1: {slot: x}\n# the end\n", "  n1: {slot: x}\n# the end\n"),
    "order": ("  # first\n", "  b9: {slot: q}\n  # first\n", "  a0: {slot: r}\n  # first\n"),
    "the end": ("# the end\n", "# the end, ours\n", "# finis\n"),
    "the pose in part": ("{x: 1, y: 2, yaw: 3}", "{x: 5, y: 2, yaw: 3}", "{x: 1, y: 2, yaw: 9}"),
    "words": ("slot: a1", "slot: a1 ", "slot: 'a1'"),
    "numbers": ("tip: 1.0", "tip: 1", "tip: 1.00"),
    "quoted": ("slot: a1", "slot: 1", 'slot: "1"'),
    "a list": ("metadata:", "expect: [{that: a}]\nmetadata:", "expect: [{that: b}]\nmetadata:"),
    "a long list": ("metadata:", f"expect: {LONG}\nmetadata:", f"expect: {LONG[:-1]}, {{that: c}}]\nmetadata:"),
    "no newline at the end": ("# the end\n", "  n1: {slot: x}", "  n1: {slot: y}"),
    "moved below": ("    tip: 1.0  # mrad\n", "    tip: 1.0  # mrad\n    # below\n    tilt: 3\n", "    tip: 2.0\n"),
    "comments moved": ("  # first\n", "  # second\n", "  # first\n  # second\n"),
    "comments doubled": ("  # first\n", "  # first\n  # first\n", "  # 1st\n"),
    "braces against lines": (
        "  m2: {slot: a2, tilt: 2}\n",
        "  m2: {slot: a2, tilt: 2, tip: 1}\n",
        "  m2:\n    slot: b2\n",
    ),
    "a part against none": ("  m2: {slot: a2, tilt: 2}\n", "  m2:\n", "  m2: {slot: a2}\n"),
    "not alike": ("LabState", "LabState", "Lab"),
    "broken": ("slot: a1", "slot: [", "slot: c1"),
}


def test_merges_of_changes_made_by_hand_are_the_ones_kept() -> None:
    lines: list[str] = []
    for name, (was, ours, theirs) in CHANGES.items():
        texts = [BASE.replace(was, new).encode() for new in (was, ours, theirs)]
        lines += [f"--- {name}", *told(merge(*texts, groups={}))]
        lines += [f"--- {name}, without a base", *told(merge(None, *texts[1:], groups={}))]
        back = merge(texts[0], texts[2], texts[1], groups={})
        lines += [f"--- {name}, the other way", *told(back)]
    assert not differs("merges_by_hand.txt", "\n".join(lines) + "\n")
