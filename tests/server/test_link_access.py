"""What is said over the socket of a bench: nothing without its role, and nothing that makes no sense, does anything."""

from __future__ import annotations

import asyncio
import http.client
import json
import logging
import random
import threading
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import Any

import pytest
from coordinators import BENCH, Served, served
from edges import Connected, connected
from test_access import dump, lacking, refused
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from pico.edge.link import wire
from pico.edge.link.answering import Taken
from pico.edge.network import messages
from pico.edge.network.roles import ROLES
from pico.edge.network.uplink import Uplink
from pico.history.examples.example import make_example
from pico.server.routes import admitting
from pico.server.store.edges import Edges

LINK = f"/api/benches/{BENCH}/link"
MESSAGES = 10_000
HELLO = {"hello": {"session": "s1", "version": "test"}}


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Served, Connected]]:
    """A coordinator with the edge of the example in the twin."""
    root = tmp_path_factory.mktemp("lab") / "shel"
    make_example("shel", root)
    with served(tmp_path_factory.mktemp("coordinator")) as coordinator, connected(coordinator, root) as edge:
        while not coordinator.books.leases.enrolled() or not coordinator.books.leases.met(BENCH):
            time.sleep(0.01)
        coordinator.loosen()
        yield coordinator, edge


@contextmanager
def opened(served: Served, token: str) -> Iterator[ClientConnection]:
    """Open a socket that has said hello."""
    with served.watch(LINK, token) as socket:
        socket.send(json.dumps(HELLO))
        assert "hello" in json.loads(socket.recv(timeout=30))
        yield socket


def standing(edge: Connected) -> Any:
    """Return all that can have moved, and what was begun."""
    memory = edge.edge.memory
    return edge.edge.world.placements(), memory and (memory.runs(), memory.records())


def test_no_call_over_a_socket_is_made_without_its_role(bench: tuple[Served, Connected]) -> None:
    coordinator, edge = bench
    who = {role: coordinator.person(f"x-{role.replace(':', '.')}", *lacking(role, "shel"), "viewer@shel")
           for role in set(ROLES.values()) if role not in (None, "viewer")}  # fmt: skip
    before, stood = dump(coordinator), standing(edge)
    for role, token in who.items():
        with opened(coordinator, token) as socket:
            for number, call in enumerate(call for call, needed in ROLES.items() if needed == role):
                socket.send(json.dumps({"id": number, "call": call, "with": []}))
                answer = json.loads(socket.recv(timeout=30))
                assert (answer["id"], answer["exit"], answer["error"][0]["code"]) == (number, 7, "forbidden"), call
    assert (dump(coordinator), standing(edge)) == (before, stood)


def test_what_a_person_at_the_table_confirms_is_relayed_for_nobody(bench: tuple[Served, Connected]) -> None:
    coordinator, _ = bench
    assert not ROLES.keys() & wire.AT_TABLE and "clear_fault" in wire.AT_TABLE
    with opened(coordinator, coordinator.person("chief", "admin@*")) as socket:
        socket.send(json.dumps({"id": 1, "call": "clear_fault", "with": ["arm1", "chief"]}))
        answer = json.loads(socket.recv(timeout=30))
    assert answer["error"][0]["code"] == "link" and "no call that an edge knows" in answer["error"][0]["summary"]
    token = coordinator.person("boss", "admin@*")
    status = coordinator.ask("POST", f"/api/benches/{BENCH}/calls/clear_fault", token, {"with": ["arm1", "boss"]})[0]
    assert status in (404, 405)


def test_an_edge_takes_nothing_that_a_person_at_the_table_confirms_from_a_coordinator() -> None:
    async def answered() -> list[Any]:
        said = {"call": "clear_fault", "with": ["arm1", "chief"]}
        return [answer async for answer in object.__new__(Uplink)._answers(said, Taken())]

    (answer,) = asyncio.run(answered())
    assert answer["error"][0]["code"] == "at-table" and "terminal of the bench's own computer" in str(answer)


