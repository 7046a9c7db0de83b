"""`pico edge`: a process that has the bench, and commands of others that reach it."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from commanding import Pico

from pico.edge.link import place

DEVICES = Path(__file__).resolve().parents[2] / "examples" / "devices.yaml"
EMULATED = ("--backend", "hardware", "--emulate")


@contextmanager
def served(root: Path, *words: str) -> Iterator[tuple[subprocess.Popen[str], Any]]:
    """Serve a lab by the command; yields its process and what it said."""
    command = [sys.executable, "-m", "pico_cli", "--json", *words, "edge"]
    process = subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        if not line:
            pytest.fail(process.communicate(timeout=60)[1])
        yield process, json.loads(line)
    finally:
        process.kill()
        process.communicate(timeout=60)


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_another_process_reaches_it_until_it_is_ended(shel: Path, pico: Pico, how: signal.Signals) -> None:
    with served(shel) as (process, said):
        assert (said["lab"], said["backend"], said["devices"]) == ("shel", "sim", {})
        assert Path(said["socket"]).is_socket() and place.find(bench_at(shel)) == Path(said["socket"])
        assert pico("set", "p1", "angle=7", "-y").code == 0
        holder = json.loads((shel / ".pico/benches/sim" / "edge.json").read_text())
        assert holder["pid"] == process.pid
        process.send_signal(how)
        assert process.wait(60) == 0 and place.find(bench_at(shel)) is None
    assert "7" in pico("get", "p1.angle").out, "the bench is as it was left"


@pytest.mark.slow
@pytest.mark.skipif(not (find_spec("xarm") and find_spec("ElliptecBus")), reason="the extras xarm and thorlabs")
def test_a_whole_emulated_bench_is_brought_up_and_only_who_means_it_reaches_it(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copy(DEVICES, shel)
    monkeypatch.setenv("PICO_EMULATED_PACE", "10")
    with served(shel, *EMULATED) as (process, said):
        assert said["backend"] == "emulated" and len(said["devices"]) == 15
        hosts = {one["address"]["host"] for one in said["devices"].values() if "host" in one["address"]}
        assert all(host.startswith("127.") for host in hosts)
        assert pico("--json", "plan").data["backend"] == "sim", "the simulator is a bench of its own"
        done = pico(*EMULATED, "set", "p1", "angle=7", "-y")
        assert done.code == 0, done.out + done.err
        read = pico(*EMULATED, "--json", "get", "p1.angle").data["values"]["angle"]
        assert read["value"] == pytest.approx(7, abs=0.01)
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 0
    assert (shel / ".pico/benches/emulated" / "world.json").exists()
