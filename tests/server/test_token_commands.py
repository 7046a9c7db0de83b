"""`pico serve`, `pico login` and `pico token`, from the first start of a coordinator to a token revoked."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

Pico = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def serving(tmp_path: Path) -> Iterator[Any]:
    """A coordinator in a process of its own, and what it said as it began."""
    words = [sys.executable, "-m", "pico_cli", "serve", "--folder", str(tmp_path / "books"), "--port", "0", "--json"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())
        finally:
            process.send_signal(signal.SIGTERM)
            assert process.wait() == 0


@pytest.fixture
def pico(tmp_path: Path) -> Pico:
    def run(*words: str, at: str = "config", **variables: str) -> subprocess.CompletedProcess[str]:
        environment = os.environ | {"XDG_CONFIG_HOME": str(tmp_path / at)} | variables
        return subprocess.run(
            [sys.executable, "-m", "pico_cli", *words],
            check=False, env=environment, cwd=tmp_path, capture_output=True, text=True,
        )  # fmt: skip

    return run


@pytest.mark.slow
def test_the_first_admin_invites_somebody_whose_token_is_then_ended(serving: Any, pico: Pico, tmp_path: Path) -> None:
    assert (tmp_path / "books").stat().st_mode & 0o077 == 0
    assert (tmp_path / "books" / "coordinator.sqlite").stat().st_mode & 0o077 == 0
    url = serving["url"]
    assert pico("token", "list").stderr.startswith("error[remote]: no coordinator is known here")
    assert "You are admin at" in pico("login", url, "--code", serving["code"]).stdout
    again = pico("login", url, "--code", serving["code"], at="thief")
    assert again.returncode == 7 and "does not take this code" in again.stderr
    invited = json.loads(pico("token", "invite", "anna", "operator@shel", "--json").stdout)
    shown = pico("login", url, "--code", invited["made"]["secret"], at="anna").stdout
    assert "You are anna" in shown and "operator@shel" in shown
    assert [row["name"] for row in json.loads(pico("token", "people", "--json").stdout)["people"]] == ["admin", "anna"]
    refused = pico("token", "people", at="anna")
    assert refused.returncode == 7 and "anna has not the role admin" in refused.stderr
    made = json.loads(pico("token", "add", "night", "--role", "viewer@shel", "--json", at="anna").stdout)["made"]
    by_itself = {"at": "none", "PICO_TOKEN": made["secret"]}
    assert made["id"] in pico("token", "list", "--remote", url, **by_itself).stdout
    assert pico("token", "revoke", made["id"]).stdout == f"Token {made['id']} lets nobody in any more.\n"
    assert pico("token", "list", "--remote", url, **by_itself).returncode == 7
    assert pico("token", "role", "anna").stdout == "anna  may nothing any more\n"
    assert pico("token", "list", at="anna").returncode == 7
    audit = pico("token", "audit")
    assert audit.returncode == 0 and audit.stdout.endswith("Every entry is as it was written.\n")
    assert f"revoke anna/{made['id']}" in audit.stdout and "principal anna" in audit.stdout
    assert pico("token", "audit", at="anna").returncode == 7
    bad = pico("token", "role", "anna", "viewr@shel")
    assert bad.returncode == 1 and "did you mean `viewer`?" in bad.stderr
    assert "pico_code_" not in (tmp_path / "books" / "coordinator.sqlite").read_bytes().decode("latin-1")


@pytest.mark.slow
def test_a_port_that_is_taken_and_an_address_without_tls_are_refused(serving: Any, pico: Pico, tmp_path: Path) -> None:
    port = serving["url"].rpartition(":")[2]
    taken = pico("serve", "--folder", "other", "--port", port)
    assert (taken.returncode, taken.stdout) == (5, "") and f"port {port}" in taken.stderr
    for host in ("0.0.0.0", "::", "192.0.2.1"):
        answer = pico("serve", "--folder", "other", "--port", "0", "--host", host)
        assert answer.returncode == 1 and answer.stderr.startswith("error[insecure]: "), host
    missing = pico("serve", "--folder", "other", "--port", "0", "--certificate", "no.pem", "--key", "no.key")
    assert missing.returncode == 1 and missing.stderr.startswith("error[tls]: there is no file no.pem"), missing.stderr
    alone = pico("serve", "--folder", "other", "--port", "0", "--key", "no.key")
    assert alone.returncode == 1 and "a key without a certificate" in alone.stderr
    unknown = pico("serve", "--folder", "none", "--port", "0", "--demo", "shell")
    assert "did you mean `shel`" in unknown.stderr and not (tmp_path / "none").exists()
