"""Several arms: what is done at the same time, what waits, and how near to the least time that is."""

from __future__ import annotations

import random
from dataclasses import replace
from importlib.util import find_spec
from itertools import permutations
from typing import Any

import pytest
from oracles.proven import prove, read_work

from pico.diagnostics import PicoError
from pico.model.record import as_json
from pico.planning.ordering import arm_times
from pico.planning.ordering.arm_times import ArmWork, least, soonest, timed

SEEDS = range(12)


def some_work(seed: int, count: int = 6) -> ArmWork:
    """Two arms beside a strip in the middle that both reach; straight ways, times in s."""
    rnd = random.Random(seed)
    arm = tuple(rnd.randrange(2) for _ in range(count))
    picks, places = ([(rnd.uniform(0, 4), rnd.uniform(0, 4)) for _ in range(count)] for _ in range(2))
    rests, before = ((0.0, 2.0), (4.0, 2.0)), list[frozenset[int]]()
    for j in range(count):
        direct = frozenset(e for e in range(j) if rnd.random() < 0.15)
        before.append(direct.union(*(before[e] for e in direct)))

    def way(a: tuple[float, float], b: tuple[float, float]) -> float:
        return round(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5, 3)

    def zones(place: tuple[float, float]) -> frozenset[int]:
        return frozenset({0} if 1.3 < place[0] < 2.7 else ())

    begin = tuple(way(rests[a], p) for a, p in zip(arm, picks, strict=True))
    return ArmWork(
        arms=2, arm=arm, loaded=tuple(round(rnd.uniform(3, 6), 3) for _ in arm), start=begin, again=begin,
        between=tuple(tuple(way(q, p) if a == b else 0.0 for p, b in zip(picks, arm, strict=True))
                      for q, a in zip(places, arm, strict=True)),
        end=tuple(way(p, rests[a]) for a, p in zip(arm, places, strict=True)), before=tuple(before),
        enters=tuple(zones(p) | zones(q) for p, q in zip(picks, places, strict=True)),
        stays=tuple(zones(q) for q in places), zones=((0, 1),),
    )  # fmt: skip


def orders(work: ArmWork) -> list[tuple[int, ...]]:
    moves = range(len(work.arm))
    return [p for p in permutations(moves) if all(p.index(e) < p.index(j) for j in moves for e in work.before[j])]


def tours(work: ArmWork) -> list[float]:
    """What each arm needs at least for its moves alone, by trying all orders."""
    return [
        min(timed(alone(work, order), range(len(order)))[0] for order in permutations(work.of(arm)))
        for arm in range(work.arms)
    ]


def alone(work: ArmWork, order: tuple[int, ...]) -> ArmWork:
    """These moves, in this order, with nothing to wait for and nobody to meet."""
    none = (frozenset[int](),) * len(order)
    return ArmWork(
        arms=2, arm=tuple(work.arm[j] for j in order), loaded=tuple(work.loaded[j] for j in order),
        start=tuple(work.start[j] for j in order), again=tuple(work.again[j] for j in order),
        between=tuple(tuple(work.between[i][j] for j in order) for i in order),
        end=tuple(work.end[j] for j in order), before=none, enters=none, stays=none, zones=(),
    )  # fmt: skip


@pytest.mark.parametrize("seed", SEEDS)
def test_no_order_is_done_before_the_one_found_nor_before_the_bound(seed: int) -> None:
    work = some_work(seed)
    best = min(timed(work, order)[0] for order in orders(work))
    found = soonest(work, orders(work)[0])
    assert timed(work, found)[0] == pytest.approx(best)
    assert least(work, tours(work), {}) <= best + 1e-9


@pytest.mark.parametrize("seed", SEEDS)
def test_the_order_found_is_always_the_same_and_keeps_what_comes_before(seed: int) -> None:
    work = some_work(seed, 14)
    found = soonest(work, range(14))
    assert found == soonest(work, range(14))
    assert all(found.index(e) < found.index(j) for j in range(14) for e in work.before[j])
    assert timed(work, found) <= timed(work, range(14))


@pytest.mark.parametrize("seed", range(4))
def test_of_few_moves_each_order_is_timed_once_and_the_search_ends(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    work, asked, looked = some_work(seed, 4), list[tuple[int, ...]](), [0]
    monkeypatch.setattr(arm_times, "timed", lambda w, order: asked.append(tuple(order)) or timed(w, order))
    shifts = arm_times._shifts

    def counted(*given: Any) -> Any:
        looked[0] += 1
        return shifts(*given)

    monkeypatch.setattr(arm_times, "_shifts", counted)
    found = soonest(work, next(iter(orders(work))))
    assert timed(work, found)[0] == min(timed(work, order)[0] for order in orders(work))
    assert set(asked) == set(orders(work)) and len(asked) < 2 * len(orders(work)) + 40 and looked[0] < 200


def test_moves_that_all_wait_for_one_another_in_a_row_keep_their_only_order() -> None:
    row = replace(some_work(0, 4), before=tuple(frozenset(range(j)) for j in range(4)))
    assert soonest(row, range(4)) == (0, 1, 2, 3)


def test_an_arm_that_stands_in_a_zone_parks_before_the_other_comes_in() -> None:
    """Way 1 s, work 4 s, park 2 s; then the other one: way 1 s, work 4 s, park 3 s."""
    inside = frozenset({0})
    work = ArmWork(
        arms=2, arm=(0, 1), loaded=(4.0, 4.0), start=(1.0, 1.0), again=(1.0, 1.0), between=((0.0, 0.0), (0.0, 0.0)),
        end=(2.0, 3.0), before=(frozenset(), frozenset()), enters=(inside, inside), stays=(inside, inside),
        zones=((0, 1),),
    )  # fmt: skip
    assert timed(work, (0, 1))[0] == pytest.approx(15.0)
    assert timed(work, (1, 0))[0] == pytest.approx(15.0)


def test_work_survives_json() -> None:
    import json

    work = some_work(3)
    assert read_work(json.dumps(as_json(work))) == work


@pytest.mark.skipif(find_spec("ortools") is None, reason="needs pico-lab[ortools]")
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_proven_optimum_is_that_of_all_orders(seed: int) -> None:
    work = some_work(seed, 5)
    proof = prove(work)
    assert proof.proven
    assert proof.makespan == pytest.approx(min(timed(work, order)[0] for order in orders(work)), abs=1e-3)


@pytest.mark.skipif(find_spec("ortools") is not None, reason="OR-Tools is here")
def test_a_missing_extra_names_itself() -> None:
    with pytest.raises(PicoError, match=r"pico-lab\[ortools\]"):
        prove(some_work(0))