def test_a_socket_ends_with_its_token_and_gives_back_what_it_held(bench: tuple[Served, Connected]) -> None:
    coordinator, _ = bench
    token = coordinator.person("anna", "operator@shel")
    with opened(coordinator, token) as socket:
        socket.send(json.dumps({"id": 1, "call": "acquire", "with": ["anna", 0.0]}))
        assert "value" in json.loads(socket.recv(timeout=30))
        coordinator.books.people.settled("anna", [], by="root", disabled=True)
        assert json.loads(socket.recv(timeout=30))["error"][0]["code"] == "unauthenticated"
        with pytest.raises(ConnectionClosed):
            socket.recv(timeout=30)
    while coordinator.books.leases.shown(BENCH)[0].grant is not None:
        time.sleep(0.01)


def test_a_long_answer_ends_with_its_token(bench: tuple[Served, Connected], monkeypatch: pytest.MonkeyPatch) -> None:
    coordinator, _ = bench
    let_go = threading.Event()

    async def endless(call: Any) -> AsyncIterator[dict[str, Any]]:
        try:
            yield {"next": 1}
            await asyncio.Event().wait()
        finally:
            let_go.set()

    monkeypatch.setattr(coordinator.app.state.dispatcher, "answers", endless)
    token = coordinator.person("zoe", "viewer@shel")
    link = http.client.HTTPConnection("127.0.0.1", coordinator.port, timeout=30)
    sent = {"authorization": f"Bearer {token}", "content-type": "application/json"}
    link.request("POST", f"/api/benches/{BENCH}/calls/events", json.dumps({"with": ["run", 0]}), sent)
    answer = link.getresponse()
    assert json.loads(answer.readline()) == {"next": 1}
    coordinator.books.people.settled("zoe", [], by="root", disabled=True)
    assert json.loads(answer.readline())["error"][0]["code"] == "unauthenticated"
    assert answer.readline() == b"" and let_go.wait(30)
    link.close()


