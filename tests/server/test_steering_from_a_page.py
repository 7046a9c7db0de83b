"""Steering as the page does: begun by a command at a desk, steered by frames over the socket of clients."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from desks import Desked, desked
from edges import client, refusal

from pico.history.examples.example import make_example
from pico.teleop.frames import Frame


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Desked]:
    folder = tmp_path_factory.mktemp("steering")
    with desked(folder / "books", make_example("shel", folder / "shel").root) as found:
        yield found


def test_a_page_begins_steers_and_ends_and_it_is_one_transition(desk: Desked) -> None:
    token = desk.served.person("ann", "operator", "teleop")
    (begun,) = desk.said(token, "teleop", "p2.angle", "--begin", "--yes", session="page-1")
    assert begun["schema"] == "pico.steered/v1" and begun["component"] == "p2" and begun["robot"] is None
    assert begun["tunables"]["angle"]["unit"] == "deg" and len(begun["tunables"]["angle"]["steps"]) > 5
    with client(desk.served, token, "page-1") as page:
        seq, run = 0, begun["run"]

        def say(**said: object) -> object:
            nonlocal seq
            seq += 1
            return page.ask("jog", run, Frame(seq=seq, **said))

        while (there := say()).phase != "ready":
            pass
        first = there.values["angle"]
        said = say(press=1, tunable="angle", by=1.0, seen=there.clock)
        while not said.refused and said.steps == 0:
            said = say()
        assert (said.refused, said.values["angle"]) == ("", first + 1.0)
        assert say(release=True).stopped in ("released", "silent")  # the machine may be slow
        say(end=True)
        events = page.events(run)
    done = next(e for e in events if e["kind"] == "operation_done" and e["operation"] == begun["operation"])
    assert done["data"]["first"] == {"p2.angle": first} and done["data"]["last"] == {"p2.angle": first + 1.0}
    assert sum(done["data"]["presses"].values()) == 1


def test_it_takes_the_role_and_what_the_keys_of_a_terminal_need_is_not_taken(desk: Desked) -> None:
    bob = desk.served.person("bob", "operator")
    assert desk.at(bob, "teleop", "p2.angle", "--begin", "--yes")[0] == 403
    token = desk.served.person("ann", "operator", "teleop")
    status, answer = desk.at(token, "teleop", "p2.angle", "--begin", "--step", "1")
    assert status == 400 and "--step" in answer[0]["error"][0]["summary"]
    _, documents = desk.at(token, "teleop", "p2")
    assert documents[-1]["exit"] == 1 and "nobody can press a key here" in str(documents)
    with client(desk.served, bob) as page:
        assert refusal(page, "jog", "none", Frame(seq=1)).diagnostics[0].code == "forbidden"
