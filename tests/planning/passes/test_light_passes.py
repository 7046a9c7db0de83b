"""Light comes out last of all, and only what somebody lets out."""

from __future__ import annotations

from dataclasses import replace

from drafts import begun, lit, op, setting, waits

from pico.model.arming import Licence
from pico.model.observation import Observation
from pico.model.plan import Target
from pico.planning.passes.comparison import compared
from pico.planning.passes.light import light_last, light_told, light_withheld

DARK = {"laser": {"shutter": "closed", "emission": True}}
OPEN = {"laser": {"shutter": "open"}}


def armed(seen: Observation) -> Observation:
    return replace(seen, licences={"laser": Licence(laser_class="3B", by="Ann", ends="2027-01-01T00:00:00Z")})


def test_a_laser_that_nobody_armed_stays_shut_and_that_is_said() -> None:
    draft = compared(begun(lit(strong=True), values=DARK, then=OPEN))
    found = light_withheld(draft)
    assert found.withheld == {("laser", "shutter"): {"laser": "3B"}}
    assert ["stays dark" in d.summary for d in light_told(found).diagnostics] == [True]
    assert light_withheld(replace(draft, seen=armed(draft.seen))).withheld == {}
    assert light_withheld(compared(begun(lit(), values=DARK, then=OPEN))).withheld == {}  # a weak one


def test_undoing_lets_no_light_out() -> None:
    found = light_withheld(compared(begun(lit(), values=DARK, then=OPEN, target=Target(cause="undo"))))
    assert found.withheld == {("laser", "shutter"): {}}
    assert [d.summary for d in light_told(found).diagnostics] == [
        "undoing lets no light out: laser.shutter stays as is"
    ]


def test_a_shutter_opens_after_all_else_while_its_laser_warms_up() -> None:
    opening, warming = setting("laser", "shutter", "open"), setting("laser", "emission", True)
    moves = (op("a", robot="arm1"), op("arm1", "a", robot="arm1", primitive="park"), op("b"))
    draft = replace(begun(lit(), values=DARK), operations=(opening, warming, *moves))
    last = ("laser emission True", "arm1", "b")
    assert waits(light_last(draft).operations)["laser shutter open"] == last
    assert waits(light_last(draft).operations)["laser emission True"] == ()
    bare = replace(draft, seen=begun(lit()).seen)  # its shutter is open: then it shines at once
    assert waits(light_last(bare).operations)["laser emission True"] == ("arm1", "b")
