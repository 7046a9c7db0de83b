"""With which coordinator a bench is enrolled: its address, the bench's name there, and the key that both have.

The key is 32 random bytes, made here once and told the coordinator once, with a code that a person of the lab got for
it. From then on each shows the other by HMAC-SHA256 over fresh nonces that it has the key, which travels no more; a
coordinator that has it not is not the one that the bench was enrolled with. Where the coordinator's certificate is its
own, its SHA-256 is pinned, too.
"""

from __future__ import annotations

import hashlib
import http.client
import json
import os
import re
import secrets
import ssl
from dataclasses import asdict, dataclass
from urllib.parse import SplitResult, urlsplit

from pico.base.state_files import ENROLMENT
from pico.diagnostics import PicoError, error
from pico.edge.network.messages import read
from pico.places.bench import BenchPlace

ANSWER = 20.0
"""Seconds in which a coordinator answers."""
_SHA256 = re.compile("[0-9a-f]{64}")
_LOCAL = ("127.0.0.1", "::1", "localhost")


@dataclass(frozen=True)
class Enrolment:
    """`bench`: its name at the coordinator (`lab/bench1`); `key` as hexadecimal digits; `pin`: SHA-256 of the
    coordinator's certificate, empty where authorities that this machine trusts answer for that."""

    url: str
    bench: str
    key: str
    pin: str = ""

    @property
    def link(self) -> str:
        """The address of the socket."""
        return "ws" + self.url.removeprefix("http") + "/api/edge/link"

    @property
    def is_local(self) -> bool:
        """Whether the coordinator is on this machine."""
        return urlsplit(self.url).hostname in _LOCAL

    def context(self) -> ssl.SSLContext | None:
        """Return how the coordinator's certificate is looked at; None without TLS."""
        return _context(self.pin) if self.url.startswith("https:") else None

    def require_pinned(self, certificate: bytes | None) -> None:
        """Raise PicoError where a pinned coordinator shows another certificate."""
        _require_pinned(self.url, self.pin, certificate)


def read_enrolment(place: BenchPlace) -> Enrolment | None:
    """Return with whom the bench at `place` is enrolled; None where with nobody. Raises PicoError where its
    file can't be read."""
    return ENROLMENT.read(ENROLMENT.path(place.folder), lambda document: Enrolment(**document))


def enrol(place: BenchPlace, url: str, code: str, pin: str = "") -> Enrolment:
    """Enrol the bench at `place` with the coordinator at `url`, by a code that was given for it; only that
    one grants it from then on. Raises PicoError."""
    where, key = _checked(url), secrets.token_bytes(32)
    pin = pin.rpartition("=")[2].replace(":", "").strip().lower()  # also as openssl prints it, with a name before
    if pin and not _SHA256.fullmatch(pin):
        hint = "64 hexadecimal digits, as `openssl x509 -noout -fingerprint -sha256 -in lab.pem` prints them"
        raise PicoError(error("enrolment", f"`{pin[:80]}` is no SHA-256 of a certificate", hint=hint))
    found = _posted(where, pin, {"code": code, "key": key.hex()})
    enrolment = Enrolment(where.geturl(), str(found["bench"]), key.hex(), pin)
    mask = os.umask(0o077)
    try:
        ENROLMENT.write(ENROLMENT.path(place.folder), asdict(enrolment), indent=1)
    finally:
        os.umask(mask)
    return enrolment


def withdraw(place: BenchPlace) -> None:
    """Let the bench at `place` be granted by itself again."""
    ENROLMENT.path(place.folder).unlink(missing_ok=True)


def _checked(url: str) -> SplitResult:
    where = urlsplit(url.rstrip("/"))
    if where.scheme not in ("http", "https") or not where.hostname:
        text = f"`{url}` is no address of a coordinator"
        raise PicoError(error("usage", text, hint="such as https://lab.example.org"))
    if where.scheme == "http" and where.hostname not in _LOCAL:
        hint = "serve it over TLS (`pico serve --certificate --key`, or behind a proxy), and say https://"
        raise PicoError(error("usage", f"{url} is another machine, and not spoken to without TLS", hint=hint))
    return where


def _posted(where: SplitResult, pin: str, document: dict[str, str]) -> dict[str, object]:
    host, port = str(where.hostname), where.port
    line: http.client.HTTPConnection
    try:
        if where.scheme == "https":
            line = http.client.HTTPSConnection(host, port, timeout=ANSWER, context=_context(pin))
        else:
            line = http.client.HTTPConnection(host, port, timeout=ANSWER)
        line.connect()
        if isinstance(line.sock, ssl.SSLSocket):
            _require_pinned(where.geturl(), pin, line.sock.getpeercert(binary_form=True))
        body, kind = json.dumps(document), {"Content-Type": "application/json"}
        line.request("POST", f"{where.path}/api/edge/enrol", body, kind)
        answer = line.getresponse()
        status, data = answer.status, answer.read(1 << 16)
        line.close()
    except ssl.SSLCertVerificationError as exc:
        text = f"{where.geturl()} is not known for what it says it is: {exc.verify_message}"
        hint = "if it signed its certificate itself: `--pin` with the SHA-256 of that, by `openssl x509 -noout"
        raise PicoError(error("certificate", text, hint=f"{hint} -fingerprint -sha256 -in lab.pem`")) from exc
    except (OSError, http.client.HTTPException) as exc:
        raise PicoError(error("link", f"{where.geturl()} does not answer: {exc}", hint="is it served there?")) from exc
    if status != 200:
        hint = "an admin of the coordinator gives one: `pico token enrol LAB/BENCH`"
        raise PicoError(error("enrolment", f"{where.geturl()} does not take this code ({status})", hint=hint))
    return read(data)


def _context(pin: str) -> ssl.SSLContext:
    context = ssl.create_default_context()
    if pin:  # this one certificate is trusted, whoever signed it; it is compared before anything is said
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


def _require_pinned(url: str, pin: str, certificate: bytes | None) -> None:
    shown = hashlib.sha256(certificate or b"").hexdigest()
    if pin and shown != pin:
        text = f"{url} shows another certificate than is pinned: its SHA-256 begins with {shown[:16]}, not {pin[:16]}"
        hint = "if it was renewed: `pico edge enrol` again, with the new `--pin`"
        raise PicoError(error("enrolment", text, hint=hint))
