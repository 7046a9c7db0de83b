"""A coordinator with a certificate that it signed itself, its edge and a client, each in a process of its own."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import signal
import ssl
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

Said = subprocess.CompletedProcess[str]


@pytest.fixture
def pico(tmp_path: Path) -> Callable[..., Said]:
    def run(*words: str) -> Said:
        return subprocess.run([*PICO, *words], check=False, env=_own(tmp_path), capture_output=True, text=True)

    return run


PICO = [sys.executable, "-m", "pico_cli"]


def _own(folder: Path) -> dict[str, str]:
    return os.environ | {"XDG_CONFIG_HOME": str(folder / "config")}


@contextmanager
def going_on(folder: Path, *words: str) -> Iterator[dict[str, str]]:
    """A command that goes on until SIGTERM, and what it said as JSON as it began."""
    with subprocess.Popen([*PICO, "--json", *words], stdout=subprocess.PIPE, text=True, env=_own(folder)) as process:
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())
        finally:
            process.send_signal(signal.SIGTERM)
            assert process.wait() == 0


def certificate(folder: Path) -> tuple[Path, Path, str]:
    """Return a certificate of localhost that nobody else signed, its key, and its SHA-256."""
    shown, key = folder / "lab.pem", folder / "lab.key"
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", shown, "-days", "2",
         "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"],
        check=True, capture_output=True,
    )  # fmt: skip
    return shown, key, hashlib.sha256(ssl.PEM_cert_to_DER_cert(shown.read_text())).hexdigest()


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl makes the certificate")
def test_clients_know_it_by_its_certificate_and_edges_by_its_pin(tmp_path: Path, pico: Callable[..., Said]) -> None:
    shown, key, pin = certificate(tmp_path)
    desk, table = str(tmp_path / "desk"), str(tmp_path / "table")
    for folder in (desk, table):
        assert pico("init", "--example", "minimal", folder).returncode == 0
    served = ("serve", "--folder", str(tmp_path / "books"), "--port", "0", "--certificate", str(shown))
    with going_on(tmp_path, *served, "--key", str(key)) as coordinator:
        url = coordinator["url"]
        assert url.startswith("https://")
        stranger = pico("login", url, "--code", coordinator["code"])
        assert stranger.returncode == 1 and f"pico login {url} --certificate FILE" in stranger.stderr
        known = pico("login", url, "--code", coordinator["code"], "--certificate", str(shown))
        assert "You are admin" in known.stdout and "admin" in pico("token", "people").stdout  # in no checkout
        assert pico("-C", desk, "remote", "add", "lab", url).returncode == 0
        made = json.loads(pico("-C", desk, "--json", "token", "enrol", "minimal/bench1").stdout)["enrolment"]
        enrol = ("-C", table, "edge", "enrol", url, "--code", made["code"])
        unpinned, wrong = pico(*enrol), pico(*enrol, "--pin", "00" + pin[2:])
        assert unpinned.returncode == 1 and "`--pin` with the SHA-256" in unpinned.stderr
        assert wrong.returncode == 1 and "another certificate" in wrong.stderr and pin[:16] in wrong.stderr
        assert "is no SHA-256" in pico(*enrol, "--pin", pin[2:]).stderr
        printed = ":".join(pin[n : n + 2] for n in range(0, 64, 2)).upper()  # as openssl prints it
        assert pico(*enrol, "--pin", f"sha256 Fingerprint={printed}").returncode == 0
        with going_on(tmp_path, "-C", table, "edge"):
            applied = pico("-C", desk, "--bench", "minimal/bench1", "apply", "-y")
    assert applied.returncode == 0 and "The bench equals the manifest." in applied.stdout, applied.stderr