def test_nobody_has_more_sockets_than_there_may_be(
    bench: tuple[Served, Connected], monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    coordinator, _ = bench
    monkeypatch.setattr(admitting, "SOCKETS", 3)
    token = coordinator.person("max", "viewer@shel")
    with ExitStack() as sockets:
        first = sockets.enter_context(coordinator.watch("/api/events", token))
        for path in (LINK, f"/api/benches/{BENCH}/live"):
            sockets.enter_context(coordinator.watch(path, token))
        for path in ("/api/events", LINK, f"/api/benches/{BENCH}/live"):
            assert refused(coordinator, path, token) == 429
        with coordinator.watch("/api/events", coordinator.person("mia", "viewer@shel")):
            first.close()
        while coordinator.app.state.sockets["max"] > 2:
            time.sleep(0.01)
        with coordinator.watch("/api/events", token) as again:
            again.recv(timeout=30)
    while coordinator.app.state.sockets["max"]:
        time.sleep(0.01)


ASKED = {"asked": 1, "moving": None, "busy": False, "taken": 0}
UNASKED: tuple[Any, ...] = ({"lease": 1}, {"id": [], "x": 1})
"""Answers to what nobody asked, which nobody hears."""


@pytest.mark.parametrize(
    "said",
    [
        {"poll": {**ASKED, "fenced": 1 << 80}},
        {"poll": {**ASKED, "fenced": "x"}},
        {"poll": {}},
        {"poll": 3},
        [],
        *UNASKED,
    ],
)
def test_an_edge_that_talks_nonsense_ends_its_own_line_alone(coordinator: Served, said: Any) -> None:
    code, _ = Edges(coordinator.books.database).invited(BENCH, "test")
    key, nonce = bytes(range(32)), "0" * 32
    assert coordinator.ask("POST", "/api/edge/enrol", None, {"code": code, "key": key.hex()})[0] == 200
    assert coordinator.ask("POST", "/api/edge/enrol", None, {"code": code, "key": key.hex()})[0] == 401
    shown = f"{messages.SCHEME} {BENCH} {nonce} {messages.proof(key, 'dials', BENCH, nonce, '')}"
    with coordinator.watch("/api/edge/link", additional_headers={"authorization": shown}) as socket:
        greeting = json.loads(socket.recv(timeout=30))
        assert greeting["proof"] == messages.proof(key, "coordinator", BENCH, nonce, greeting["nonce"])
        proof = messages.proof(key, "edge", BENCH, nonce, greeting["nonce"])
        socket.send(json.dumps({"proof": proof, "hello": {"fenced": 0, "records": []}}))
        with suppress(ConnectionClosed):
            socket.send(json.dumps(said))
            if said not in UNASKED:
                socket.recv(timeout=30)
    with coordinator.watch("/api/edge/link", additional_headers={"authorization": shown}) as socket:  # replayed, no key
        socket.recv(timeout=30)
        socket.send(json.dumps({"proof": proof, "hello": {"fenced": 9, "records": []}}))
        with pytest.raises(ConnectionClosed) as over:
            socket.recv(timeout=30)
        assert over.value.rcvd is not None and over.value.rcvd.code == 4401
    assert coordinator.books.leases.shown(BENCH)[0].token == 0
    assert coordinator.ask("GET", "/api/whoami", coordinator.person("anna"))[0] == 200


def nonsense(draw: random.Random) -> str | bytes:
    """Return a message that nobody should send."""
    junk: list[Any] = [None, True, -1, 1 << 80, 1e308, "", "x" * 300, "\x00", "../..", [], {}, [[]], {"a": {}}, "NaN"]
    call = draw.choice([*wire.CALLS, "__init__", "close", "memory.__class__", "world.__dict__", "served", "device"])
    broken = {"unsaid": draw.choice(junk)}  # no operation, plan, arming or frame is like that
    count = len(wire.CALLS[call][0]) if call in wire.CALLS else 0
    arguments: Any = [draw.choice(junk) for _ in range(count + draw.randrange(1, 4))]  # more than there should be
    number = draw.randrange(9)
    calls: list[Any] = [
        {"id": number, "call": call, "with": arguments},
        {"id": number, "call": call, "with": [broken, *arguments[:count][1:]]},
        {"id": number, "call": call, "with": draw.choice(junk)},
        {"id": draw.choice([True, -1, 1 << 80]), "call": draw.choice(junk), "with": arguments},
        {"id": number, "close": draw.choice(junk), "call": call, "with": arguments},
    ]
    if draw.random() < 0.95:
        return json.dumps(draw.choice(calls))
    text = json.dumps(draw.choice([  # the rest ends the socket
        {"id": draw.choice(junk), "call": call, "with": arguments},
        {"hello": draw.choice([*junk, {"session": draw.choice(junk)}])},
        draw.choice(junk),
        {draw.choice(["poll", "lease", "value", "next", "nonce"]): draw.choice(junk)},
    ]))  # fmt: skip
    broken_off = text[: draw.randrange(len(text) + 1)]
    deep, odd = "[" * draw.randrange(100_000), text.replace("1", "NaN").replace('"', "\ud7ff")
    return draw.choice([text, text, broken_off, draw.randbytes(draw.randrange(200)), deep, odd])


@pytest.mark.slow
def test_thousands_of_senseless_messages_crash_nothing_and_move_nothing(
    bench: tuple[Served, Connected], caplog: pytest.LogCaptureFixture
) -> None:
    coordinator, edge = bench
    tokens = [coordinator.person("ben", "viewer@shel"), coordinator.person("eve", "operator", "teleop", "laser:enable")]
    stood, draw = standing(edge), random.Random(22)
    caplog.set_level(logging.WARNING)
    read = ended = 0
    while read < MESSAGES:
        with opened(coordinator, tokens[read % 2]) as socket, suppress(ConnectionClosed):
            ended += 1
            for _ in range(50):
                read += 1  # it was, once the next one is answered, or the socket ends
                socket.send(nonsense(draw))
                socket.send(json.dumps({"id": 10_000 + read, "call": "nothing", "with": []}))
                while json.loads(socket.recv(timeout=60)).get("id") != 10_000 + read:
                    pass
    assert ended > MESSAGES / 50
    assert standing(edge)[0] == stood[0]
    with opened(coordinator, tokens[1]) as socket:
        socket.send(json.dumps({"id": 1, "call": "describe", "with": []}))
        assert json.loads(socket.recv(timeout=60))["value"]["name"] == "sim"
    assert coordinator.ask("GET", "/api/health")[0] == 200
    assert [record.getMessage() for record in caplog.records if record.levelno >= logging.ERROR] == []
