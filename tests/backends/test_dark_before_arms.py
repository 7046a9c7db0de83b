"""No arm works while the shutter of a laser that closes by itself is not read back closed, unless the lab allows it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from laser_lab import UNKNOWN, bench, carry, commanded, observed, with_type

from pico.backends.attempt import Failed
from pico.backends.checks import has_shutter, require_dark
from pico.model.observation import ObservedValue

SETUP, MOVE = bench(), carry("holder", 700, 300)


@pytest.mark.parametrize("shutter", ["closed", "open", "ajar", UNKNOWN, commanded("closed"), None])
@pytest.mark.parametrize("presence", ["seen", "missing", "held", "toppled"])
@pytest.mark.parametrize("allowed", [True, False])
@pytest.mark.parametrize("who", ["laser", "second"])
def test_each_shutter_is_read_back_before_an_arm_works(shutter: Any, presence: Any, allowed: bool, who: str) -> None:
    seen = observed(**{who: {"shutter": shutter}})
    seen = replace(seen, components={**seen.components, who: replace(seen.components[who], presence=presence)})
    setup = bench(open_beam=allowed)
    if allowed or presence == "missing" or shutter in ("closed", None):
        require_dark(setup, seen, MOVE)
    else:
        with pytest.raises(Failed, match=f"arm1 must not work in the beam: the shutter of {who} is") as caught:
            require_dark(setup, seen, MOVE)
        assert caught.value.diagnostic.code == "open-beam" and caught.value.diagnostic.address == who
        known = shutter if isinstance(shutter, str) else "not known to be closed"
        assert f"is {known}" in caught.value.diagnostic.summary


def test_only_lasers_with_a_shutter_that_closes_by_itself_and_can_be_read_are_asked() -> None:
    own = {"shutter": ObservedValue(value="open")}
    assert has_shutter(SETUP, "laser", own) and not has_shutter(SETUP, "laser", {})
    assert not has_shutter(SETUP, "gate", own), "one on the table is no laser"
    assert not has_shutter(SETUP, "bare", own) and not has_shutter(SETUP, "stranger", own)
    shutter = SETUP.type_of("laser").tunables["shutter"]
    for mover in ("motor", "electronics", "person", "none", "arm"):
        made = with_type(SETUP, "laser", tunables={"shutter": replace(shutter, mover=mover)})
        assert has_shutter(made, "laser", own) is (mover in ("motor", "electronics"))
    worded = with_type(SETUP, "laser", tunables={"shutter": replace(shutter, choices=("open", "shut"))})
    assert not has_shutter(worded, "laser", own)
