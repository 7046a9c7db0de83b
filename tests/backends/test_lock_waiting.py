"""Who may wait for the bench gets it as soon as it is free; who asks for the holder is in nobody's way."""

from __future__ import annotations

import asyncio
import threading
from pathlib import Path

import pytest
from bench_at import bench_at

from pico.diagnostics import ExitCode, PicoError
from pico.edge.lease import BenchLock, wait_until_free


def test_who_waits_takes_the_lock_once_it_is_free(tmp_path: Path) -> None:
    first, second = BenchLock(bench_at(tmp_path)), BenchLock(bench_at(tmp_path))
    first.acquire("one")

    async def take() -> int:
        asyncio.get_running_loop().call_later(0.1, first.release)
        return (await second.acquire_within("two", 60.0, lambda: False)).token

    assert asyncio.run(take()) == 2
    second.release()


@pytest.mark.parametrize("seconds", [0.0, 0.1])
def test_waiting_ends_with_who_has_it(tmp_path: Path, seconds: float) -> None:
    first, second = BenchLock(bench_at(tmp_path)), BenchLock(bench_at(tmp_path))
    with first.held("pico apply e1"):
        for waiting in (
            second.acquire_within("two", seconds, lambda: False),
            wait_until_free(BenchLock(bench_at(tmp_path)).holder, seconds),
        ):
            with pytest.raises(PicoError, match="pico apply e1") as caught:
                asyncio.run(waiting)
            assert caught.value.exit_code == ExitCode.LOCKED
    asyncio.run(wait_until_free(BenchLock(bench_at(tmp_path)).holder, 0.0))


def test_waiting_can_be_given_up(tmp_path: Path) -> None:
    with BenchLock(bench_at(tmp_path)).held("one"), pytest.raises(PicoError) as caught:
        asyncio.run(BenchLock(bench_at(tmp_path)).acquire_within("two", 60.0, lambda: True))
    assert caught.value.exit_code == ExitCode.INTERRUPTED


def test_asking_for_the_holder_keeps_nobody_from_taking_the_bench(tmp_path: Path) -> None:
    lock, over = BenchLock(bench_at(tmp_path)), threading.Event()
    lock.acquire("warm up")
    lock.release()

    def ask() -> None:
        while not over.is_set():
            BenchLock(bench_at(tmp_path)).holder()

    asking = threading.Thread(target=ask)
    asking.start()
    try:
        for _ in range(200):
            lock.acquire("mover")
            lock.release()
    finally:
        over.set()
        asking.join()
