"""The same plan, byte for byte, whatever Python makes it, and however it happens to order its sets."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "benchmarks"))

import identical  # noqa: E402


@pytest.mark.slow
def test_the_order_of_sets_changes_no_byte() -> None:
    ours, theirs = (identical.plans(sys.executable, hashes, ["minimal", "random"]) for hashes in (1, 2))
    assert len(ours) > 10
    assert identical.different(ours, theirs) == []


def test_a_plan_that_differs_is_named() -> None:
    assert identical.different(["a\t1\t2", "b\t1\t2"], ["a\t1\t2", "b\t1\t3", "c\t1\t2"]) == ["b", "c"]


@pytest.mark.slow
def test_other_versions_of_python_make_the_same_plans() -> None:
    own = identical.version(sys.executable)
    others = {name: python for name, python in identical.installed()[0].items() if name != own}
    if not others:
        pytest.skip("no other Python here has what PICO needs; `python benchmarks/identical.py --install FOLDER`")
    ours = identical.plans(sys.executable, 1)
    for name, python in others.items():
        assert identical.different(ours, identical.plans(python, 2)) == [], name
