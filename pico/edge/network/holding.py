"""Having a bench on the network for longer than one command: taken for the checkout's session, renewed, given back."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from typing import Any, NoReturn
from urllib.parse import urlencode

from pico.control.leases import HEARTBEAT, TTL
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.network.asking import ask
from pico.edge.network.remotes import Far
from pico.edge.network.session import session_in
from pico.edge.network.trouble import Gone

SLICE = 10.0
"""Seconds that one request waits for a bench; who asks again keeps their place."""


FENCING = 10.0
"""Seconds in which an edge ends what moved before and says that it has."""


class Holding:
    """The lease of the bench `far`, as one checkout asks for it. Every method raises PicoError."""

    def __init__(self, far: Far) -> None:
        self.far, self._path = far, f"/benches/{far.lab}/{far.bench}/lease"
        self._session = session_in(far.folder)

    def show(self) -> dict[str, Any]:
        """Return who has the bench and who waits; `mine`: whether this checkout has it."""
        found: dict[str, Any] = self._ask("GET", self._path)
        holder = found.get("holder") or {}
        mine = bool(holder.get("you")) and str(holder.get("session", "")).endswith(f"/{self._session}")
        return {**found, "mine": mine}

    def take(self, wait: float = 0.0) -> int:
        """Take the bench, within `wait` seconds, and return its token; exit code LOCKED where somebody else has it."""
        until = time.monotonic() + wait
        while True:
            left = max(0.0, until - time.monotonic())
            body = {"session": self._session, "wait": min(max(left, 1.0), SLICE)}
            found = self._ask("POST", self._path, body, wait=SLICE + 20)
            if found["state"] == "granted":
                return int(found["token"])
            late = time.monotonic() - until
            if late >= 0 and (late > FENCING or self._held_by_others()):
                self._give_up(found)

    def steal(self, reason: str) -> int:
        """Take the bench from whoever has it, who is told the reason, and return its token once it is fenced."""
        body = {"session": self._session, "reason": reason}
        self._ask("POST", f"{self._path}/steal", body)
        return self.take(TTL)

    def renewed(self, token: int) -> Iterator[None]:
        """Renew a lease as often as it wants that, for as long as this is iterated over; raises PicoError (exit code
        LOCKED) once somebody else has it. A coordinator that is away for less than the lease lasts is waited for."""
        since = time.monotonic()
        while True:
            try:
                self._ask("PUT", self._path, {"session": self._session, "token": token})
                since = time.monotonic()
            except Gone:
                if time.monotonic() - since > TTL:
                    raise
            yield
            time.sleep(HEARTBEAT)

    def release(self) -> bool:
        """Give the bench back, and return whether this checkout had it; exit code LOCKED where somebody else has."""
        found = self.show()
        holder = found.get("holder")
        if holder and not found["mine"]:
            text = f"{self.far.name} is not yours to give back: {holder['who']} has it"
            hint = '`pico lease steal --reason "..."` takes it over, where you may'
            raise PicoError(error("locked", text, hint=hint), ExitCode.LOCKED)
        token = holder["token"] if holder else 0
        query = urlencode({"session": self._session, "token": token})
        return bool(self._ask("DELETE", f"{self._path}?{query}")["released"])

    def _held_by_others(self) -> bool:
        found = self.show()
        return bool(found["holder"]) and not found["mine"]

    def _give_up(self, found: Mapping[str, Any]) -> NoReturn:
        query = urlencode({"session": self._session, "token": 0})
        self._ask("DELETE", f"{self._path}?{query}")
        if not self._held_by_others():
            text = f"the edge of {self.far.name} does not take it over"
            raise PicoError(error("away", text, hint="is it there? `pico edge` beside the table connects it"))
        text = f"{found['holder']} has {self.far.name}"
        hint = "wait for it: `pico lease take --wait SECONDS`; `pico lease show` says since when, and who is next"
        raise PicoError(error("locked", text, hint=hint), ExitCode.LOCKED)

    def _ask(self, method: str, path: str, body: Any = None, wait: float = 10.0) -> Any:
        return ask(self.far.remote, method, path, body, wait=wait)
