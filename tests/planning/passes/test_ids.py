"""Operations of a plan in the making have ids of their own: lists of them are joined as they are."""

from __future__ import annotations

import random
from dataclasses import replace

from test_golden_schedules import listed

from pico.manifest.load import load_folder
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue
from pico.model.pose import Pose
from pico.planning.passes.schedule import schedule
from pico.planning.surveying import surveying
from pico.resources import labs_dir


def test_neither_names_nor_the_order_in_which_others_are_named_change_a_schedule() -> None:
    for seed in range(40):
        rng = random.Random(seed)
        operations = listed(rng)
        names = [f"x{n}" for n in range(len(operations))]
        rng.shuffle(names)
        called = dict(zip((op.id for op in operations), names, strict=True))
        others = []
        for op in operations:
            after = [called[e] for e in op.after]
            rng.shuffle(after)
            others.append(replace(op, id=called[op.id], after=tuple(after)))
        assert schedule(others) == schedule(operations)


def test_a_frame_in_the_dark_is_taken_once_an_arm_that_stood_out_has_parked() -> None:
    setup = load_folder(labs_dir() / "shel").require()[0]
    values = {"shutter": ObservedValue(value="open"), "emission": ObservedValue(value=False)}
    parts = {
        name: ObservedComponent(
            pose=Pose(100, 100), values={t: v for t, v in values.items() if t in setup.type_of(name).tunables}
        )
        for name in setup.lab.inventory
    }
    seen = Observation(backend="sim", components=parts, robots={"arm1": ObservedRobot(joints=(0.3,) * 7)})
    made = schedule(surveying(setup, seen, [], ["cam"], None))
    assert [op.primitive for op in made] == ["park", "set", "measure", "set"]
    assert [op.id in made[2].after for op in made] == [True, True, False, False]
