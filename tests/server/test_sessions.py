"""A browser is let in by a cookie, for what its token may, as long as that lasts, and for pages of this host alone."""

from __future__ import annotations

import http.client
import json
from typing import Any

import pytest
from coordinators import BENCH, Served
from sqlalchemy import select
from test_access import refused
from websockets.exceptions import ConnectionClosed

from pico.server.access.secret import SESSION_LASTS
from pico.server.store.tables import sessions


def entered(served: Served, **shown: str) -> tuple[int, dict[str, str], Any]:
    """Return status, attributes of the cookie that is set (`name=value` under ''), and what is said."""
    link = http.client.HTTPConnection("127.0.0.1", served.port, timeout=30)
    try:
        link.request("POST", "/api/session", json.dumps(shown), {"content-type": "application/json"})
        answer = link.getresponse()
        first, *rest = answer.getheader("set-cookie", "").split("; ")
        return answer.status, {"": first} | {k.lower(): v for k, _, v in (r.partition("=") for r in rest)}, json.loads(
            answer.read())  # fmt: skip
    finally:
        link.close()


def browser(served: Served, cookie: str, origin: str | None = "") -> dict[str, str]:
    """Return the headers of a browser; `origin`: of its page, of this coordinator where it is empty."""
    at = f"http://127.0.0.1:{served.port}" if origin == "" else origin
    return {"cookie": cookie} | ({"origin": at} if at else {})


def test_a_browser_does_what_its_token_may_and_its_secret_is_kept_nowhere(coordinator: Served) -> None:
    coordinator.bench()
    token = coordinator.person("anna", "operator@shel")
    status, cookie, said = entered(coordinator, secret=token)
    assert status == 200 and said["name"] == "anna" and said["rights"] == ["operator@shel"]
    assert cookie["samesite"] == "strict" and "httponly" in cookie and cookie["path"] == "/"
    headers = browser(coordinator, cookie[""])
    assert coordinator.ask("GET", "/api/session", headers=headers)[1]["name"] == "anna"
    at = f"/api/benches/{BENCH}/lease"
    assert coordinator.ask("POST", at, body={"session": "s1"}, headers=headers)[0] in (200, 202)
    assert coordinator.ask("POST", "/api/enrolments", body={"bench": BENCH}, headers=headers)[0] == 403
    with coordinator.watch("/api/events", additional_headers=headers) as socket:
        assert "hello" in json.loads(socket.recv(timeout=30))
    secret = cookie[""].partition("=")[2]
    with coordinator.books.database.reading() as connection:
        assert secret.encode() not in repr(connection.execute(select(sessions)).all()).encode()
    assert coordinator.ask("GET", "/api/whoami", secret)[0] == 401, "a session is no token"
    assert coordinator.ask("GET", "/api/whoami", headers=browser(coordinator, cookie[""] + "x"))[0] == 401


def test_a_one_time_code_lets_a_browser_in_once(coordinator: Served) -> None:
    coordinator.person("anna", "viewer@shel")
    code = coordinator.books.people.issued("anna", 60, by="root", kind="code").secret
    assert entered(coordinator, code=code)[0] == 200
    assert [entered(coordinator, **shown)[0] for shown in ({"code": code}, {"secret": code}, {})] == [401, 401, 400]


def test_other_pages_do_nothing_in_the_name_of_a_browser(coordinator: Served) -> None:
    coordinator.bench()
    cookie = entered(coordinator, secret=coordinator.person("anna", "admin"))[1][""]
    for origin in (None, "http://evil.example", "null", f"http://127.0.0.1:{coordinator.port + 1}"):
        headers = browser(coordinator, cookie, origin)
        for method, path in (("POST", "/api/enrolments"), ("DELETE", "/api/session"), ("PUT", "/api/principals/x")):
            assert coordinator.ask(method, path, body={}, headers=headers)[0] == 403, (method, origin)
        assert refused(coordinator, f"/api/benches/{BENCH}/live", None, additional_headers=headers) == 403, origin
    assert coordinator.ask("GET", "/api/session", headers=browser(coordinator, cookie, None))[0] == 200


@pytest.mark.parametrize("how", ["left", "revoked", "disabled", "grown old"])
def test_a_session_is_over_with_its_token_or_when_it_is_left(coordinator: Served, how: str) -> None:
    people, token = coordinator.books.people, coordinator.person("anna", "viewer@shel", lasts=30 * 86400.0)
    known = people.known(token)
    headers = browser(coordinator, entered(coordinator, secret=token)[1][""])
    assert known is not None
    with coordinator.watch("/api/events", additional_headers=headers) as socket:
        socket.recv(timeout=30)
        if how == "left":
            assert coordinator.ask("DELETE", "/api/session", headers=headers)[1] == {"ended": True}
        elif how == "revoked":
            people.revoked(known.token, by="root")
        elif how == "disabled":
            people.settled("anna", [], by="root", disabled=True)
        else:
            coordinator.clock.seconds += SESSION_LASTS + 1
        assert coordinator.ask("GET", "/api/session", headers=headers)[0] == 401
        with pytest.raises(ConnectionClosed):
            while True:
                socket.recv(timeout=30)
    assert (people.known(token) is not None) == (how in ("left", "grown old"))
