"""Nobody gets in without a token, or further than its role: asked of every route that there is."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from logging.handlers import BufferingHandler
from pathlib import Path
from typing import Any

import pytest
from coordinators import BENCH, Served
from fastapi.routing import APIRoute, APIWebSocketRoute
from sqlalchemy import select
from starlette.routing import Route
from websockets.exceptions import InvalidStatus

from pico.diagnostics import PicoError
from pico.server.access.principal import ROLES, Principal, Right
from pico.server.app import create_app
from pico.server.guard.rates import Rate
from pico.server.routes.admitting import ROLE
from pico.server.routes.known import routers
from pico.server.store.books import books_in
from pico.server.store.tables import metadata

SEEN = frozenset({("GET", "/api/health")})
"""What anybody may see."""
CODES = {
    "/api/login": b'{"code": "no"}',
    "/api/session": b'{"secret": "no"}',
    "/api/edge/enrol": b'{"code": "no", "key": "%s"}' % (b"0" * 64),
}
"""What is said where a code lets somebody in."""
BODIES = (b"", b"{", b"[]", b'{"session": "s", "wait": 0, "token": 1, "reason": "x", "rights": [], "code": "x"}')


def routes(app: Any) -> list[Any]:
    """Return every route of an app, those of the routers that it includes as well."""
    return [*app.routes, *(route for router in routers()[0] for route in router.routes)]


@pytest.fixture(scope="module")
def declared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    books = books_in(tmp_path_factory.mktemp("declared"))
    yield create_app(books)
    books.close()


def operations(app: Any) -> Iterator[tuple[str, str, str]]:
    """Yield method, path and role of each operation that OpenAPI tells of."""
    for path, methods in app.openapi()["paths"].items():
        for method, told in methods.items():
            yield method.upper(), path, told[ROLE]


def at(path: str, lab: str = "shel") -> str:
    """Return a path with something in place of each parameter."""
    standing = {"lab": lab, "bench": "bench1", "name": "anna", "token": "abc", "sha256": "0" * 64, "run": "abc"}
    for name, value in standing.items():
        path = path.replace(f"{{{name}}}", value)
    assert "{" not in path, f"say what stands for the parameters of {path}"
    return path


def dump(served: Served) -> dict[str, list[Any]]:
    """Return all that the books hold."""
    with served.books.database.reading() as connection:
        return {t.name: [tuple(r) for r in connection.execute(select(t))] for t in metadata.sorted_tables}


def lacking(role: str, lab: str) -> list[str]:
    """Return all rights that there are but those that let somebody do what asks for a role in a lab."""
    every = [Right(where, word) for where in (lab, "other") for word in ROLES]
    return [str(r) for r in every if not Principal("x", frozenset({r}), "", 0.0).may(role, lab)]


def test_openapi_tells_of_every_route_and_each_has_a_role(declared: Any) -> None:
    told = {(method, path) for method, path, _ in operations(declared)}
    there = {(method, r.path) for r in routes(declared) if isinstance(r, APIRoute) for method in r.methods}
    assert there == told and len(told) > 10
    others = {r.path for r in routes(declared) if isinstance(r, Route) and not isinstance(r, APIRoute)}
    assert "/" in others and {path for path in others if path.startswith("/api")} == {"/api/openapi.json"}
    assert {role for _, _, role in operations(declared)} <= {*ROLES, "public", "known", "any"}


def test_no_route_answers_without_a_token(coordinator: Served, declared: Any) -> None:
    coordinator.bench()
    secret = coordinator.person("anna", "admin", *ROLES)
    before = dump(coordinator)
    tokens = (None, "", "x", secret[:-1], f"{secret}x", secret.upper(), "pico_token_" + "A" * 43)
    coordinator.loosen()
    for method, path, _ in operations(declared):
        if (method, path) not in SEEN:
            for token, body in zip(tokens, (BODIES * 2)[: len(tokens)], strict=True):
                body = CODES.get(path, body)
                assert coordinator.ask(method, at(path), token, body)[0] == 401, (method, path, token, body)
    assert dump(coordinator) == before


def test_no_route_answers_those_without_its_role(coordinator: Served, declared: Any) -> None:
    coordinator.bench()
    coordinator.bench("other/bench1")
    asked = [(m, p, r) for m, p, r in operations(declared) if r not in ("public", "known")]
    who = {}
    for role in {role for _, _, role in asked}:
        rights = ["admin@other"] if role == "any" else lacking(role, "shel")
        who[role] = coordinator.person(f"lacks-{role.replace(':', '.')}", *rights)
    before = dump(coordinator)
    for method, path, role in asked:
        for body in BODIES:
            assert coordinator.ask(method, at(path), who[role], body)[0] == 403, (method, path, role, body)
    assert dump(coordinator) == before and len(asked) > 6


def test_no_socket_opens_without_a_token_or_a_role(coordinator: Served, declared: Any) -> None:
    coordinator.bench()
    elsewhere = coordinator.person("ben", "admin@other", "teleop@other", "laser:enable@other")
    found = [route.path for route in routes(declared) if isinstance(route, APIWebSocketRoute)]
    assert "/api/events" in found
    for path in found:
        for token in (None, "x"):
            assert refused(coordinator, at(path), token) == 401, path
        if "{lab}" in path:
            assert refused(coordinator, at(path), elsewhere) == 403, path


def test_a_socket_that_was_refused_is_no_mistake_in_the_log(coordinator: Served) -> None:
    heard, log = BufferingHandler(100), logging.getLogger("uvicorn.error")
    log.addHandler(heard)
    try:
        for _ in range(2):  # what is logged of the first one is, by the end of the second
            assert refused(coordinator, "/api/events", "x") == 401
    finally:
        log.removeHandler(heard)
    assert heard.buffer == []


def refused(served: Served, path: str, token: str | None, **options: Any) -> int:
    """Return the status with which a socket is refused."""
    with pytest.raises(InvalidStatus) as told, served.watch(path, token, **options):
        pass
    return told.value.response.status_code


def test_what_a_viewer_tries_over_and_over_is_slowed_down(coordinator: Served) -> None:
    statuses = [coordinator.ask("GET", "/api/whoami", "guessed")[0] for _ in range(60)]
    assert statuses[:30] == [401] * 30 and 429 in statuses[30:]
    assert coordinator.ask("GET", "/api/health")[0] == 200
    token = coordinator.person("anna", "viewer@shel")
    assert coordinator.ask("GET", "/api/whoami", token)[0] == 200, "others from her address do not shut her out"
    coordinator.app.state.requests = Rate(0.0, 3)
    assert [coordinator.ask("GET", "/api/whoami", token)[0] for _ in range(4)] == [200, 200, 200, 429]
    coordinator.bench()
    assert coordinator.ask("POST", f"/api/benches/{BENCH}/calls/stop", coordinator.person("eve"), {})[0] == 403
    assert coordinator.ask("POST", f"/api/benches/{BENCH}/calls/stop", token, b"{")[0] == 422, (
        "it is heard nevertheless"
    )


def test_pages_of_strangers_are_refused_by_host_and_by_origin(coordinator: Served) -> None:
    token, port = coordinator.person("anna", "operator"), coordinator.port
    mine = f"http://127.0.0.1:{port}"
    for host in (
        "evil.example",
        f"evil.example:{port}",
        "127.0.0.1.evil.example",
        "localhost@evil.example",
        "",
        "[",
        "x y",
    ):
        assert coordinator.ask("GET", "/api/whoami", token, headers={"host": host})[0] in (400, 421), host
        if host and " " not in host:
            assert refused(coordinator, "/api/events", token, additional_headers={"host": host}) in (400, 421)
    for host in (f"localhost:{port}", f"LOCALHOST:{port}", f"localhost.:{port}"):
        assert coordinator.ask("GET", "/api/whoami", token, headers={"host": host})[0] == 200, host
    strangers = ("http://evil.example", "null", f"http://localhost:{port}", "http://127.0.0.1:3000", "file://", "",
                 f"{mine}.evil.example", f"http://x@127.0.0.1:{port}", f"ftp://127.0.0.1:{port}")  # fmt: skip
    for origin in strangers:
        assert coordinator.ask("GET", "/api/whoami", token, headers={"origin": origin})[0] == 403, origin
        assert refused(coordinator, "/api/events", token, origin=origin) == 403, origin
    answer = coordinator.ask("GET", "/api/whoami", token, headers={"origin": mine})
    assert answer[0] == 200
    with coordinator.watch("/api/events", token, origin=mine) as socket:
        assert "hello" in socket.recv()


def test_bodies_have_an_end_whether_their_length_is_said_or_not(coordinator: Served) -> None:
    token = coordinator.person("anna", "operator")
    path = f"/api/benches/{BENCH}/lease"
    long = b'{"session": "' + b"s" * (1 << 20) + b'"}'
    assert coordinator.ask("POST", path, token, long)[0] == 413
    assert coordinator.chunked("POST", path, token, long) == 413
    for length in ("-1", "1e3", "", "99999999999999999999"):
        assert coordinator.ask("POST", path, token, b"{}", headers={"content-length": length})[0] in (400, 413), length


def test_tokens_end_are_revoked_and_carry_no_more_than_they_should(coordinator: Served) -> None:
    root, now = coordinator.person("root", "admin", "operator"), coordinator.clock
    coordinator.person("anna", "operator@shel", "viewer@other", "teleop@shel")
    made = coordinator.books.people.issued("anna", 60, by="root")
    anna = made.secret
    status, small = coordinator.ask("POST", "/api/tokens", anna, {"scope": ["viewer@shel"], "days": 1})
    assert status == 200 and coordinator.ask("GET", "/api/whoami", small["secret"])[1]["rights"] == []
    scopes: list[Any] = [["admin"], ["operator@other"], ["operator@*"], ["laser:enable@shel"]]
    for scope in scopes:
        assert coordinator.ask("POST", "/api/tokens", anna, {"scope": scope})[0] == 403, scope
    status, narrow = coordinator.ask("POST", "/api/tokens", anna, {"scope": ["operator@shel"]})
    status, child = coordinator.ask("POST", "/api/tokens", narrow["secret"], {})
    assert coordinator.ask("GET", "/api/whoami", child["secret"])[1]["rights"] == ["operator@shel"]
    assert coordinator.ask("POST", "/api/tokens", anna, {"principal": "root"})[0] == 403
    assert coordinator.ask("DELETE", f"/api/tokens/{small['id']}", root)[0] == 200
    assert coordinator.ask("GET", "/api/whoami", small["secret"])[0] == 401
    assert coordinator.ask("DELETE", f"/api/tokens/{small['id']}", root)[0] == 404
    own = coordinator.ask("GET", "/api/whoami", root)[1]["token"]
    assert coordinator.ask("DELETE", f"/api/tokens/{own}", anna)[0] == 404, "another's token is none of hers"
    later = coordinator.person("anna", "operator@shel")
    now.seconds += 61
    for ended in (anna, narrow["secret"], child["secret"]):
        assert coordinator.ask("GET", "/api/whoami", ended)[0] == 401
    assert coordinator.ask("GET", "/api/whoami", later)[0] == 200
    coordinator.ask("PUT", "/api/principals/anna", root, {"rights": [], "disabled": True})
    assert coordinator.ask("GET", "/api/whoami", later)[0] == 401


def test_codes_are_exchanged_once_in_time_and_not_by_guessing(coordinator: Served) -> None:
    coordinator.person("anna", "viewer")
    people = coordinator.books.people
    late = people.issued("anna", 60, by="root", kind="code").secret
    coordinator.clock.seconds += 61
    assert coordinator.ask("POST", "/api/login", None, {"code": late})[0] == 401
    token = people.issued("anna", 60, by="root").secret
    assert coordinator.ask("POST", "/api/login", None, {"code": token})[0] == 401, "a token is no code"
    statuses = [coordinator.ask("POST", "/api/login", None, {"code": f"pico_code_{n}"})[0] for n in range(60)]
    assert 429 in statuses


def test_what_was_done_is_in_the_audit_and_whoever_changes_that_is_seen(coordinator: Served) -> None:
    root = coordinator.person("root", "admin")
    coordinator.ask("PUT", "/api/principals/anna", root, {"rights": ["operator@shel"]})
    coordinator.ask("POST", "/api/tokens", root, {"principal": "anna", "label": "night"})
    status, told = coordinator.ask("GET", "/api/audit", root)
    assert status == 200 and told["broken"] is None
    assert [(e["deed"], e["who"], e["of"].partition("/")[0]) for e in told["entries"]][-2:] == [
        ("principal", "root", "anna"), ("token", "root", "anna"),
    ]  # fmt: skip
    assert coordinator.ask("GET", f"/api/audit?since={told['entries'][-1]['number']}", root)[1]["entries"] == []
    audit = metadata.tables["audit"]
    third, rows = audit.c.number == 3, dump(coordinator)["audit"]
    for spoilt in (audit.update().where(third).values(who="ben"), audit.delete().where(third),
                   audit.delete().where(audit.c.number >= 3)):  # fmt: skip
        with coordinator.books.database.writing() as connection:
            connection.execute(spoilt)
        assert coordinator.ask("GET", "/api/audit", root)[1]["broken"] == 3
        with coordinator.books.database.writing() as connection:
            connection.execute(audit.delete())
            connection.execute(audit.insert().values(rows))
    assert coordinator.ask("GET", "/api/audit", root)[1]["broken"] is None


def test_books_that_can_not_be_written_are_no_fault_of_the_coordinator(tmp_path: Path) -> None:
    books = books_in(tmp_path)
    people = books.people
    with books.database.writing() as connection:
        connection.exec_driver_sql("PRAGMA max_page_count = 1")  # as large as it is, and no larger
    with pytest.raises(PicoError) as raised:
        for number in range(1000):
            people.settled(f"p{number}", [], by="admin")
    assert raised.value.diagnostics[0].code == "books" and "full" in raised.value.diagnostics[0].summary
    books.close()
