"""Simulated time: one clock for all, the same order each time."""

from __future__ import annotations

import asyncio
from collections.abc import Generator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.backends.sim.timeline import Timeline, natural

Work = Generator[float, None, float]


def test_operations_share_the_time_that_passes() -> None:
    passed: list[float] = []
    told: list[tuple[str, float]] = []

    def work(name: str, *waits: float) -> Work:
        for wait in waits:
            yield wait
            told.append((name, line.now))
        return line.now

    line: Timeline[float] = Timeline(10.0, passed.append)

    async def go() -> list[float]:
        return await asyncio.gather(line.start("op10", work("op10", 1, 2)), line.start("op2", work("op2", 3)))

    assert asyncio.run(go()) == [13.0, 13.0]
    assert told == [("op10", 11.0), ("op2", 13.0), ("op10", 13.0)]
    assert passed == [1.0, 2.0]


def test_what_follows_an_end_starts_at_that_moment() -> None:
    line: Timeline[float] = Timeline(0.0, lambda _: None)

    def work(wait: float) -> Work:
        begun = line.now
        yield wait
        return begun

    async def chain() -> list[float]:
        return [await asyncio.shield(line.start(f"a{n}", work(1.0))) for n in range(5)]

    async def go() -> tuple[list[float], float]:
        long = line.start("long", work(10.0))
        return await asyncio.create_task(chain()), await long

    assert asyncio.run(go())[0] == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_an_error_is_that_of_its_operation_alone_and_one_of_the_world_is_everybodys() -> None:
    def fails() -> Work:
        yield 1.0
        raise ValueError("mine")

    def goes_on() -> Work:
        yield 2.0
        return 1.0

    def explode(seconds: float) -> None:
        raise RuntimeError("the world")

    async def go(line: Timeline[float]) -> list[object]:
        return await asyncio.gather(line.start("a", fails()), line.start("b", goes_on()), return_exceptions=True)

    assert [repr(r) for r in asyncio.run(go(Timeline(0.0, lambda _: None)))] == ["ValueError('mine')", "1.0"]
    assert [repr(r) for r in asyncio.run(go(Timeline(0.0, explode)))] == ["RuntimeError('the world')"] * 2


def test_an_interruption_reaches_what_is_under_way_where_it_is() -> None:
    line: Timeline[float] = Timeline(0.0, lambda _: None)

    def work() -> Work:
        try:
            while True:
                yield 1.0
        except TimeoutError:
            return line.now

    async def go() -> float:
        future = line.start("a", work())
        while line.now < 3:
            await asyncio.sleep(0)
        line.interrupt(TimeoutError())
        await line.idle()
        return await future

    assert asyncio.run(go()) == pytest.approx(3.0)


@given(st.lists(st.integers(1, 10**6), unique=True, max_size=20))
def test_ids_sort_by_their_numbers(numbers: list[int]) -> None:
    assert sorted((f"op{n}" for n in numbers), key=natural) == [f"op{n}" for n in sorted(numbers)]
