"""What is said of goals that can't be, and where there is room instead, kept as text: see `kept`. Parts of all shapes
that are to stand near one another, the table's edge and keep-outs; no order is looked for."""

from __future__ import annotations

import random
from dataclasses import replace

from kept import differs
from random_labs import random_case

from pico.model.lab import Box2, KeepOut, Margins, Slot, Table, Tether
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState
from pico.planning.checks.target import check_target
from pico.planning.checks.tethers import check_tethers
from pico.planning.parts.movers import mover, standing_obstacles


def goals(seed: int) -> tuple[Setup, Observation, LabState]:
    """Three parts that are to stand close, one or two that stand there and stay, and a table that is hardly larger."""
    rng = random.Random(seed)
    case = random_case(seed, least=4, most=4)
    lab = case.setup.lab
    slots = {"s00": Slot(x=60, y=60, yaw=rng.choice((0, 30)), fits=rng.choice((None, 30)), capture=5.0)}
    zone = KeepOut(
        area=Box2(x=(150, 150 + rng.choice((4, 40))), y=(90, 110)), z=rng.choice(((0, 5), (70, 90), (200, 300)))
    )
    tether = Tether(anchor=(100, 0), length=rng.choice((100, 150, 400)), yaw_limit=rng.choice((20, 100)))
    names = sorted(lab.inventory)
    inventory = {n: lab.inventory[n] for n in names}
    inventory[names[0]] = replace(inventory[names[0]], tether=rng.choice((None, tether)))
    lab = replace(
        lab, slots=slots, inventory=inventory, table=Table(size=(rng.choice((360, 280)), 240 if seed % 3 else 190)),
        keep_out={"hot": zone} if rng.random() < 0.5 else {}, margins=Margins(body=rng.choice((0, 2, 10))),
    )  # fmt: skip
    setup = Setup(lab=lab, catalog=case.setup.catalog)

    def anywhere() -> Pose:
        return Pose(round(rng.uniform(30, 270)), round(rng.uniform(30, 180)), rng.choice((0, 0, 90, 30, -135)))

    seen = Observation(backend="sim", components={n: ObservedComponent(pose=anywhere()) for n in names})
    wanted = {n: ComponentState(pose=anywhere()) for n in names[:3]}
    if rng.random() < 0.4:
        wanted[names[1]] = ComponentState(slot="s00")
    return setup, seen, LabState(lab=lab.name, components=wanted)


def test_goals_that_can_not_be_are_told_as_they_were() -> None:
    lines = []
    for seed in range(16):
        setup, seen, wanted = goals(seed)
        movers = {n: mover(setup, seen, wanted, n, ("arm1",), right=False) for n in wanted.components}
        obstacles = standing_obstacles(setup, seen, movers)
        lines.append(f"seed {seed}")
        for d in (*check_target(setup, list(movers.values()), obstacles), *check_tethers(setup, list(movers.values()))):
            lines.append(f"  {d.address}: {d.summary} | {d.detail} | {d.hint}")
    assert not differs("goals.txt", "\n".join(lines) + "\n")
