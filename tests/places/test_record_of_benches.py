"""Which worktree has a bench, as the record that all worktrees of a repository share says it: case by case."""

from __future__ import annotations

from pathlib import Path

import pytest

from pico.places.lab import LabPlace
from pico.places.record import SHARED, note, recorded


@pytest.fixture
def place(tmp_path: Path) -> LabPlace:
    """A lab in `labs/shel` of the worktree `second` of a repository; its Git folder is in the worktree `main`."""
    top = tmp_path / "second"
    return LabPlace(top / "labs" / "shel", top, tmp_path / "main" / ".git")


def there(worktree: str) -> str:
    """What a record says of the lab in a worktree."""
    return f"../../{worktree}/labs/shel"


@pytest.mark.parametrize("used", [False, True])
@pytest.mark.parametrize("own", [None, "third"])
@pytest.mark.parametrize("shared", [None, "first"])
def test_a_bench_is_where_its_own_entry_says_else_where_all_were_else_where_it_was_used(
    place: LabPlace, used: bool, own: str | None, shared: str | None
) -> None:
    """`shared`: the entry of an earlier version, for all benches of the lab; `used`: the main worktree has the bench's
    lock."""
    main = place.common.parent / "labs" / "shel"
    if used:
        (main / ".pico" / "benches" / "sim").mkdir(parents=True)
        (main / ".pico" / "benches" / "sim" / "lock").touch()
    entries = {name: there(tree) for name, tree in (("sim", own), (SHARED, shared)) if tree}
    said = own or shared
    expected = place.common.parent.parent / said / "labs" / "shel" if said else main if used else None
    record = {"labs/shel": {**entries, "hardware": there("fourth")}, "labs/other": {"sim": there("fifth")}}
    assert recorded(place, record, "sim") == expected
    assert recorded(place, {}, "sim") == (main if used else None)


def test_a_bench_is_noted_for_one_worktree_and_the_others_stay(place: LabPlace) -> None:
    record = {"labs/shel": {SHARED: there("first"), "hardware": there("first")}, "labs/other": {"sim": there("first")}}
    note(place, record, "sim")
    assert recorded(place, record, "sim") == place.root
    first = place.common.parent.parent / "first" / "labs" / "shel"
    assert recorded(place, record, "hardware") == recorded(place, record, "emulated") == first
    assert record["labs/other"] == {"sim": there("first")}
