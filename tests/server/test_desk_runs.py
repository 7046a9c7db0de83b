"""Runs at desks go on without a listener, are listed, followed and cancelled; recipes are detached, and come back."""

from __future__ import annotations

import asyncio
import http.client
import json
import os
import shutil
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico
from coordinators import served
from desks import ASKING, WARM, Desked, asked, desked, followed, placed, say

from pico.backends.sim.session import WorldSession
from pico.diagnostics import PicoError, error
from pico.history.examples.example import make_example
from pico.server.desk import jobs
from pico.server.desk.desks import Desking

RECIPE = """\
apiVersion: pico/v1
kind: Recipe
metadata: {name: turning}
parameters: {to: 1}
steps:
  - set: {p1.angle: to}
  - capture:
  - commit: turned
  - set: {p1.angle: 5}
"""


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Desked]:
    folder = tmp_path_factory.mktemp("runs")
    with desked(folder / "books", make_example("shel", folder / "shel").root) as found:
        yield found


def slow(monkeypatch: pytest.MonkeyPatch, pause: float) -> None:
    """Let each phase of what the arm does last so much longer [s]."""
    tell = WorldSession._tell

    def telling(self: WorldSession, *what: Any) -> None:
        tell(self, *what)
        time.sleep(pause)

    monkeypatch.setattr(WorldSession, "_tell", telling)


def run_of(desk: Desked, token: str, run: str) -> dict[str, Any]:
    return desk.served.ask("GET", f"/api/labs/shel/desk/runs/{run}", token)[1]


def lines(desk: Desked, token: str, run: str, since: int = 0) -> list[Any]:
    status, body = desk.served.ask("GET", f"/api/labs/shel/desk/runs/{run}/events?since={since}", token)
    assert status == 200, body
    return [json.loads(line) for line in body.splitlines()]


