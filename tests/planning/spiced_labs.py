"""Random labs as `random_labs` makes them, each with a few things more that benches have: keep-outs, regions to stage
in, more arms, lasers and shutters, cables, set-points of every kind, parts that lie, are held, unseen or strange, and
plans for some of the parts. mm and deg."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from random_labs import Case, random_case

from pico.diagnostics import error, warning
from pico.model.catalog import Axis, ComponentType, Footprint, Geometry, OpticalElement, Parameter, PoseTunable, Tunable
from pico.model.lab import Box2, KeepOut, Lab, Part, Policy, Region, Tether
from pico.model.observation import (
    Observation,
    ObservedComponent,
    ObservedRobot,
    ObservedValue,
    Uncertainty,
    UnknownObject,
)
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.model.setup import Setup
from pico.model.state import ComponentState, place_of
from pico.motion.arms import ArmMotion
from pico.planning import PlanGoal, Planner, move_one

SHUTTER = Tunable(datatype="choice", choices=("open", "closed"), settle=50)
TUNABLES = {
    "angle": Tunable(unit="deg", period=360, tolerance=0.1, mover="motor", axis=Axis(kind="homed", speed=30)),
    "focus": Tunable(unit="mm", range=(0, 12), tolerance=0.2, mover="motor", settle=250,
                     axis=Axis(kind="absolute", speed=2, backlash=0.5, approach="positive")),
    "power": Tunable(unit="mW", range=(0, 50), resolution=0.5, tolerance=1),
    "lamp": Tunable(datatype="bool", settle=2000),
    "filter": Tunable(datatype="choice", choices=("red", "green", "blue"), mover="person"),
    "drift": Tunable(unit="mm", mover="none", tolerance=0.1),
    "tip": Tunable(unit="mrad", mover="motor", axis=Axis(kind="homed", speed=1, home=3, approach="negative"), settle=0),
}  # fmt: skip
ELEMENTS = ("none", "none", "mirror", "waveplate", "polarizer", "lens", "beam_splitter")


@dataclass
class Spiced:
    """A case, and what is asked of its plan besides."""

    case: Case
    options: dict[str, Any] = field(default_factory=dict)
    with_arms: bool = False
    spices: list[str] = field(default_factory=list)

    @property
    def lab(self) -> Lab:
        return self.case.setup.lab

    @property
    def seen(self) -> Observation:
        return self.case.seen

    def change_lab(self, **changes: Any) -> None:
        setup = self.case.setup
        self.case = replace(self.case, setup=Setup(lab=replace(setup.lab, **changes), catalog=setup.catalog))

    def change_part(self, name: str, **changes: Any) -> None:
        self.change_lab(inventory={**self.lab.inventory, name: replace(self.lab.inventory[name], **changes)})

    def change_types(self, change: Callable[[ComponentType], ComponentType]) -> None:
        catalog = {name: change(kind) for name, kind in self.case.setup.catalog.items()}
        self.case = replace(self.case, setup=Setup(lab=self.lab, catalog=catalog))

    def change_seen(self, **changes: Any) -> None:
        self.case = replace(self.case, seen=replace(self.seen, **changes))

    def see(self, name: str, **changes: Any) -> None:
        self.change_seen(components={**self.seen.components, name: replace(self.seen.components[name], **changes)})

    def want(self, name: str, **changes: Any) -> None:
        wanted = self.case.wanted
        part = replace(wanted.components.get(name, ComponentState()), **changes)
        self.case = replace(self.case, wanted=replace(wanted, components={**wanted.components, name: part}))


def spiced_case(seed: int, *, least: int = 3, most: int = 7) -> Spiced:
    """Return the case that belongs to a seed, with two to four spices."""
    rng = random.Random(seed)
    made = Spiced(random_case(seed, least=least, most=most))
    chosen = {*rng.sample(SPICES, rng.randint(2, 4)), *rng.choice(((), (wider, rings), (wider, rings, regions)))}
    for spice in sorted(chosen, key=SPICES.index):
        made.spices.append(spice.__name__)
        spice(made, rng)
    return made


def move_alone(made: Spiced, name: str) -> Plan:
    """Return the plan that takes one part to where it belongs, and moves nothing else."""
    setup, (slot, pose) = made.case.setup, place_of(made.case.setup, made.case.wanted, name)
    motion = ArmMotion(setup) if made.with_arms else None
    planner = Planner(setup, motion, made.seen)
    return planner.plan(move_one(planner, name, slot or pose))


def plan_spiced(made: Spiced) -> Plan:
    """Return the plan of a case."""
    setup = made.case.setup
    motion = ArmMotion(setup) if made.with_arms else None
    return Planner(setup, motion, made.case.seen).plan(PlanGoal(made.case.wanted, **made.options))


def one(made: Spiced, rng: random.Random) -> str:
    return rng.choice([n for n in made.lab.inventory if n.startswith("c")])


def somewhere(made: Spiced, rng: random.Random, large: float) -> Box2:
    (width, depth), sides = made.lab.table.size, (rng.uniform(0.3, 1) * large, rng.uniform(0.3, 1) * large)
    x, y = rng.uniform(0, max(1.0, width - sides[0])), rng.uniform(0, max(1.0, depth - sides[1]))
    return Box2(x=(round(x), round(x + sides[0])), y=(round(y), round(y + sides[1])))


def regions(made: Spiced, rng: random.Random) -> None:
    """Regions to put parts down in, and only a few slots."""
    found = {f"r{n}": Region(area=somewhere(made, rng, 500), staging=rng.random() < 0.8) for n in range(2)}
    named = {p.slot for p in made.case.wanted.components.values()} | {"s00"}
    few = {n: s for k, (n, s) in enumerate(made.lab.slots.items()) if n in named or k < rng.choice((1, 2))}
    made.change_lab(regions=found, slots=few)


def keep_outs(made: Spiced, rng: random.Random) -> None:
    heights = ((0, 300), (150, 300), (85, 300), (0, 1))
    made.change_lab(keep_out={
        f"k{n}": KeepOut(area=somewhere(made, rng, 40), z=rng.choice(heights), reason=rng.choice(("", "hot")))
        for n in range(rng.randint(1, 2))
    })  # fmt: skip


def gantries(made: Spiced, rng: random.Random) -> None:
    """One arm more, or other arms, which say how long they take."""
    made.with_arms = True
    mounts = [Mount(x=rng.uniform(0, 400), y=rng.uniform(0, 300)) for _ in range(rng.choice((1, 2, 2, 3)))]
    made.change_lab(robots={
        f"arm{n}": Robot(model="gantry", mount=m, speed=rng.choice((0.3, 0.5, 1.0))) for n, m in enumerate(mounts, 1)
    })  # fmt: skip


def second_arm(made: Spiced, rng: random.Random) -> None:
    """Another arm, nobody tells how long it takes; now and then one without fingers."""
    gripper = Gripper(fingers="none") if rng.random() < 0.5 else Gripper()
    arms = {**made.lab.robots, "arm2": Robot(mount=Mount(x=rng.uniform(0, 300), y=0), gripper=gripper)}
    made.change_lab(robots=arms)


def cables(made: Spiced, rng: random.Random) -> None:
    for _ in range(2):
        anchor, length = (rng.uniform(0, 300), rng.uniform(0, 300)), rng.uniform(250, 600)
        made.change_part(
            one(made, rng), tether=Tether(anchor=anchor, length=length, yaw_limit=rng.choice((45, 120, 360)))
        )


def set_points(made: Spiced, rng: random.Random) -> None:
    """Tunables of every kind; what is seen and wanted of them, not always all."""
    made.change_types(lambda kind: replace(
        kind, tunables={n: TUNABLES[n] for n in rng.sample(sorted(TUNABLES), rng.randint(1, 4))},
        optics=OpticalElement(element=rng.choice(ELEMENTS)),
    ))  # fmt: skip
    for name in made.lab.inventory:
        kinds = made.case.setup.type_of(name).tunables
        values = {t: _value(rng, k) for t, k in kinds.items()}
        seen = {
            t: ObservedValue(value=v, status=rng.choice(("known",) * 4 + ("commanded",)))
            if rng.random() < 0.8 else ObservedValue(value=None, status="unknown")
            for t, v in values.items()
        }  # fmt: skip
        made.see(name, values=seen)
        goals = {t: _near(rng, k, values[t]) for t, k in kinds.items() if rng.random() < 0.7}
        made.want(name, values=goals)


def _value(rng: random.Random, kind: Tunable) -> Any:
    if kind.datatype == "bool":
        return rng.random() < 0.5
    if kind.datatype == "choice":
        return rng.choice(kind.choices)
    return round(rng.uniform(*(kind.range or (0, 360))), 1)


def _near(rng: random.Random, kind: Tunable, value: Any) -> Any:
    """Return a value to be: the same, another, or one near it."""
    if kind.datatype == "float" and rng.random() < 0.4:
        return value + rng.choice((0.0, kind.tolerance, kind.tolerance * 1.5, kind.resolution / 2))
    return _value(rng, kind)


def beams(made: Spiced, rng: random.Random) -> None:
    """Lasers with shutters of their own or on the table before them, behind the left edge."""
    own, depth = rng.random() < 0.6, made.lab.table.size[1]
    block = Geometry(footprint=Footprint(box=(40, 40)), height=100, mass=0.3)
    tunables = {"shutter": SHUTTER} if own else {"current": TUNABLES["power"]}
    sees = {n: OpticalElement(element=n) for n in ("source", "shutter")}
    wide = {"clear_diameter": Parameter(value=20.0, unit="mm")}
    kinds = {
        name: ComponentType(
            name=name, title=name, geometry=block, seating="bolted", parameters=wide, tunables=has, optics=optics
        )
        for name, has, optics in (("laser", tunables, sees["source"]), ("gate", {"shutter": SHUTTER}, sees["shutter"]))
    }
    setup, lines = made.case.setup, [rng.uniform(40, depth) for _ in range(rng.choice((1, 2)))]
    fixed = {f"laser{n}": Part(type="laser", pose=Pose(-200, y)) for n, y in enumerate(lines)}
    if rng.random() < 0.5:
        fixed |= {
            f"gate{n}": Part(type="gate", pose=Pose(-100, y, rng.choice((0, 0, 30)))) for n, y in enumerate(lines)
        }
    lab = replace(setup.lab, inventory={**setup.lab.inventory, **fixed}, policy=Policy(open_beam=rng.random() < 0.1))
    made.case = replace(made.case, setup=Setup(lab=lab, catalog={**setup.catalog, **kinds}))
    parts = dict(made.seen.components)
    for name, part in fixed.items():
        live = {t: ObservedValue(value=_value(rng, k)) for t, k in kinds[part.type].tunables.items()}
        parts[name] = ObservedComponent(pose=part.pose, values=live)
        if rng.random() < 0.5:
            made.want(name, values={t: _value(rng, k) for t, k in kinds[part.type].tunables.items()})
    made.change_seen(components=parts)


def held(made: Spiced, rng: random.Random) -> None:
    """A part in the hand of an arm; where it was picked is known, or not."""
    name, robot = one(made, rng), rng.choice(sorted(made.lab.robots))
    pose = made.seen.components[name].pose
    picked = rng.choice((pose, None))
    made.see(name, presence="held", pose=rng.choice((pose, pose, pose, None)))
    joints = (0.1, 0.2, 0.25, 0.0) if made.with_arms else ()
    made.change_seen(robots={**made.seen.robots, robot: ObservedRobot(joints=joints, holding=name, picked=picked)})


def left_away(made: Spiced, rng: random.Random) -> None:
    """Arms that were stopped on their way."""
    for name, robot in made.lab.robots.items():
        away = rng.choice((0.0, 0.01, 0.1))
        parked = tuple(math.radians(q) + away for q in robot.park) if robot.model == "xarm7" else (0.1, away, 0.2, 0.0)
        made.change_seen(robots={name: ObservedRobot(joints=parked), **made.seen.robots})


def badly_seen(made: Spiced, rng: random.Random) -> None:
    """Parts that lie, that nobody sees, that are seen badly or with a word on them."""
    for _ in range(2):
        name, kind = one(made, rng), rng.random()
        if kind < 0.25:
            made.see(name, presence="toppled")
        elif kind < 0.5:
            made.see(name, presence="missing", pose=rng.choice((None, made.seen.components[name].pose)))
        elif kind < 0.75:
            made.see(name, uncertainty=Uncertainty(position=rng.choice((0.1, 2.0)), yaw=rng.choice((0.1, 3.0))))
        else:
            say = rng.choice((error, warning))
            word = say(rng.choice(("marker-hidden", "torn")), f"something is wrong with {name}", address=name)
            made.change_seen(problems=(*made.seen.problems, word))


def unnamed(made: Spiced, rng: random.Random) -> None:
    """Parts that the state does not name: they belong in storage."""
    slots = sorted(made.lab.slots)
    for n in range(2):
        name = one(made, rng)
        made.change_part(name, home=slots[(n + 1) % len(slots)])
        rest = {k: v for k, v in made.case.wanted.components.items() if k != name}
        made.case = replace(made.case, wanted=replace(made.case.wanted, components=rest))


def strangers(made: Spiced, rng: random.Random) -> None:
    area = somewhere(made, rng, 10)
    thing = UnknownObject(
        pose=Pose(area.x[0], area.y[0], rng.choice((0, 30))), footprint=Footprint(disc=rng.choice((8, 20))),
        height=rng.choice((20, 150)),
    )  # fmt: skip
    made.change_seen(unknown={"unknown/7": thing})


def by_hand(made: Spiced, rng: random.Random) -> None:
    """A type that only people move, and one that is bolted."""
    person = rng.choice(sorted(made.case.setup.catalog))
    made.change_types(lambda kind: replace(kind, pose=PoseTunable(mover="person")) if kind.name == person else kind)


def shifted(made: Spiced, rng: random.Random) -> None:
    """Parts that stand, or are wanted, a little off."""
    for name, part in made.seen.components.items():
        goal = place_of(made.case.setup, made.case.wanted, name)[1]
        off = rng.choice((0.005, 0.2, 0.45, 0.7, 3.0))
        if part.pose and rng.random() < 0.5:
            made.see(name, pose=Pose(goal.x + off, goal.y, goal.yaw + rng.choice((0.0, 0.3, 0.8))))


def wider(made: Spiced, rng: random.Random) -> None:
    """A larger table with everything as far apart."""
    by, lab, wanted = rng.uniform(1.2, 1.6), made.lab, made.case.wanted

    def far(pose: Pose) -> Pose:
        return Pose(pose.x * by, pose.y * by, pose.yaw)

    goals = {n: replace(p, pose=far(p.pose)) if p.pose else p for n, p in wanted.components.items()}
    made.case = replace(made.case, wanted=replace(wanted, components=goals))
    stand = {n: replace(p, pose=far(p.pose)) if p.pose else p for n, p in made.seen.components.items()}
    slots = {n: replace(s, x=s.x * by, y=s.y * by) for n, s in lab.slots.items()}
    arms = {n: replace(r, mount=replace(r.mount, x=r.mount.x * by, y=r.mount.y * by)) for n, r in lab.robots.items()}
    size = tuple(side * by for side in lab.table.size)
    made.change_seen(components=stand)
    made.change_lab(table=replace(lab.table, size=size), slots=slots, robots=arms)


def rings(made: Spiced, rng: random.Random) -> None:
    """Parts of one type that take each other's places, in one ring or two, while the others stay where they are.
    Storage has room for a few at a time, or for none."""
    types = made.case.setup.catalog
    kind = min(types, key=lambda t: types[t].geometry.footprint.radius)
    names = [n for n in made.lab.inventory if made.seen.components[n].pose and made.case.wanted.components[n].pose]
    for name in names:
        made.want(name, pose=made.seen.components[name].pose)
    rng.shuffle(names)
    names = names[: rng.choice((2, 3, 4, 5))]
    split = rng.choice((len(names), 2))
    for ring in (names[:split], names[split:]):
        for name, other in zip(ring, [*ring[1:], *ring[:1]], strict=True):
            made.change_part(name, type=kind, seating=None, stage=rng.choice(("allowed",) * 6 + ("avoid", "never")))
            there = made.seen.components[other].pose
            made.want(name, slot=None, pose=Pose(there.x, there.y, there.yaw + rng.choice((0, 0, 90, 30))), values={})
            made.see(name, values={})
    named = {p.slot for p in made.case.wanted.components.values()} | {"s00"}
    few = {n: s for k, (n, s) in enumerate(made.lab.slots.items()) if n in named or k < rng.choice((0, 1, 2, 3, 9))}
    made.change_lab(slots=few)


def crowded(made: Spiced, rng: random.Random) -> None:
    """Now and then a part that is to stand near another, or in it."""
    a, b = one(made, rng), one(made, rng)
    if rng.random() < 0.6:
        return
    there = place_of(made.case.setup, made.case.wanted, b)[1]
    by = rng.choice((30.0, 55.0, 62.0, 80.0, 95.0, 110.0))
    made.want(a, slot=None, pose=Pose(round(there.x + by), round(there.y + rng.choice((0.0, by))), there.yaw))


def some(made: Spiced, rng: random.Random) -> None:
    """A plan for some of the parts, or without some."""
    names = {one(made, rng) for _ in range(2)}
    tunables = {n: ["pose", *made.case.setup.type_of(n).tunables] for n in sorted(names)}
    named = {f"{n}.{rng.choice(t)}" if rng.random() < 0.3 else n for n, t in tunables.items()}
    made.options["targets" if rng.random() < 0.6 else "exclude"] = named


def asked(made: Spiced, rng: random.Random) -> None:
    made.options |= {"exact": rng.random() < 0.5, "prefer": rng.choice(("fewest-moves", "shortest-time"))}


SPICES: tuple[Callable[[Spiced, random.Random], None], ...] = (
    wider, rings, regions, keep_outs, gantries, second_arm, cables, set_points, beams, held, left_away, badly_seen,
    unnamed, strangers, by_hand, shifted, crowded, some, asked,
)  # fmt: skip
