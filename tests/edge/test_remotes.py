"""Coordinators by name, benches of theirs, and tokens: what a checkout and its user keep, and what is no name."""

from __future__ import annotations

import json
import os
import shutil
import stat
from dataclasses import asdict
from pathlib import Path

import pytest
from bench_at import bench_at
from relaying import TOKEN, point, relayed

from pico.bench.bench import Bench
from pico.control.gate import Command, Record
from pico.diagnostics import ExitCode, PicoError
from pico.edge.network import line
from pico.edge.network.enrolment import Enrolment, read_enrolment
from pico.edge.network.kept_gate import KeptGate
from pico.edge.network.meant import meant
from pico.edge.network.own_page import OwnPage
from pico.edge.network.remotes import Far, Remote, Remotes, added, address, keep, known, removed
from pico.edge.network.tokens import keep_token, token_of, tokens_file
from pico.history.examples.example import make_example
from pico.places.choice import write_choice

LAB = Remote("https://lab.example")


@pytest.fixture(autouse=True)
def own_configuration(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.delenv("PICO_TOKEN", raising=False)


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    return make_example("minimal", tmp_path / "lab").root


def test_remotes_are_kept_beside_the_history_and_no_commit_can_bring_one(lab: Path) -> None:
    keep(lab, added(known(lab), "lab", LAB))
    assert known(lab).named == {"lab": LAB}
    assert [p for p in lab.rglob("remotes.json") if ".git" not in p.parts] == []
    (lab / ".pico").mkdir(exist_ok=True)
    (lab / ".pico" / "remotes.json").write_text('{"remotes": {"evil": {"url": "http://evil"}}, "default": "evil/a/b"}')
    assert set(known(lab).named) == {"lab"} and meant(lab) == bench_at(lab)


def test_a_bench_is_meant_by_word_by_default_or_by_address(lab: Path) -> None:
    keep(lab, Remotes({"lab": LAB}))
    write_choice(lab, "lab/shel/bench1")
    found = meant(lab)
    assert isinstance(found, Far) and (found.remote, found.name) == (LAB, "shel/bench1")
    words = ("shel/bench1", "lab/shel/bench1", "pico://lab.example/shel/bench1")
    assert {meant(lab, word=word) for word in words} == {found}
    assert meant(lab, word="local") == meant(lab, word="sim") == meant(lab, backend="sim") == bench_at(lab)
    near = meant(lab, word="pico://127.0.0.1:8700/shel/bench1")
    assert isinstance(near, Far) and near.remote.url == "http://127.0.0.1:8700" and near.folder != found.folder
    keep(lab, added(known(lab), "other", Remote("http://127.0.0.1:1")))
    with pytest.raises(PicoError, match="of which coordinator") as caught:
        meant(lab, word="shel/bench1")
    assert caught.value.diagnostics[0].hint == "`lab/shel/bench1`, `other/shel/bench1`"
    keep(lab, removed(known(lab), "lab"))
    with pytest.raises(PicoError, match="the bench that this worktree chose is unknown") as lost:
        meant(lab)
    assert "`pico bench use sim`" in str(lost.value.diagnostics[0].hint)


@pytest.mark.parametrize("word", ["bench1", "a/b/c/d", "../x/y", "nosuch/shel/bench1", "pico://lab.example/bench1"])
def test_what_names_no_bench_is_said(lab: Path, word: str) -> None:
    keep(lab, Remotes({"lab": LAB}))
    with pytest.raises(PicoError) as caught:
        meant(lab, word=word)
    assert caught.value.diagnostics[0].hint


@pytest.mark.parametrize(
    "url", ["lab.example", "ftp://lab.example", "https://", "https://lab.example/x", "https://a@b"]
)
def test_what_is_no_address_is_said(url: str) -> None:
    with pytest.raises(PicoError, match="is no address of a coordinator"):
        address(url)


HERE = "http://127.0.0.1:1"


def _paged(lab: Path) -> OwnPage:
    """Return the page of a lab, with its bench enrolled there."""
    page = OwnPage(bench_at(lab), HERE)
    (lab / ".pico/benches/sim").mkdir(parents=True, exist_ok=True)
    (lab / ".pico/benches/sim/enrolment.json").write_text(json.dumps(asdict(Enrolment(HERE, "shel/bench1", "00"))))
    page.mean("shel/bench1", "secret")
    return page


def test_while_a_page_is_open_its_bench_is_meant_and_afterwards_the_one_before(lab: Path) -> None:
    keep(lab, before := Remotes({"lab": LAB}))
    page = _paged(lab)
    found = meant(lab)
    assert isinstance(found, Far) and (found.remote.url, token_of(HERE)) == (HERE, "secret")
    assert meant(lab, word="emulated") == bench_at(lab, "emulated"), "the page serves another one"
    with pytest.raises(PicoError, match="another `pico gui` has this bench") as caught:
        OwnPage(bench_at(lab), "http://127.0.0.1:2")
    assert caught.value.exit_code == ExitCode.LOCKED
    page.end()
    assert (known(lab), token_of(HERE), read_enrolment(bench_at(lab))) == (before, None, None)
    assert meant(lab) == bench_at(lab)


def test_a_bench_that_is_chosen_while_a_page_is_open_stays_chosen(lab: Path) -> None:
    page = _paged(lab)
    keep(lab, added(known(lab), "lab", LAB))
    write_choice(lab, "lab/shel/bench2")
    page.end()
    assert known(lab) == Remotes({"lab": LAB}) and meant(lab).name == "shel/bench2"
    page = _paged(lab)
    keep(lab, removed(known(lab), "gui"))
    page.end()
    assert known(lab) == Remotes({"lab": LAB}) and read_enrolment(bench_at(lab)) is None


@pytest.mark.parametrize("word", [None, "local", HERE + "/shel/bench1"])
def test_what_a_killed_page_left_is_put_back_by_who_asks_next(lab: Path, word: str | None) -> None:
    keep(lab, before := Remotes({"lab": LAB}))
    os.close(_paged(lab)._lock)  # as the kernel does
    assert '"gui"' in (lab / ".git/pico/remotes.json").read_text()
    meant(lab, word=word)
    assert (known(lab), token_of(HERE), read_enrolment(bench_at(lab))) == (before, None, None)
    os.close(_paged(lab)._lock)
    _paged(lab).end()
    assert known(lab) == before


def test_a_damaged_file_of_the_gate_is_said_with_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "gate.sqlite").write_text("no database, but a text that is longer than a header of one would be" * 4)
    with pytest.raises(PicoError, match="it is damaged") as told:
        KeptGate(tmp_path / "gate.sqlite")
    assert "gate.sqlite.damaged" in told.value.diagnostics[0].hint