def test_a_run_goes_on_without_who_began_it_and_others_follow_it_from_any_line(
    desk: Desked, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow(monkeypatch, 0.002)
    anna, vera = desk.served.person("anna", "operator"), desk.served.person("vera", "viewer")
    link = http.client.HTTPConnection("127.0.0.1", desk.served.port, timeout=60)
    sent = {"authorization": f"Bearer {anna}", "content-type": "application/json"}
    link.request("POST", "/api/labs/shel/desk/apply", json.dumps({"words": ["e1", "-y"]}), sent)
    answer = link.getresponse()
    run, first = answer.getheader("x-pico-run", ""), json.loads(answer.readline())
    link.sock.close()
    answer.close()
    assert run_of(desk, vera, run)["exit"] is None
    found = lines(desk, vera, run)
    assert found[0] == first and found[-1]["exit"] == 0 and len(found) > 10
    assert lines(desk, vera, run, since=7) == found[7:] and lines(desk, vera, run, 10_000) == found[-1:]
    assert run_of(desk, vera, run)["exit"] == 0
    assert desk.served.ask("GET", "/api/labs/shel/desk/runs/nothing/events", vera)[0] == 404


def test_who_began_a_run_cancels_it_as_ctrl_c_does_and_nobody_else(
    desk: Desked, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow(monkeypatch, 0.1)
    anna, ben = desk.served.person("anna", "operator"), desk.served.person("ben", "operator")
    status, told = desk.at(anna, "apply", "e3", "-y", detach=True)
    assert status == 202
    run = told[0]["run"]
    while not any('"operation_started"' in line.decode() for line in desk_said(desk, run)):
        time.sleep(0.02)
    path = f"/api/labs/shel/desk/runs/{run}"
    assert desk.served.ask("DELETE", path, ben)[0] == 403
    assert desk.served.ask("DELETE", path, anna)[0] == 200
    monkeypatch.undo()
    assert lines(desk, anna, run)[-1]["exit"] == 130
    assert run_of(desk, anna, run)["ended_at"] is not None
    assert desk.said(anna, "status")


def test_a_run_is_over_though_the_coordinator_can_not_write_that_down(
    desk: Desked, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise PicoError(error("books", "the coordinator can't write its books: database or disk is full"))

    def ends_unwritten(path: Path, content: bytes, real: Any = jobs.write_whole) -> None:
        if b'"exit": null' not in content:
            full()
        real(path, content)

    dora, people = desk.served.person("dora", "operator"), desk.served.books.people
    with monkeypatch.context() as patched:
        patched.setattr(people, "revoked", full)
        patched.setattr(jobs, "write_whole", ends_unwritten)
        run = desk.at(dora, "apply", "-y", detach=True)[1][0]["run"]
        assert lines(desk, dora, run)[-1]["exit"] == 0
        told = run_of(desk, dora, run)
    assert told["exit"] == 0 and told["ended_at"] is not None
    with monkeypatch.context() as patched:
        patched.setattr(people, "issued", full)
        status, said = desk.at(dora, "note", "p1", "a")
    assert status == 503 and said[0]["error"][0]["code"] == "books"


def desk_said(desk: Desked, run: str) -> list[bytes]:
    path = desk.served.books.folder / "desks" / "shel" / "runs" / run / "said.ndjson"
    return path.read_bytes().splitlines() if path.exists() else []


def test_nobody_has_more_commands_going_than_there_is_room_for(desk: Desked, monkeypatch: pytest.MonkeyPatch) -> None:
    from pico.server.desk import desks

    monkeypatch.setattr(desks, "AT_ONCE", 0)
    status, told = desk.at(desk.served.person("anna", "operator"), "status")
    assert status == 429 and "commands going" in told[0]["error"][0]["summary"]
    monkeypatch.undo()
    monkeypatch.setattr(desks, "LASTS", 0.0)
    assert desk.at(desk.served.person("anna", "operator"), "plan", "e2")[1][-1] == {
        "exit": 130,
        "why": "it went on for too long",
    }


@pytest.fixture
def mine(desk: Desked, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico) -> Path:
    """A checkout of anna's, in which commands go to the bench at the coordinator."""
    made = Path(shutil.copytree(desk.root, tmp_path / "mine", ignore=shutil.ignore_patterns(".pico")))
    monkeypatch.chdir(made)
    monkeypatch.setenv("PICO_TOKEN", desk.served.person("anna", "operator"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    assert pico("remote", "add", "lab", f"http://127.0.0.1:{desk.served.port}", "--default", "shel/bench1").code == 0
    return made


def test_what_a_detached_recipe_asks_is_answered_at_the_terminal_that_follows_it(
    desk: Desked, mine: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico
) -> None:
    (mine / "recipes" / "asking.yaml").write_text(ASKING)
    left = pico("--json", "run", "asking", "--yes", "--detach")
    assert left.code == 0, left.err + left.out
    run = json.loads(left.out)["run"]
    typed, typing = os.pipe()
    anna = desk.served.person("anna", "operator")
    elsewhere = threading.Thread(target=lambda: say(desk, anna, asked(desk, anna, "q2", "3")[0], "q2", "gold"))
    elsewhere.start()
    with os.fdopen(typed, "rb") as stdin, os.fdopen(typing, "wb", buffering=0) as keys:
        monkeypatch.setattr("sys.stdin", stdin)
        monkeypatch.setattr("pico_cli.runs.asking.at_terminal", lambda _: True)
        keys.write(b"6\n400 uW\n")
        found = pico("runs", "attach", run)
    elsewhere.join(60)
    assert found.code == 0 and "asking: done" in found.out, found.out + found.err
    assert found.out.count("Read the meter. [a number in mW from 0 to 5] ") == 2 and "out of range: 6 mW" in found.err
    said = lines(desk, desk.served.person("vera", "viewer"), run)
    assert said[-2]["returns"] == {"read": pytest.approx(0.4), "which": "gold"}


def test_a_recipe_goes_on_beside_the_coordinator_and_its_commits_and_runs_come_back(
    desk: Desked, mine: Path, pico: Pico
) -> None:
    (mine / "recipes" / "turning.yaml").write_text(RECIPE)
    before = (mine / "state" / "table.yaml").read_text(), git(mine, "status", "--porcelain"), git(mine, "branch")
    left = pico("--json", "run", "turning", "-p", "to=4", "--yes", "--detach")
    assert left.code == 0, left.err + left.out
    run = json.loads(left.out)["run"]
    found = pico("runs", "attach", run[:6])
    assert found.code == 0 and "turning: done" in found.out and f"detached/{run}" in found.out, found.out + found.err
    assert (mine / "state" / "table.yaml").read_text() == before[0] and git(mine, "status", "--porcelain") == before[1]
    assert git(mine, "log", "-1", "--format=%an %s", f"detached/{run}") == "anna turned"
    assert git(mine, "rev-parse", f"detached/{run}~2") == git(mine, "rev-parse", "HEAD")
    assert "angle: 4" in git(mine, "show", f"detached/{run}:state/table.yaml")
    ended = run_of(desk, desk.served.person("vera", "viewer"), run)
    assert len(ended["runs"]) >= 2 and not (desk.served.books.folder / "desks/shel/on" / f"run%anna%{run}").exists()
    assert pico("commit", "-m", "what it did", "--capture").code == 0
    carried = {path.parent.name for path in (mine / "runs").rglob("run.json")}
    there = git(mine, "ls-tree", "-r", "--name-only", f"detached/{run}", "runs")
    committed = {Path(path).parent.name for path in there.splitlines()}
    assert carried and committed and carried | committed <= set(ended["runs"])
    assert pico("run", "/etc/hosts", "--yes", "--detach").code == 1


def git(root: Path, *words: str) -> str:
    return subprocess.run(["git", "-C", root, *words], check=True, capture_output=True, text=True).stdout.strip()


def test_what_a_coordinator_left_going_has_ended_when_it_is_back(tmp_path: Path) -> None:
    folder = tmp_path / "desks" / "shel" / "runs" / "abc"
    folder.mkdir(parents=True)
    about = {"id": "abc", "lab": "shel", "bench": "bench1", "who": "anna", "command": "apply", "words": ["-y"],
             "began_at": 1.0, "runs": []}  # fmt: skip
    (folder / "about.json").write_text(json.dumps(about))
    (folder / "said.ndjson").write_text('{"kind": "run_started"}\n')
    with served(tmp_path, desks=Desking(WARM)) as serving:
        serving.bench()
        token = serving.person("anna", "operator")
        status, told = serving.ask("GET", "/api/labs/shel/desk/runs/abc", token)
        assert status == 200 and told["exit"] == 130 and told["why"] == "the coordinator ended meanwhile"
        status, said = serving.ask("GET", "/api/labs/shel/desk/runs/abc/events", token)
        assert [json.loads(line) for line in said.splitlines()] == [
            {"kind": "run_started"}, {"exit": 130, "why": "the coordinator ended meanwhile"},
        ]  # fmt: skip
        assert serving.ask("DELETE", "/api/labs/shel/desk/runs/abc", token)[0] == 200


def test_a_run_ends_safely_once_the_token_that_began_it_is_revoked(
    desk: Desked, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow(monkeypatch, 0.1)
    anna, vera = desk.served.person("anna", "operator"), desk.served.person("vera", "viewer")
    people = desk.served.books.people
    run = desk.at(anna, "apply", "e2", "-y", detach=True)[1][0]["run"]
    while not any(b'"operation_started"' in line for line in desk_said(desk, run)):
        assert run_of(desk, vera, run)["exit"] is None, desk_said(desk, run)
        time.sleep(0.02)
    me = people.known(anna)
    assert me is not None
    people.revoked(me.token, by="test")
    found = lines(desk, vera, run)
    assert (found[-1]["exit"], found[-1]["why"]) == (130, "the token that it was begun with is over"), found[-3:]
    assert "Stopping:" in found[-1]["beside"]
    assert '"unauthenticated"' not in json.dumps(found)
    assert not [one for one in people.tokens("anna") if one["kind"] == "desk"]
    assert desk.served.ask("GET", f"/api/labs/shel/desk/runs/{run}", anna)[0] == 401
    assert desk.at(anna, "status")[0] == 401


def test_what_a_recipe_asks_is_answered_once_by_who_began_it_and_a_wrong_answer_leaves_it(desk: Desked) -> None:
    anna, ben, vera, root = (
        desk.served.person(name, role)
        for name, role in (("anna", "operator"), ("ben", "operator"), ("vera", "viewer"), ("root", "admin"))
    )
    placed(desk, anna, "anna")
    run = desk.at(anna, "run", "asking", "-y", detach=True)[1][0]["run"]
    found, question = asked(desk, vera, "q1", "2")  # nobody follows it: what may be left out is not asked
    assert found == run and (question["schema"], question["text"]) == ("pico.question/v1", "Read the meter.")
    assert [question[key] for key in ("kind", "unit", "low", "high")] == ["number", "mW", 0, 5]
    assert say(desk, vera, run, "q1", "2")[0] == 403
    assert say(desk, ben, run, "q1", "2") == (403, f"{run} is a run of anna")
    assert say(desk, anna, run, "q1", "6") == (400, "read is out of range: 6 mW, and it may be 0 to 5 mW")
    assert say(desk, anna, run, "q2", "2") == (409, f"{run} does not ask q2")
    assert asked(desk, anna, "q1", "2") == (run, question)
    assert say(desk, anna, run, "q1", "400 uW") == (200, pytest.approx(0.4))
    assert say(desk, anna, run, "q1", "3") == (409, "anna has answered it")
    asked(desk, anna, "q2", "3")
    assert say(desk, root, run, "q2", "gold") == (200, "gold")
    said = lines(desk, anna, run)
    assert said[-1]["exit"] == 0 and said[-2]["returns"] == {"read": pytest.approx(0.4), "which": "gold"}
    done = {one["path"]: one["result"] for one in said if one.get("event") == "done"}
    assert done == {"1": {}, "2": {"": pytest.approx(0.4), "by": "anna"}, "3": {"": "gold", "by": "root"}}
    assert say(desk, anna, run, "q3", "gold") == (409, f"{run} asks nothing now")


def test_a_recipe_that_is_cancelled_asks_no_more_and_goes_on_there_and_a_no_ends_it(desk: Desked) -> None:
    anna = desk.served.person("anna", "operator")
    placed(desk, anna, "anna")
    ended = followed(desk, anna, "asking")
    run, question = asked(desk, anna, "q1", "1")
    assert (question["kind"], question["wanted"], question["unattended"]) == ("confirm", "yes or no", "skip")
    assert say(desk, anna, run, "q1", "perhaps")[0] == 400
    assert desk.served.ask("DELETE", f"/api/labs/shel/desk/runs/{run}", anna)[0] == 200
    said = ended()
    assert said[-1]["exit"] == 130 and said[-2]["outcome"] == "interrupted"
    assert run_of(desk, anna, run)["question"] is None and say(desk, anna, run, "q1", "yes")[0] == 409
    ended = followed(desk, anna, "--resume")
    run, again = asked(desk, anna, "q1", "1")
    assert again == question and say(desk, anna, run, "q1", "no") == (200, False)
    said = ended()
    assert said[-1]["exit"] == 1 and said[-2]["diagnostics"][0]["summary"] == "anna said no: Is the cover on?"


def test_a_line_that_never_ends_ends_its_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "LONGEST", 1 << 20)
    about = jobs.About("abc", "shel", "bench1", "anna", "apply", (), 1.0)
    job = jobs.Job(about, tmp_path, asyncio.Event())
    job.ended.set()

    async def said() -> list[bytes]:
        return [line async for line in job.lines()]

    whole = json.dumps({"x": "y" * ((1 << 20) - 20)}).encode()
    job.said[0].write_bytes(b'{"first": 1}\n' + whole + b"\n\n" + whole + b"\n" + b'{"rest": 2}')
    assert asyncio.run(said())[:-1] == [b'{"first": 1}\n', whole + b"\n", whole + b"\n", b'{"rest": 2}\n']
    job.said[0].write_bytes(b'{"first": 1}\n' + b"x" * (3 << 20))
    with pytest.raises(PicoError, match="`pico apply` said a line of more than 1 MiB"):
        asyncio.run(said())
