"""Connections that send no whole request: they neither stay nor keep anybody out."""

from __future__ import annotations

import errno
import logging
import socket
import time
from collections.abc import Callable

import pytest
from coordinators import Served

from pico.server.guard import door, visits
from pico.server.running import listening

HALF = b"GET /api/health HTTP/1.1\r\nHost: localhost\r\nX-A: "
BODY = b"POST /api/login HTTP/1.1\r\nHost: localhost\r\nContent-Length: 900000\r\n\r\n{"


def connected(coordinator: Served, said: bytes) -> socket.socket:
    link = socket.create_connection(("127.0.0.1", coordinator.port), timeout=10)
    link.sendall(said)
    return link


def closed(link: socket.socket) -> bool:
    """Whether the other end closes a connection, sooner or later."""
    try:
        return link.recv(1) == b""
    except ConnectionResetError:
        return True


def is_open(link: socket.socket) -> bool:
    link.setblocking(False)
    try:
        return link.recv(1) != b""
    except BlockingIOError:
        return True
    except OSError:
        return False


def until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + 20
    while not true():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_the_oldest_that_wait_make_room_for_who_asks(coordinator: Served) -> None:
    links = [connected(coordinator, HALF) for _ in range(visits.STRANGERS + 30)]
    try:
        assert coordinator.ask("GET", "/api/health")[0] == 200
        until(lambda: sum(is_open(link) for link in links) <= visits.STRANGERS)
        assert not any(is_open(link) for link in links[:30])
    finally:
        for link in links:
            link.close()


@pytest.mark.parametrize("said", [b"", HALF, BODY], ids=["nothing", "half a header", "a begun body"])
def test_what_is_not_whole_in_time_is_closed(coordinator: Served, monkeypatch: pytest.MonkeyPatch, said: bytes) -> None:
    monkeypatch.setattr(visits, "HEADERS", 0.1)
    monkeypatch.setattr(door, "_LOOK", 0.05)
    with connected(coordinator, said) as link:
        assert closed(link)


def test_a_socket_that_is_let_in_is_never_late(coordinator: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(visits, "HEADERS", 0.05)
    monkeypatch.setattr(door, "_LOOK", 0.02)
    token = coordinator.person("anna", "viewer")
    with coordinator.watch("/api/events", token) as watching:
        time.sleep(0.3)
        assert coordinator.ask("GET", "/api/health")[0] == 200
        watching.ping().wait(10)


def test_without_free_descriptors_those_that_wait_leave_and_the_log_stays_short(
    coordinator: Served, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    links = [connected(coordinator, HALF) for _ in range(20)]
    assert coordinator.ask("GET", "/api/health")[0] == 200
    accept, failures = socket.socket.accept, iter(range(15))

    def short(listening: socket.socket) -> object:
        if isinstance(listening, door.Door) and next(failures, None) is not None:
            raise OSError(errno.EMFILE, "Too many open files")
        return accept(listening)

    monkeypatch.setattr(socket.socket, "accept", short)
    with caplog.at_level(logging.WARNING):
        try:
            assert coordinator.ask("GET", "/api/health")[0] == 200
            until(lambda: sum(is_open(link) for link in links) <= 5)
        finally:
            for link in links:
                link.close()
    assert len([r for r in caplog.records if r.levelno >= logging.WARNING]) <= 1


def test_without_free_descriptors_and_without_others_the_newcomer_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    accept, failures = socket.socket.accept, iter([None])

    def short(listening: socket.socket) -> object:
        if isinstance(listening, door.Door) and next(failures, 0) is None:
            raise OSError(errno.EMFILE, "Too many open files")
        return accept(listening)

    monkeypatch.setattr(socket.socket, "accept", short)
    with listening("127.0.0.1", 0) as served:
        address = served.getsockname()[:2]
        with socket.create_connection(address, timeout=10) as refused:
            with pytest.raises(BlockingIOError):
                served.accept()
            assert closed(refused)
        with socket.create_connection(address, timeout=10), served.accept()[0] as accepted:
            assert accepted.fileno() >= 0
