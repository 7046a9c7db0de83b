"""What a lab keeps at the coordinator: its repository over HTTP, edits without a checkout, large data."""

from __future__ import annotations

import hashlib
import os
import socket
import subprocess
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from coordinators import Served

EDITS = "/api/labs/shel/edits"


def git(folder: Path, *words: str, code: int = 0) -> str:
    """Return what git says, which is to end with `code`."""
    own = os.environ | {"GIT_CONFIG_NOSYSTEM": "1", "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_TERMINAL_PROMPT": "0"}
    done = subprocess.run(
        ["git", "-c", "user.name=anna", "-c", "user.email=anna@example.org", *words],
        cwd=folder, capture_output=True, text=True, env=own, check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == code, done.stderr
    return (done.stdout + done.stderr).strip()


def url(served: Served, token: str, lab: str = "shel") -> str:
    return f"http://git:{token}@127.0.0.1:{served.port}/api/git/{lab}"


def gits(served: Served) -> list[str]:
    """Return the processes of git that a coordinator has started and that go on."""
    found, mark = [], f"GIT_PROJECT_ROOT={served.books.folder}".encode()
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if mark in (process / "environ").read_bytes():
                found.append(process.name)
    return found


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A repository with a manifest in it."""
    git(tmp_path, "init", "--quiet", "--initial-branch=main", "lab")
    root = tmp_path / "lab"
    (root / "state").mkdir()
    (root / "state" / "table.yaml").write_text("kind: State\n")
    (root / "link").symlink_to("/etc")
    git(root, "add", ".")
    git(root, "commit", "--quiet", "-m", "first")
    return root


def test_git_pushes_and_fetches_as_its_role_lets_it(coordinator: Served, checkout: Path, tmp_path: Path) -> None:
    coordinator.bench()
    operator, viewer = coordinator.person("anna", "operator@shel"), coordinator.person("ben", "viewer@shel")
    stranger = coordinator.person("eve", "operator@other")
    git(checkout, "push", "--quiet", url(coordinator, operator), "main")
    assert git(checkout, "ls-remote", url(coordinator, viewer)).split()[0] == git(checkout, "rev-parse", "HEAD")
    git(tmp_path, "clone", "--quiet", url(coordinator, viewer), "other")
    assert (tmp_path / "other" / "state" / "table.yaml").read_text() == "kind: State\n"
    git(checkout, "commit", "--quiet", "--allow-empty", "-m", "second")
    for token in (viewer, stranger, "none"):
        git(checkout, "push", url(coordinator, token), "main", code=128)
    for token in (stranger, "none", ""):
        git(checkout, "ls-remote", url(coordinator, token), code=128)
    git(checkout, "push", "--quiet", url(coordinator, operator), "main")
    git(checkout, "reset", "--quiet", "--hard", "HEAD~1")
    git(checkout, "push", "--quiet", url(coordinator, operator), "main:web/anna")
    git(checkout, "push", url(coordinator, operator), "main:web/ben", code=1)
    for words in (("--force", "main"), ("--delete", "main")):
        git(checkout, "push", url(coordinator, operator), *words, code=1)
    git(checkout, "ls-remote", url(coordinator, coordinator.person("root", "admin"), "nowhere"), code=128)


def test_a_large_push_arrives_whole(coordinator: Served, checkout: Path) -> None:
    coordinator.bench()
    ours = url(coordinator, coordinator.person("anna", "operator"))
    for more in ((), ("-c", "http.postBuffer=100000000")):
        (checkout / "noise").write_bytes(os.urandom(5_000_000))
        git(checkout, "add", ".")
        git(checkout, "commit", "--quiet", "-m", "noise")
        git(checkout, *more, "push", "--quiet", ours, "main")
        assert git(checkout, "ls-remote", ours, "main").split()[0] == git(checkout, "rev-parse", "main")


def test_who_goes_in_the_middle_of_a_request_leaves_no_git_behind(coordinator: Served, checkout: Path) -> None:
    coordinator.bench()
    anna = coordinator.person("anna", "operator")
    git(checkout, "push", "--quiet", url(coordinator, anna), "main")
    head = git(checkout, "rev-parse", "main").encode()
    told = b"0032want " + head + b"\n00000009done\n"
    opening = (
        b"POST /api/git/shel/git-upload-pack HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer " + anna.encode()
        + b"\r\nContent-Type: application/x-git-upload-pack-request\r\nTransfer-Encoding: chunked\r\n\r\n"
    )  # fmt: skip
    pieces = (b"4\r\n0011\r\n", b"%x\r\n%b\r\n0\r\n\r\n" % (len(told), told))
    for sent in (*pieces, pieces[0]) * 5:
        with socket.create_connection(("127.0.0.1", coordinator.port)) as line:
            line.sendall(opening + sent)
    for _ in range(500):
        if not gits(coordinator) and not coordinator.app.state.git.total():
            break
        time.sleep(0.02)
    else:
        raise AssertionError(f"{gits(coordinator)} go on")
    assert git(checkout, "ls-remote", url(coordinator, anna)).split()[0].encode() == head


def test_a_push_adds_branches_and_tags_of_its_own_and_moves_no_tag(coordinator: Served, checkout: Path) -> None:
    coordinator.bench()
    ours = url(coordinator, coordinator.person("anna", "operator"))
    git(checkout, "push", "--quiet", ours, "main", "main:refs/tags/C1", "main:run/anna/1")
    git(checkout, "commit", "--quiet", "--allow-empty", "-m", "other")
    at = git(checkout, "rev-parse", "HEAD~1")
    refused = ("replace/" + at, "tags/main", "heads/C1", "heads/HEAD", "heads/run/ben/1", "heads/web/ben", "bisect/bad",
               "notes/x", "pico/x", "pico/sent/" + at, "tags/C1")  # fmt: skip
    for ref in refused:
        git(checkout, "push", "--force", ours, f"main:refs/{ref}", code=1)
    git(checkout, "push", ours, ":refs/tags/C1", code=1)
    assert {line.split()[1] for line in git(checkout, "ls-remote", ours).splitlines()} == {
        "HEAD", "refs/heads/main", "refs/heads/run/anna/1", "refs/tags/C1",
    }  # fmt: skip
    assert git(checkout, "ls-remote", ours, "refs/tags/C1").split()[0] == at


def test_git_is_asked_for_its_services_alone(coordinator: Served, checkout: Path) -> None:
    coordinator.bench()
    token = coordinator.person("anna", "operator@shel")
    git(checkout, "push", "--quiet", url(coordinator, token), "main")
    archive = "info/refs?service=git-upload-archive"
    for path in ("HEAD", "config", "objects/info/packs", "../shel.git/HEAD", archive, "info/refs"):
        assert coordinator.ask("GET", f"/api/git/shel/{path}", token)[0] in (404, 422), path
    for lab in ("..", "%2e%2e", "shel.git", "shel%2f..", ".git"):
        status = coordinator.ask("GET", f"/api/git/{lab}/info/refs?service=git-upload-pack", token)[0]
        assert status in (403, 404), lab


def test_an_edit_without_a_checkout_is_a_commit_on_a_branch_of_ones_own(coordinator: Served, checkout: Path) -> None:
    coordinator.bench()
    anna, ben = coordinator.person("anna", "operator@shel"), coordinator.person("ben", "operator@shel")
    git(checkout, "push", "--quiet", url(coordinator, anna), "main")
    first: dict[str, Any] = {
        "base": "main",
        "message": "p2 turned",
        "files": {"state/table.yaml": "kind: State\nx: 1\n"},
    }
    status, made = coordinator.ask("POST", EDITS, anna, first)
    assert (status, made["branch"], made["parent"]) == (200, "web/anna", git(checkout, "rev-parse", "main"))
    git(checkout, "fetch", "--quiet", url(coordinator, ben), "web/anna")
    assert git(checkout, "show", "FETCH_HEAD:state/table.yaml") == "kind: State\nx: 1"
    assert git(checkout, "log", "-1", "--format=%an %s", "FETCH_HEAD") == "anna p2 turned"
    status, stale = coordinator.ask("POST", EDITS, anna, first)
    assert (status, stale["exit"]) == (409, 4) and "web/anna holds more than main" in stale["error"][0]["summary"]
    assert coordinator.ask("POST", EDITS, ben, first)[1]["branch"] == "web/ben"
    status, next_ = coordinator.ask(
        "POST", EDITS, anna, {**first, "base": "web/anna", "files": {"state/table.yaml": None}}
    )
    assert (status, next_["parent"]) == (200, made["commit"])


def test_an_edit_reaches_manifests_alone(coordinator: Served, checkout: Path) -> None:
    coordinator.bench()
    token = coordinator.person("anna", "operator@shel")
    git(checkout, "push", "--quiet", url(coordinator, token), "main")
    edit: dict[str, Any] = {"base": "main", "message": "x"}
    paths = ("../x.yaml", "/etc/x.yaml", ".git/x.yaml", "a/../x.yaml", ".github/x.yaml", "x.py", "x.yaml/", "-/.x.yaml",
             "state/table.yaml/x.yaml", "link/x.yaml", "a\\x.yaml", "x\n.yaml", "C:x.yaml", "a//x", "")  # fmt: skip
    for path in paths:
        status, told = coordinator.ask("POST", EDITS, token, {**edit, "files": {path: "a: 1\n"}})
        assert (status, told["error"][0]["code"]) == (400, "path"), path
    for text in ("a: [", "a: {", "[" * 200 + "]" * 200):
        status, told = coordinator.ask("POST", EDITS, token, {**edit, "files": {"x.yaml": text}})
        assert status == 400 and told["error"][0]["summary"], text
    for base in ("nowhere", "main^{tree}", "--help", "main:state/table.yaml"):
        status, _ = coordinator.ask("POST", EDITS, token, {**edit, "base": base, "files": {"x.yaml": "a: 1\n"}})
        assert status in (400, 422), base
    assert "web/" not in git(checkout, "ls-remote", url(coordinator, token))


def test_large_data_is_kept_by_its_hash(coordinator: Served) -> None:
    coordinator.bench()
    operator, viewer = coordinator.person("anna", "operator@shel"), coordinator.person("ben", "viewer@shel")
    data = b"picture" * 1000
    at = f"/api/labs/shel/objects/{hashlib.sha256(data).hexdigest()}"
    assert coordinator.ask("GET", at, viewer)[0] == 404
    assert coordinator.ask("PUT", at, viewer, data)[0] == 403
    assert coordinator.ask("PUT", at, operator, b"other")[0] == 400
    assert coordinator.ask("PUT", at, operator, data)[0] == 200
    assert coordinator.ask("GET", at, viewer) == (200, data)
    for name in ("x", "..", "%2e%2e%2f%2e%2e%2fcoordinator.sqlite", "A" * 64):
        assert coordinator.ask("GET", f"/api/labs/shel/objects/{name}", viewer)[0] in (400, 404), name
