"""Plans and refusals of benches that random ones seldom are, kept as text: see `kept`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from fuzzing import plan_case
from kept import differs
from planning_benches import TALL, TYPES, Places, bench, part, planned, see, want
from random_labs import random_case
from test_golden import told

from pico.model.body import Body
from pico.model.catalog import Footprint
from pico.model.lab import Box2, KeepOut, Margins, Region, Slot, Table
from pico.model.observation import ObservedComponent, ObservedRobot, UnknownObject
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion

REFUSED = (315, 320, 321, 333, 368, 402, 447, 452, 500, 580, 693, 726)
"""Seeds of random labs for which there is no plan."""
RARE = (
    5001, 5019, 5022, 5029, 5032, 5043, 5090, 5138, 5144, 5163, 5182, 5197, 5221, 5239, 5260, 5320, 5344, 5362, 5400,
    5431, 5461, 5476, 5536, 5546, 5562, 5579, 5655, 5664,
)  # fmt: skip
"""Seeds of random labs where the search has to go far: storage has no room for the fewest stagings, no one grasp will
do, three block one another whatever the others do, what is right must make way."""
FREE = Region(area=Box2(x=(30, 770), y=(200, 470)), staging=True)
STEM = replace(TALL, bodies=(
    Body(name="base", shape="box", size=(60, 60, 12), at=(0, 0, 6)),
    Body(name="post", shape="cylinder", size=(14, 80), at=(0, 0, 50)),
    Body(name="grip", shape="box", size=(30, 30, 50), at=(0, 0, 115)),
))  # fmt: skip
"""A block that a gripper can take hold of."""
SWAP: tuple[Places, Places] = {"a": (300, 300), "b": (500, 300)}, {"a": (500, 300), "b": (300, 300)}
RING: tuple[Places, Places] = (
    {"a": (300, 300), "b": (500, 300, 30), "c": (400, 420)}, {"a": (500, 300), "b": (400, 420, 120), "c": (300, 300)}
)  # fmt: skip


def made(setup: Setup, places: tuple[Places, Places], **rest: object) -> Plan:
    return planned(setup, see(setup, places[0]), want(places[1]), **rest)  # type: ignore[arg-type]


def tables() -> Iterator[tuple[str, Plan]]:
    """Where parts are put down on the table meanwhile, in the regions that a lab has for it."""
    blocks = dict.fromkeys("abc", "block")
    for name, slots in (
        ("a slot too small", {"s1": Slot(x=60, y=60, fits=20)}),
        ("a slot", {"s1": Slot(x=60, y=60)}),
        ("a slot in the region", {"s1": Slot(x=100, y=250)}),
    ):
        for title, ends in (("swap", SWAP), ("ring", RING)):
            parts = {n: blocks[n] for n in ends[0]}
            yield f"{title}, {name}", made(bench(parts, slots, regions={"free": FREE}), ends)
            yield f"{title}, {name}, no region", made(bench(parts, slots), ends)
    narrow = Region(area=Box2(x=(40, 105), y=(300, 365)), staging=True)
    yield (
        "a narrow region",
        made(bench({"a": "block", "b": "block"}, {"s": Slot(x=300, y=300)}, regions={"n": narrow}), SWAP),
    )
    less = replace(narrow, area=Box2(x=(40, 99), y=(300, 365)))
    yield (
        "too narrow a one",
        made(bench({"a": "block", "b": "block"}, {"s": Slot(x=300, y=300)}, regions={"n": less}), SWAP),
    )
    rails = {"a": part("rail"), "b": part("rail")}
    yield "rails", made(bench(rails, {"s": Slot(x=60, y=60, fits=20)}, regions={"free": FREE}), SWAP)


def refusals() -> Iterator[tuple[str, Plan]]:
    for seed in REFUSED:
        yield f"seed {seed}", plan_case(random_case(seed, least=3, most=6))
    lamp = KeepOut(area=Box2(x=(532, 560), y=(290, 310)), z=(100, 300), reason="hot")
    over = KeepOut(area=Box2(x=(490, 560), y=(290, 310)), z=(0, 300))
    one = {"a": part("one_way")}
    there: tuple[Places, Places] = {"a": (300, 300)}, {"a": (500, 300)}
    yield "fingers in a keep-out", made(bench(one, keep_out={"lamp": lamp}), there)
    yield "in a keep-out", made(bench(one, keep_out={"lamp": over}), there)
    wide = bench(
        {**one, "wall": part(seating="bolted"), "other": part(seating="bolted")}, margins=Margins(body=2, fingers=2)
    )
    walls: Places = {"wall": (564, 300), "other": (436, 300)}
    yield "between two walls", made(wide, ({**there[0], **walls}, {**there[1], **walls}))
    yield "into a slot that is taken", made(bench({"a": "block", "b": part(seating="bolted")}), (
        {"a": (300, 300), "b": (90, 60)}, {"a": "s1", "b": (90, 60)}))  # fmt: skip
    for at, x, y in (("left", 470, 310), ("right", 530, 310), ("below", 490, 270), ("above", 490, 330)):
        beside: Places = {"b": (500, 300)}
        full = bench({"a": "block", "b": part(seating="bolted")})
        yield f"{at} of another", made(full, ({"a": (200, 300), **beside}, {"a": (x, y), **beside}))
    yield "over the edge", made(bench({"a": "block"}), ({"a": (300, 300)}, {"a": (790, 480)}))
    holding = {"arm1": ObservedRobot(joints=(), holding="b")}
    full = bench({"a": "block", "b": "block"})
    seen = see(full, {"a": (300, 300)}, robots=holding)
    yield "with a full hand", planned(full, seen, want({"a": (500, 300)}))
    stranger = UnknownObject(pose=Pose(480, 330), footprint=Footprint(disc=25), height=90)
    seen = see(full, {"a": (300, 300), "b": (100, 300)}, unknown={"unknown/9": stranger})
    yield "onto a stranger", planned(full, seen, want({"a": (500, 300), "b": (100, 300)}))
    yield "a person's part", made(bench({"a": part(seating="bolted"), "b": "block"}), SWAP)


def stocked(seed: int) -> Plan:
    """With more free slots than are looked at, some of them taken by parts that stay."""
    case = random_case(seed, least=8 if seed % 2 else 5, most=9 if seed % 2 else 7)
    lab = case.setup.lab
    more = {f"t{n:02}": Slot(x=60 + 110 * (n % 8), y=lab.table.size[1] + 60 + 110 * (n // 8)) for n in range(72)}
    still = {f"z{n}": part("block", seating="bolted", home=f"t{7 * n:02}") for n in range(8)}
    seen = {n: ObservedComponent(pose=more[p.home or ""].pose) for n, p in still.items()}
    lab = replace(
        lab, table=Table(size=(960, lab.table.size[1] + 1100)), slots={**lab.slots, **more},
        inventory={**lab.inventory, **still},
    )  # fmt: skip
    setup = Setup(lab=lab, catalog={**case.setup.catalog, "block": TYPES["block"]})
    seen = {**case.seen.components, **seen}
    return plan_case(replace(case, setup=setup, seen=replace(case.seen, components=seen)))


def arms() -> Iterator[tuple[str, Plan]]:
    """With the motion of arms: reach, paths, what stands in their way, who waits for whom."""
    arm, there = Robot(mount=Mount(x=480, y=760, yaw=-90)), Robot(mount=Mount(x=480, y=40, yaw=90))
    slots = {"s1": Slot(x=200, y=400), "s2": Slot(x=760, y=420), "s3": Slot(x=480, y=180)}
    swap: tuple[Places, Places] = {"a": (380, 400), "b": (600, 400)}, {"a": (600, 400), "b": (380, 400)}
    apart: tuple[Places, Places] = {"a": (290, 480), "b": (680, 320)}, {"a": (320, 540, 90), "b": (640, 260)}
    far: tuple[Places, Places] = {"a": (380, 400), "b": (600, 400)}, {"a": (60, 60), "b": (600, 400)}
    zone = KeepOut(area=Box2(x=(470, 490), y=(0, 480)), z=(150, 300), reason="shelf")
    for title, more in (
        ("one arm", {"robots": {"arm1": arm}}),
        ("a shelf between", {"robots": {"arm1": arm}, "keep_out": {"shelf": zone}}),
    ):
        setup = stems(bench({"a": "block", "b": "block"}, slots, table=Table(size=(1200, 900)), **more))
        motion = ArmMotion(setup)
        for name, ends in (("swap", swap), ("apart", apart), ("out of reach", far)):
            yield f"{name}, {title}", made(setup, ends, motion=motion)
    setup = bench({"a": "block", "b": "block"}, slots, table=Table(size=(1200, 900)), robots={"a1": arm, "a2": there})
    both = stems(setup)
    yield "apart, two arms", made(both, apart, motion=ArmMotion(both))


def stems(setup: Setup) -> Setup:
    return replace(setup, catalog={"block": replace(TYPES["block"], geometry=STEM)})


def kept_as(name: str, plans: Iterator[tuple[str, Plan]]) -> str:
    lines = [line for title, plan in plans for line in (title, *told(plan))]
    return differs(name, "\n".join(lines) + "\n")


def test_what_is_put_down_on_the_table_meanwhile_is_put_down_where_it_was() -> None:
    assert not kept_as("plans_tables.txt", tables())


def test_refusals_say_what_they_said() -> None:
    assert not kept_as("plans_refused.txt", refusals())


def test_plans_with_arms_are_the_ones_kept() -> None:
    assert not kept_as("plans_arms.txt", arms())


@pytest.mark.parametrize("part", range(4))
def test_plans_that_take_much_search_are_the_ones_kept(part: int) -> None:
    rare = ((f"seed {seed}", plan_case(random_case(seed, least=3, most=7))) for seed in RARE[part::4])
    assert not kept_as(f"plans_rare_{part}.txt", rare)


def test_plans_with_many_free_slots_are_the_ones_kept() -> None:
    assert not kept_as(
        "plans_stocked.txt", ((f"seed {seed}", stocked(seed)) for seed in (5090, 5091, 5400, 5401, 5655))
    )
