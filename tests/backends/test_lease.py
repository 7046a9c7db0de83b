"""One mover at a time, also among processes; a dead one holds nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from bench_at import bench_at

from pico.diagnostics import ExitCode, PicoError
from pico.edge.lease import BenchLock

HOLD = """
import sys
from pathlib import Path
from pico.edge.lease import BenchLock
from pico.places.bench import BenchPlace
lease = BenchLock(BenchPlace(Path(sys.argv[1]), "sim")).acquire("pico apply e1")
print(lease.token, flush=True)
sys.stdin.read()
"""


def holder(root: Path) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(root)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline().strip() == "1"
    return process


def test_a_second_process_is_told_who_has_the_bench_and_gets_it_when_that_one_is_killed(tmp_path: Path) -> None:
    process = holder(tmp_path)
    try:
        with pytest.raises(PicoError) as caught:
            BenchLock(bench_at(tmp_path)).acquire("pico apply e2")
        assert caught.value.exit_code == ExitCode.LOCKED
        summary = caught.value.diagnostics[0].summary
        assert f"process {process.pid}" in summary
        assert "pico apply e1" in summary
    finally:
        process.kill()
        process.communicate()
    assert BenchLock(bench_at(tmp_path)).acquire("pico apply e2").token == 2


def test_tokens_increase_from_lease_to_lease(tmp_path: Path) -> None:
    tokens = []
    for _ in range(12):
        with BenchLock(bench_at(tmp_path)).held("test") as lease:
            tokens.append(lease.token)
    assert tokens == list(range(1, 13))


def test_a_lock_is_not_taken_twice_in_one_process_either(tmp_path: Path) -> None:
    first, second = BenchLock(bench_at(tmp_path)), BenchLock(bench_at(tmp_path))
    first.acquire("one")
    for lock in (first, second):
        with pytest.raises(PicoError, match="one"):
            lock.acquire("two")
    first.release()
    second.acquire("two")
    second.release()


@pytest.mark.skipif(os.geteuid() == 0, reason="root writes everywhere")
def test_a_folder_that_cannot_be_written_is_a_diagnostic(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(PicoError, match="cannot be locked"):
        BenchLock(bench_at(tmp_path)).acquire("test")


def test_a_file_in_the_way_is_a_diagnostic(tmp_path: Path) -> None:
    (tmp_path / ".pico").write_text("")
    with pytest.raises(PicoError, match="cannot be locked"):
        BenchLock(bench_at(tmp_path)).acquire("test")


def test_what_a_killed_mover_was_writing_is_cleared_by_whoever_takes_the_bench_next(tmp_path: Path) -> None:
    process = holder(tmp_path)
    process.kill()
    process.communicate()
    for number in (process.pid, os.getpid()):
        (tmp_path / ".pico/benches/sim" / f".memory.json.{number}.tmp").touch()
    with BenchLock(bench_at(tmp_path)).held("test"):
        assert [p.name for p in (tmp_path / ".pico/benches/sim").glob("*.tmp")] == [f".memory.json.{os.getpid()}.tmp"]
