"""A folder whose `pico gui` was killed: commands work in it, what was before is put back, and the next one opens. One
that is told to end halts what goes on at its desk first."""

from __future__ import annotations

import http.client
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at

from pico.edge.link import place
from pico.edge.network.remotes import Remote, Remotes, keep, known

PICO = [sys.executable, "-m", "pico_cli"]


@dataclass(frozen=True)
class Gui:
    """`pico gui`, and what it asks of a browser."""

    process: subprocess.Popen[str]
    address: str

    def ask(self, path: str, body: Any, **sent: str) -> http.client.HTTPResponse:
        """Return the answer of a POST."""
        at, _, _ = self.address.partition("/#")
        link = http.client.HTTPConnection(at.removeprefix("http://"), timeout=60)
        link.request("POST", path, json.dumps(body), {"content-type": "application/json", "origin": at, **sent})
        return link.getresponse()


@contextmanager
def opened(lab: Path, environment: dict[str, str], *more: str) -> Iterator[Gui]:
    """Run `pico gui` until it has told its address; ended where nobody else does."""
    going = subprocess.Popen(
        [*PICO, "-C", lab, "--json", "gui", "--no-open", *more], env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
    )  # fmt: skip
    try:
        assert going.stdout is not None and going.stderr is not None
        line = going.stdout.readline()
        assert line, going.stderr.read()
        address = json.loads(line)["address"]
        assert address.startswith("http://127.0.0.1:")
        yield Gui(going, address)
    finally:
        going.terminate()
        going.communicate(timeout=60)


@pytest.mark.slow
def test_a_killed_page_leaves_the_folder_in_order(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CONFIG_HOME": str(tmp_path / "config"), "XDG_STATE_HOME": str(tmp_path / "state")}
    lab = tmp_path / "lab"

    def said(*words: str) -> str:
        done = subprocess.run([*PICO, "-C", lab, *words], env=environment, text=True, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    subprocess.run([*PICO, "init", "--example", "shel", lab], env=environment, check=True, capture_output=True)
    keep(lab, before := Remotes({"lab": Remote("https://lab.example")}))
    with opened(lab, environment) as page:
        assert known(lab).page == ("sim", "shel/bench1")
        page.process.send_signal(signal.SIGKILL)
        page.process.wait()
        assert "live (sim)" in said("status")
    assert known(lab) == before
    until = time.monotonic() + 60
    while place.find(bench_at(lab)) is not None:
        assert time.monotonic() < until, "the edge goes on without its coordinator"
        time.sleep(0.1)
    said("sim", "nudge", "hwp", "--dx", "1")  # the bench is its folder's own
    with opened(lab, environment):
        assert "live (sim)" in said("status")
    assert known(lab) == before and not (lab / ".pico/benches/sim/enrolment.json").exists()


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP], ids=["term", "hup"])
def test_a_page_that_is_told_to_end_halts_the_run_at_its_desk(tmp_path: Path, number: signal.Signals) -> None:
    environment = os.environ | {"XDG_CONFIG_HOME": str(tmp_path / "config"), "XDG_STATE_HOME": str(tmp_path / "state")}
    lab = tmp_path / "lab"
    subprocess.run([*PICO, "init", "--example", "shel", lab], env=environment, check=True, capture_output=True)
    with opened(lab, environment, "--fidelity", "physics") as page:  # slow enough to be interrupted
        let_in = page.ask("/api/session", {"code": page.address.partition("#code=")[2]})
        cookie = str(let_in.getheader("set-cookie")).partition(";")[0]
        asked = {"words": ["E1-1", "-y"], "session": "s1", "bench": "bench1"}
        answer, said = page.ask("/api/labs/shel/desk/apply", asked, cookie=cookie), list[dict[str, Any]]()
        told = False
        while line := answer.readline():
            said.append(json.loads(line))
            if said[-1].get("kind") == "operation_started" and not told:
                page.process.send_signal(number)
                told = True
        page.process.wait(60)
    assert page.process.returncode == 0 and said[-1]["exit"] == 130
    (report,) = [one for one in said if one.get("schema") == "pico.report/v1"]
    assert report["outcome"] == "interrupted" and report["skipped"] > 0
