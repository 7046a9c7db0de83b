"""What devices were told is kept, whichever of their threads tells it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from bench_at import bench_at

from pico.backends.hardware.settings import Settings


def test_threads_that_tell_at_once_lose_nothing(tmp_path: Path) -> None:
    kept = Settings(bench_at(tmp_path, "hardware"))
    with ThreadPoolExecutor(8) as links:
        list(links.map(lambda n: kept.put(f"cam{n % 8}.exposure{n}", n), range(80)))
    again = Settings(bench_at(tmp_path, "hardware"))
    assert [again.get(f"cam{n % 8}.exposure{n}", -1) for n in range(80)] == list(range(80))