def test_a_gate_that_was_emptied_is_damaged_and_forgets_no_fence_unsaid(tmp_path: Path) -> None:
    path = tmp_path / "gate.sqlite"
    KeptGate(path).close()
    path.write_bytes(b"")
    with pytest.raises(PicoError, match="the file is empty"):
        KeptGate(path)


def test_a_damaged_record_of_the_gate_is_named_and_lets_nothing_through(tmp_path: Path) -> None:
    path = tmp_path / "gate.sqlite"
    gate = KeptGate(path)
    gate.memory(3)
    gate.write(Record(Command(4, 1, "k", "d"), "done", "{}"))
    assert gate.memory(3).fenced == 3
    gate._db.execute("UPDATE commands SET phase = 'begun'")
    with pytest.raises(PicoError, match="command 'k' is damaged") as told:
        gate.memory(3)
    assert f"`mv {path}" in told.value.diagnostics[0].hint
    gate.close()


def test_a_token_is_kept_for_one_user_and_one_coordinator(monkeypatch: pytest.MonkeyPatch) -> None:
    keep_token("https://lab.example/", "secret")
    assert (token_of("https://lab.example"), token_of("https://evil.example")) == ("secret", None)
    assert stat.S_IMODE(tokens_file().stat().st_mode) == 0o600
    monkeypatch.setenv("PICO_TOKEN", " of-a-program\n")
    assert token_of("https://lab.example") == "of-a-program"
    monkeypatch.setenv("PICO_TOKEN", "of a\nprogram")
    with pytest.raises(PicoError, match="PICO_TOKEN holds no token"):
        token_of("https://lab.example")
    monkeypatch.delenv("PICO_TOKEN")
    tokens_file().chmod(0o644)
    with pytest.raises(PicoError, match="others may read"):
        token_of("https://lab.example")


def test_who_is_not_let_in_and_who_finds_nobody_is_told_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shel = make_example("shel", tmp_path / "shel").root
    lab = Path(shutil.copytree(shel, tmp_path / "lab"))
    with relayed(shel) as url:
        point(lab, url)
        with pytest.raises(PicoError, match="does not know who asks") as caught:
            Bench.open(lab)
        assert caught.value.exit_code == ExitCode.DENIED
        assert f"`pico login {url}`" in str(caught.value.diagnostics[0].hint)
        monkeypatch.setenv("PICO_TOKEN", TOKEN)
        point(lab, url, "shel/bench7")
        with pytest.raises(PicoError, match="there is no bench shel/bench7 here"):
            Bench.open(lab)
        point(lab, url)
        with pytest.raises(PicoError, match="is a sim bench, and this is for a hardware one"):
            Bench.open(lab, bench="shel/bench1", backend="hardware")
    monkeypatch.setattr(line, "PATIENCE", 0.5)  # this process has met the coordinator, and would wait for it
    with pytest.raises(PicoError, match="does not answer: Connection refused"):
        Bench.open(lab)
    assert "default" not in json.loads((lab / ".git" / "pico" / "remotes.json").read_bytes())


def test_the_bench_that_an_earlier_version_meant_is_meant_until_a_worktree_chooses(lab: Path) -> None:
    path = lab / ".git/pico/remotes.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps({"remotes": {"lab": {"url": LAB.url}}, "default": "lab/shel/bench1"}))
    assert meant(lab).name == "shel/bench1"
    keep(lab, added(known(lab), "other", Remote("http://127.0.0.1:1")))
    assert meant(lab).name == "shel/bench1"
    write_choice(lab, "sim")
    assert meant(lab) == bench_at(lab)
