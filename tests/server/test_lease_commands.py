"""Remotes, logging in, and the lease of a bench, as a person says it at the command line."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from commanding import Pico
from coordinators import BENCH, Served

from pico.diagnostics import ExitCode, PicoError
from pico.edge.network import holding as holding_
from pico.edge.network.holding import Holding
from pico.edge.network.meant import named_bench
from pico.edge.network.remotes import known
from pico.edge.network.tokens import token_of
from pico.history.examples.example import init_empty

RIGHTS = ("operator@shel", "lease:steal@shel")


@contextmanager
def fencing(coordinator: Served) -> Iterator[None]:
    """Fence meanwhile for whoever gets the bench, as its edge does."""
    over = threading.Event()

    def fence() -> None:
        while not over.wait(0.02):
            row, _, _ = coordinator.books.leases.shown(BENCH)
            if row.grant is not None and not row.grant.fenced:
                coordinator.books.leases.heard(BENCH, row.grant.token)

    thread = threading.Thread(target=fence)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@pytest.fixture
def lab(coordinator: Served, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico) -> Iterator[Path]:
    """A checkout of ann's that knows the coordinator, as the current directory, and a bench at that."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.delenv("PICO_TOKEN", raising=False)
    coordinator.bench()
    init_empty(tmp_path / "lab")
    monkeypatch.chdir(tmp_path / "lab")
    with fencing(coordinator):
        assert pico("remote", "add", "lab", f"http://127.0.0.1:{coordinator.port}").code == 0
        yield tmp_path / "lab"


def logged_in(coordinator: Served, pico: Pico, monkeypatch: pytest.MonkeyPatch, *rights: str) -> None:
    import io

    monkeypatch.setattr(sys, "stdin", io.StringIO(coordinator.person("ann", *rights) + "\n"))
    answer = pico("login", "lab")
    assert answer.code == 0 and "You are ann at" in answer.out, answer.err


@pytest.fixture(autouse=True)
def asked_often(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody tells this coordinator's clients that the bench is fenced."""
    monkeypatch.setattr(holding_, "SLICE", 0.1)


def holding(lab: Path) -> Holding:
    far = named_bench(lab, known(lab), BENCH)
    assert far is not None
    return Holding(far)


def test_from_a_code_to_the_bench_that_commands_mean(coordinator: Served, lab: Path, pico: Pico) -> None:
    asked = pico("bench", "list")
    assert asked.code == ExitCode.DONE and "Benches of this machine" in asked.out and "`pico login" in asked.err
    coordinator.books.people.settled("ann", [], by="test")
    code = coordinator.books.people.issued("ann", 60.0, by="test", kind="code").secret
    assert "You are ann" in pico("login", "lab", "--code", code).out
    assert token_of(f"http://127.0.0.1:{coordinator.port}")
    again = pico("login", "lab", "--code", code)
    assert again.code == ExitCode.DENIED and "does not take this code" in again.err
    assert "No benches of coordinators" in pico("bench", "list").out
    assert pico("remote", "add", "gone", "http://127.0.0.1:9").code == 0  # the others are listed all the same
    listed = pico("bench", "list")
    assert listed.code == 0 and "http://127.0.0.1:9 does not answer" in listed.err
    assert pico("remote", "remove", "gone").code == 0
    coordinator.person("ann", "viewer@shel")
    listed = pico("--json", "bench", "list").data
    assert [(b["remote"], b["bench"], b["holder"]) for b in listed["benches"]] == [("lab", BENCH, None)]
    assert "now mean shel/bench1" in pico("bench", "use", BENCH).out
    assert "a token is kept" in pico("remote", "list").out
    assert pico("--json", "bench", "list").data["meant"] == f"lab/{BENCH}"
    assert "now mean sim" in pico("bench", "use", "local").out
    assert "the bench `sim` is on this machine: it needs no lease" in pico("lease", "show").err


def test_who_has_the_bench_is_shown_and_only_they_give_it_back(
    coordinator: Served, lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    logged_in(coordinator, pico, monkeypatch, *RIGHTS)
    pico("bench", "use", BENCH)
    assert pico("lease", "show").out.strip() == f"Nobody has {BENCH}."
    token = holding(lab).take()
    assert "This checkout has shel/bench1 since" in pico("lease", "show").out
    assert next(holding(lab).renewed(token)) is None
    assert "is given back" in pico("lease", "release").out
    bob = coordinator.person("bob", *RIGHTS)
    at = f"/api/benches/{BENCH}/lease"
    while coordinator.ask("POST", at, bob, {"session": "b", "wait": 0.05})[0] != 200:  # until it is fenced
        pass
    assert "bob has shel/bench1 since just now" in pico("lease", "show").out
    refused = pico("lease", "release")
    assert refused.code == ExitCode.LOCKED and "pico lease steal --reason" in refused.err
    with pytest.raises(PicoError, match="bob has shel/bench1") as caught:
        holding(lab).take()
    assert caught.value.exit_code == ExitCode.LOCKED and not pico("--json", "lease", "show").data["waiting"]
    stolen = holding(lab).steal("the cell is boiling")
    assert stolen > token and pico("--json", "lease", "show").data["mine"]
    status, told = coordinator.ask("PUT", at, bob, {"session": "b", "token": stolen - 1})
    assert status == 409 and "(ann: the cell is boiling); ann has it now" in told["error"][0]["summary"]
    assert "taken over with a reason" in pico("lease", "steal", "--reason", " ", "-y").err


def test_who_logs_in_after_somebody_else_in_their_checkout_does_not_have_what_they_have(
    coordinator: Served, lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    logged_in(coordinator, pico, monkeypatch, *RIGHTS)
    pico("bench", "use", BENCH)
    holding(lab).take()
    monkeypatch.setenv("PICO_TOKEN", coordinator.person("bob", *RIGHTS))
    assert "ann has shel/bench1" in pico("lease", "show").out
    assert not pico("--json", "lease", "show").data["mine"]
    assert pico("lease", "release").code == ExitCode.LOCKED
    monkeypatch.delenv("PICO_TOKEN")
    monkeypatch.setenv("PICO_TOKEN", "of-somebody-whose-token-is-over")
    assert "PICO_TOKEN is set" in pico("lease", "show").err
    monkeypatch.delenv("PICO_TOKEN")
    assert pico("--json", "lease", "show").data["mine"] and "is given back" in pico("lease", "release").out


@pytest.mark.slow
def test_a_lease_is_had_until_ctrl_c(
    coordinator: Served, lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    logged_in(coordinator, pico, monkeypatch, *RIGHTS)
    words = [sys.executable, "-m", "pico_cli", "--bench", BENCH, "--json", "lease", "take", "--wait", "5"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=dict(os.environ)) as process:
        assert process.stdout is not None
        assert json.loads(process.stdout.readline())["mine"]
        assert pico("--json", "--bench", BENCH, "lease", "show").data["mine"]
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == 0
    assert pico("--json", "--bench", BENCH, "lease", "show").data["holder"] is None
