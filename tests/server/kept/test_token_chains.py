"""What was made with a token ends with it, and at a desk so that what moves comes to its safe end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from coordinators import Served

from pico.diagnostics import PicoError
from pico.server.store.books import books_in


def test_what_was_made_with_a_token_is_revoked_with_it_and_outlasts_it_only_where_that_is_an_admins(
    coordinator: Served,
) -> None:
    def made(by: str, **wanted: Any) -> dict[str, Any]:
        status, told = coordinator.ask("POST", "/api/tokens", by, wanted)
        assert status == 200, told
        return dict(told)

    def let_in(*secrets: str) -> list[bool]:
        return [coordinator.ask("GET", "/api/whoami", secret)[0] == 200 for secret in secrets]

    root, people = coordinator.person("root", "admin"), coordinator.books.people
    coordinator.person("anna", "operator@shel")
    anna = made(root, principal="anna", days=2)
    child = made(anna["secret"], days=300)
    below = made(child["secret"], days=1)
    code = made(anna["secret"], kind="code")
    unused = made(child["secret"], kind="code")
    _, exchanged = coordinator.ask("POST", "/api/login", None, {"code": code["secret"]})
    assert child["expires_at"] == exchanged["expires_at"] == anna["expires_at"] > below["expires_at"]
    other = made(root, principal="anna")
    secrets = [one["secret"] for one in (anna, child, below, exchanged, other)]
    assert all(let_in(*secrets))
    assert coordinator.ask("DELETE", f"/api/tokens/{anna['id']}", anna["secret"])[0] == 200
    assert let_in(*secrets) == [False, False, False, False, True]
    assert coordinator.ask("POST", "/api/login", None, {"code": unused["secret"]})[0] == 401
    entries = coordinator.ask("GET", "/api/audit", root)[1]["entries"]
    ended = {entry["of"]: entry["why"] for entry in entries if entry["deed"] == "revoke"}
    assert ended[f"anna/{below['id']}"] == f"with {anna['id']}"
    with pytest.raises(PicoError):
        people.issued("anna", 60, by="anna", parent=anna["id"])
    second = made(root, days=1)
    own, narrow = made(second["secret"], days=300), made(second["secret"], days=300, scope=["viewer@shel"])
    kept = made(narrow["secret"], days=300)
    assert own["expires_at"] > second["expires_at"] and kept["expires_at"] == narrow["expires_at"]
    assert coordinator.ask("DELETE", f"/api/tokens/{second['id']}", root)[0] == 200
    assert let_in(own["secret"], narrow["secret"], kept["secret"], other["secret"]) == [False, False, False, True]


def test_the_token_of_a_run_at_a_desk_lasts_a_minute_longer_than_its_own_and_makes_no_other(
    coordinator: Served,
) -> None:
    people, root = coordinator.books.people, coordinator.person("root", "admin")
    for how in ("revoked", "disabled", "old"):
        anna = coordinator.person("anna", "operator@shel")
        me = people.known(anna)
        assert me is not None
        run, look = (people.issued("anna", 86400.0, by="anna", kind=kind, parent=me.token) for kind in ("desk", "look"))
        assert run.expires_at == me.expires_at + 60 and look.expires_at == me.expires_at
        assert coordinator.ask("POST", "/api/tokens", run.secret, {})[0] == 403
        if how == "revoked":
            people.revoked(me.token, by="root")
        elif how == "disabled":
            coordinator.ask("PUT", "/api/principals/anna", root, {"rights": ["operator@shel"], "disabled": True})
        else:
            coordinator.clock.seconds = me.expires_at
        assert (people.known(anna), people.known(look.secret)) == (None, None), how
        assert people.known(run.secret) is not None and not people.last(me.token, run.id), how
        coordinator.clock.seconds += 60
        assert people.known(run.secret) is None, how


def test_books_of_before_have_no_parents_and_are_read(tmp_path: Path) -> None:
    books = books_in(tmp_path)
    books.people.settled("anna", [], by="test")
    secret = books.people.issued("anna", 60, by="test").secret
    with books.database.writing() as connection:
        connection.exec_driver_sql("ALTER TABLE tokens DROP COLUMN parent")
    books.close()
    for _ in range(2):
        books = books_in(tmp_path)
        assert books.people.known(secret) is not None
        books.close()
