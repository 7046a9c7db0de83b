"""`pico lease lock` and `pico lease unlock` as they are typed."""

from __future__ import annotations

import subprocess
from pathlib import Path

from commanding import Pico


def test_a_person_locks_the_bench_and_takes_the_lock_off(shel: Path, pico: Pico) -> None:
    subprocess.run(["git", "config", "user.name", "Ada Lovelace"], cwd=shel, check=True)
    locked = pico("lease", "lock", "--reason", "mirrors are being cleaned")
    assert locked.code == 0 and "mirrors are being cleaned" in locked.out
    said = pico("status")
    assert "warning[table-lock]" in said.err and "pico lease unlock" in said.err
    assert pico("lease", "unlock").code == 0
    assert "not locked" in pico("lease", "unlock").out and "table-lock" not in pico("status").err


def test_no_remote_client_locks_or_unlocks(shel: Path, pico: Pico) -> None:
    for word in ("lock", "unlock"):
        refused = pico("--bench", "pico://127.0.0.1:9/shel/bench1", "lease", word)
        assert refused.code == 7 and "only a person at the table" in refused.err
