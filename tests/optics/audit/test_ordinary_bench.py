"""The bench that everybody builds: an open HeNe of 2 mW, two mirrors of the catalog, a fiber. It is no hazard up to
class 3R, also while it is aligned, and it is aligned from the dark."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from pico.bench.ready.registry import made_ready
from pico.diagnostics import Diagnostic
from pico.manifest.catalog import load_catalog
from pico.manifest.load import Manifests, load_files
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.record import as_json
from pico.model.state import place_of
from pico.optics.audit.state import check_light
from pico.planning.asked import Ready
from pico.planning.nominal import REACH
from pico.planning.sought import stages
from pico.policy.audit import audit_of, told_of

LAB = Path(__file__).resolve().parents[2] / "labs" / "fiber"
MIRRORS = ("m1.tip", "m1.tilt", "m2.tip", "m2.tilt")
OFF = {"m1.tip": 3.0, "m1.tilt": -0.8, "m2.tip": -2.5, "m2.tilt": 0.7}


@cache
def bench(power: float = 2.0, angles: str = ", tip: 0, tilt: 0") -> Manifests:
    """Return the fiber bench with steering mirrors of the catalog, nothing around it, and a laser of a power [mW];
    `angles`: what its state says of those of the mirrors."""
    files = {str(path.relative_to(LAB)): path.read_bytes() for path in sorted(LAB.rglob("*.yaml"))}
    text = files["lab.yaml"].decode()
    for old, new in (
        ("  enclosed: true\n", ""),
        ("type: steering_mirror", "type: mirror_tip_tilt"),
        ("    type: hene_laser\n", f"    type: hene_laser\n    parameters: {{power: {power}}}\n"),
    ):
        assert old in text
        text = text.replace(old, new)
    state = files["state/table.yaml"].decode().replace(", tip: 0, tilt: 0", angles)
    return load_files({**files, "lab.yaml": text.encode(), "state/table.yaml": state.encode()}, [], root="fiber")


def seen(read: Manifests, mirrors: Mapping[str, float] | None = None) -> Observation:
    """Return the bench as its manifest wants it, mirrors set to values."""
    setup, state = read.require()
    values = {name: dict(part.values) for name, part in state.components.items()}
    for address, value in (mirrors or {}).items():
        component, _, tunable = address.partition(".")
        values[component][tunable] = value
    return Observation(backend="sim", components={
        name: ObservedComponent(
            pose=place_of(setup, state, name)[1],
            values={k: ObservedValue(value=v) for k, v in values.get(name, {}).items()},
        ) for name in setup.lab.inventory
    })  # fmt: skip


def search(read: Manifests, mirrors: Mapping[str, float] | None = None) -> tuple[Ready, tuple[Diagnostic, ...]]:
    """Return the ready-made goal of the fiber, and what the audit says of a plan that seeks it."""
    setup, _ = read.require()
    here = seen(read, mirrors)
    ready = made_ready(setup, here, ["fiber", "fc"])
    op = Operation(
        id="op1", primitive="optimize", component="fc", reason=Reason(kind="asked"),
        arguments={"goal": "fiber fc", "what": {"tunables": as_json(ready.goal.tunables)}},
    )  # fmt: skip
    plan = Plan(lab=LabRef(name="fiber", digest=""), backend="sim", fidelity="kinematic", base=Base(),
                target=Target(), operations=(op,))  # fmt: skip
    return ready, told_of(plan, *audit_of(setup, plan, here))


@pytest.mark.parametrize("angles", [", tip: 0, tilt: 0", ""])
def test_the_manifest_is_valid_up_to_class_3r_and_not_above(angles: str) -> None:
    assert [d.code for d in check_light(bench(2.0, angles))] == ["damage-threshold"]
    strong = [d for d in check_light(bench(6.0, angles)) if d.severity == "error"]
    assert any("m1 → may leave the plane of the table" in d.summary for d in strong)


def test_a_mirror_that_a_person_turns_is_not_searched() -> None:
    setup, _ = bench().require()
    kinds = {**setup.catalog, "pickoff": replace(load_catalog()["mirror_flip"], name="pickoff")}
    by_hand = replace(setup, catalog=kinds)
    found = made_ready(by_hand, seen(bench()), ["fiber", "fc"])
    assert set(found.goal.tunables) == set(MIRRORS)


def test_a_search_without_bounds_is_let_through_up_to_class_3r_and_refused_once_above() -> None:
    ready, told = search(bench())
    assert set(ready.goal.tunables) == set(MIRRORS) and not told
    assert all(low <= -REACH and high >= REACH for low, high in ready.goal.tunables.values())
    _, told = search(bench(6.0))
    errors = [d for d in told if d.severity == "error"]
    assert 0 < len(errors) <= 3 and len({d.address for d in errors}) == len(errors)


def test_what_is_searched_lies_around_where_mirrors_stand() -> None:
    ready, told = search(bench(), {"m1.tip": 3.0, "m2.tip": -3.0})
    low, high = ready.goal.tunables["m1.tip"]
    assert low <= 3.0 - REACH and high >= 3.0 + REACH and low < 0 and not told


@pytest.mark.parametrize("words", ["coupling", "fiber fc"])
def test_from_the_dark_the_ray_model_says_where_mirrors_are_set_first(words: str) -> None:
    setup, _ = bench().require()
    goals = setup.lab.goals or {}
    for off, dark in ((OFF, True), ({}, False)):
        here = seen(bench(), off)
        ready = Ready(words, goals[words]) if words in goals else made_ready(setup, here, words.split())
        one, _ = stages(setup, here, ready)
        assert bool(one.aim) is dark
        assert all(abs(value) < 0.3 for value in (one.aim or {}).values()), one.aim
