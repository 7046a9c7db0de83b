"""Another specimen in a housing: one part of the inventory changes, all else stays byte for byte, and swaps undo."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.diagnostics import PicoError
from pico.manifest.exchange import exchanged
from pico.manifest.load import load_files
from pico.resources import labs_dir

LAB = {"lab.yaml": (labs_dir() / "shel" / "lab.yaml").read_bytes()}
WORDS = st.text("ABCXYZ0123456789-", min_size=1, max_size=8)


@settings(deadline=None, max_examples=15)
@given(first=WORDS, second=WORDS, length=st.floats(90, 110).map(lambda x: round(x, 2)))
def test_what_is_swapped_comes_back_by_swapping_back(first: str, second: str, length: float) -> None:
    once = exchanged(LAB, "lx_100", first, "plano_convex", {"focal_length": length})
    again = exchanged(exchanged(once, "lx_100", second, None, {"focal_length": 100.0}), "lx_100", first, None,
                      {"focal_length": length})  # fmt: skip
    assert again == once
    old, new = LAB["lab.yaml"].decode().splitlines(), once["lab.yaml"].decode().splitlines()
    assert [line for line in old if line not in new] == ["    type: plano_convex_100"]
    assert len(new) == len(old) + 3
    found = load_files(once)
    assert found.setup is not None
    assert found.setup.lab.inventory["lx_100"].serial == first
    assert found.setup.type_of("lx_100").number("focal_length", "mm") == length


def test_a_part_that_there_is_not_is_refused() -> None:
    with pytest.raises(PicoError, match="no component `lx_10`"):
        exchanged(LAB, "lx_10", "A", None, {})
