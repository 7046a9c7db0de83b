"""A coordinator over HTTP: who gets in, who has a bench."""

from __future__ import annotations

import json
import socket

import pytest
from coordinators import BENCH, Served
from websockets.exceptions import ConnectionClosed

from pico.server.running import listening

LEASE = f"/api/benches/{BENCH}/lease"


def test_a_bench_is_granted_once_the_edge_has_fenced_and_renewed_released_and_stolen(coordinator: Served) -> None:
    coordinator.bench(fenced=3)
    anna, ben = coordinator.person("anna", "operator@shel"), coordinator.person("ben", "operator", "lease:steal")
    assert coordinator.ask("POST", LEASE, anna, {"session": "s"}) == (
        202,
        {"state": "waiting", "ahead": 0, "holder": "anna"},
    )
    coordinator.books.leases.heard(BENCH, 4)
    granted = (200, {"state": "granted", "token": 4, "lasts": 10.0})
    assert coordinator.ask("POST", LEASE, anna, {"session": "s"}) == granted
    assert coordinator.ask("PUT", LEASE, anna, {"session": "s", "token": 4}) == granted
    waits = coordinator.ask("POST", LEASE, ben, {"session": "s"})
    assert waits == (202, {"state": "waiting", "ahead": 0, "holder": "anna"})
    status, shown = coordinator.ask("GET", LEASE, ben)
    assert (status, shown["holder"]["who"], shown["waiting"]) == (200, "anna", ["ben"])
    status, lost = coordinator.ask("PUT", LEASE, ben, {"session": "s", "token": 4})
    assert (status, lost["exit"]) == (409, 5), "a session belongs to who opened it, whatever it is called"
    stolen = coordinator.ask("POST", f"{LEASE}/steal", ben, {"session": "s", "reason": "it burns"})
    assert stolen == (202, {"state": "fencing", "token": 5, "lasts": 10.0})
    status, lost = coordinator.ask("PUT", LEASE, anna, {"session": "s", "token": 4})
    assert status == 409 and "ben has it now" in lost["error"][0]["summary"]
    assert coordinator.ask("DELETE", f"{LEASE}?session=s&token=5", ben) == (200, {"released": True})
    assert coordinator.ask("GET", LEASE, ben)[1]["holder"] is None


def test_a_coordinator_that_began_anew_grants_nothing_before_the_edge_was_heard(coordinator: Served) -> None:
    coordinator.bench(fenced=None)
    anna = coordinator.person("anna", "operator", "lease:steal")
    assert coordinator.ask("POST", LEASE, anna, {"session": "s"})[0] == 202
    assert coordinator.ask("GET", LEASE, anna)[1]["holder"] is None
    assert coordinator.ask("POST", f"{LEASE}/steal", anna, {"session": "s", "reason": "now"})[0] == 503


def test_a_token_says_who_one_is_and_a_code_makes_one_once(coordinator: Served) -> None:
    admin = coordinator.person("root", "admin")
    assert coordinator.ask("PUT", "/api/principals/anna", admin, {"rights": ["viewer@shel", "teleop@shel"]})[0] == 200
    status, made = coordinator.ask("POST", "/api/tokens", admin, {"kind": "code", "principal": "anna"})
    assert status == 200, made
    code = made["secret"]
    assert coordinator.ask("GET", "/api/whoami", code)[0] == 401, "a code is no token"
    status, made = coordinator.ask("POST", "/api/login", None, {"code": code})
    assert status == 200
    assert coordinator.ask("POST", "/api/login", None, {"code": code})[0] == 401
    who = coordinator.ask("GET", "/api/whoami", made["secret"])[1]
    assert (who["name"], who["rights"], who["token"]) == ("anna", ["teleop@shel", "viewer@shel"], made["id"])
    assert coordinator.ask("DELETE", f"/api/tokens/{made['id']}", made["secret"])[0] == 200
    assert coordinator.ask("GET", "/api/whoami", made["secret"])[0] == 401


def test_those_who_watch_are_told_in_order_of_the_labs_where_they_have_a_role(coordinator: Served) -> None:
    coordinator.bench()
    coordinator.bench("secret/bench1")
    anna, ben = coordinator.person("anna", "operator@shel"), coordinator.person("ben", "operator")
    with coordinator.watch("/api/events?since=0", anna) as socket:
        assert json.loads(socket.recv())["hello"]["number"] == 0
        coordinator.ask("POST", "/api/benches/secret/bench1/lease", ben, {"session": "s"})
        coordinator.ask("POST", LEASE, ben, {"session": "s"})
        coordinator.ask("POST", LEASE, anna, {"session": "s"})
        told = [json.loads(socket.recv()) for _ in range(2)]
    assert [(e["number"], e["bench"], e["kind"]) for e in told] == [(2, BENCH, "lease"), (3, BENCH, "queue")]
    assert told[0]["data"]["deed"] == "granted" and told[1]["data"] == {"waiting": ["anna"]}
    with coordinator.watch("/api/events?since=2", anna) as socket:
        assert json.loads(socket.recv())["hello"]["number"] == 3
        assert json.loads(socket.recv()) == told[1]
        coordinator.books.people.settled("anna", [], by="root", disabled=True)
        assert json.loads(socket.recv())["error"][0]["code"] == "unauthenticated"
        with pytest.raises(ConnectionClosed) as over:
            socket.recv()
        assert over.value.rcvd is not None and over.value.rcvd.code == 4401


def test_a_message_that_follows_another_one_does_not_wait_for_that_to_be_acknowledged() -> None:
    with listening("127.0.0.1", 0) as served, socket.create_connection(served.getsockname()[:2], timeout=10):
        accepted, _ = served.accept()
        with accepted:
            assert accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
