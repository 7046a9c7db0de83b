"""What the choice of a trial reckons with, beside what plans then take; and which commits are one to a bench."""

from __future__ import annotations

from dataclasses import replace

import pytest

from pico.bench.bench import Bench
from pico.bench.bisecting import configurations
from pico.bench.bisecting.configurations import Configurations
from pico.bench.bisecting.costs import PlanSeconds, leaves
from pico.history.examples.example import make_example
from pico.model.state import ComponentState, LabState


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("bisecting") / "shel"
    make_example("shel", folder)
    return Bench.open(folder, fidelity="kinematic")


@pytest.mark.parametrize("revision", ["C2", "C3", "E1-3", "E2-3", "e1"])
def test_the_estimate_is_near_to_the_plan(bench: Bench, revision: str) -> None:
    about = PlanSeconds(bench.setup).to(bench.observe(), bench.state_at(revision))
    assert about == pytest.approx(bench.plan(revision).makespan, rel=0.25, abs=1.0)


def test_from_state_to_state_it_is_as_from_the_bench_that_stands_so(bench: Bench) -> None:
    clock, at_home = PlanSeconds(bench.setup), bench.state_at("C1")
    goal = bench.state_at("E1-3")
    a, b = leaves(bench.setup, at_home), leaves(bench.setup, goal)
    assert clock.between(a, a) == 0.0
    assert clock.between(a, b) == pytest.approx(clock.between(b, a), rel=0.2)
    assert clock.between(a, b) > 5.0


def test_motors_turn_beside_the_arm(bench: Bench) -> None:
    clock, state = PlanSeconds(bench.setup), bench.state_at("C3")

    def turned(by: float, x: float) -> LabState:
        p1 = state.components["p1"]
        assert p1.pose is not None
        moved = replace(p1, pose=replace(p1.pose, x=p1.pose.x + x), values={**p1.values, "angle": 90.0 - by})
        return replace(state, components={**state.components, "p1": moved})

    here = leaves(bench.setup, state)
    one, both, slow = (clock.between(here, leaves(bench.setup, turned(*t))) for t in ((5, 0), (5, 40), (80, 0)))
    assert 0 < one < slow and both == pytest.approx(clock.between(here, leaves(bench.setup, turned(0, 40))))


def test_what_a_state_leaves_out_is_at_home(bench: Bench) -> None:
    state = bench.state_at("C1")
    bare = replace(state, components={n: p for n, p in state.components.items() if not n.startswith("l")})
    home = {n: ComponentState(slot=part.home) for n, part in bench.setup.lab.inventory.items() if part.home}
    named = replace(bare, components={**home, **bare.components})
    assert leaves(bench.setup, bare) == leaves(bench.setup, named)


def test_of_a_long_line_of_history_some_commits_are_read_and_none_that_was_skipped(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    monkeypatch.setattr(configurations, "READ", 10)
    some = Configurations(bench.folder, bench.setup)
    line = [(str(n), (str(n - 1),)) for n in range(101)]
    thin = some.thinned(line, {"90"})
    names = [name for name, _ in thin]
    assert len(names) <= 10 and names[-1] == "100" and "90" not in names
    assert [parents for _, parents in thin] == [(), *((name,) for name in names[:-1])]
    branched = [*line, ("101", ("100", "40"))]
    assert some.thinned(branched, ()) == branched


def test_only_what_changed_something_is_worth_a_trial(bench: Bench) -> None:
    some = Configurations(bench.folder, bench.setup)
    ids = {name: bench.folder.history().resolve(name).id for name in ("C1", "C2", "C3")}
    line = [(ids["C1"], ()), (ids["C2"], (ids["C1"],)), (ids["C3"], (ids["C2"],))]
    found = some.suspects(line, frozenset(), {"p2"}, 10.0)
    assert found.testable == {0, 1} and found.weight == [1.0, 0.1, 1.0]
    assert some.suspects([*line, ("0" * 40, (ids["C3"],))], frozenset()).testable == {0, 1, 2}
    assert "0" * 40 in some.unreadable
