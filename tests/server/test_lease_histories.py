"""The checker of recorded histories of leases finds what breaks a rule."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

from lease_histories import Told, broken

GOOD = (
    Told("edge", "fenced", 1, 0.9, 1.0), Told("ann", "has", 1, 0.5, 1.1), Told("ann", "has", 1, 2.0, 2.1),
    Told("ann", "ended", 1, 3.0, 3.1), Told("edge", "fenced", 2, 4.0, 4.1), Told("ben", "has", 2, 3.2, 4.2),
)  # fmt: skip
WRONG = {
    "both granted": Told("ben", "has", 1, 1.5, 1.6),
    "before the edge had fenced": Told("ann", "has", 3, 5.0, 5.1),
    "after the edge had fenced for 2": Told("ann", "has", 1, 4.5, 4.6),
    "after it was given back": Told("ann", "has", 1, 3.5, 3.6),
    "fenced for a token again": Told("edge", "fenced", 1, 5.0, 5.1),
}


def test_what_went_right_breaks_no_rule() -> None:
    assert broken(GOOD) == []


@pytest.mark.parametrize("rule", WRONG)
def test_each_rule_finds_what_breaks_it(rule: str) -> None:
    assert any(rule in one for one in broken((*GOOD, WRONG[rule])))
