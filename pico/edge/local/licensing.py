"""What an edge lets emit: armings and their end, the light that samples had, and runs that run unattended."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.edge.local.apparatus import Apparatus
from pico.edge.local.sight import Sight
from pico.model.observation import Observation
from pico.model.record import as_json
from pico.places.attachment import require_attached
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.edge.armings import Kept
    from pico.edge.attempts import Executing
    from pico.edge.shutting import ActingEdge, Shutting
    from pico.edge.unattended import Alone
    from pico.model.arming import Arming
    from pico.model.trace.dose import Dose
    from pico.model.trace.unattended import Left, Terms

DISARMING = "pico laser disarm"
SHUT_WITHIN = 150
"""So often is looked whether who has the bench has shut a laser that was disarmed."""
AGAIN = 0.02
"""Seconds of wall time between two such looks."""


def _require_not_elsewhere(place: BenchPlace) -> None:
    """Raise PicoError if another worktree has the bench; a record that can't be read keeps no light on."""
    try:
        require_attached(place)
    except PicoError as exc:
        if exc.exit_code == ExitCode.LOCKED:
            raise


class Licensing:
    """Keeps armings of one bench, shuts what nothing lets emit any more, and counts the light on samples."""

    def __init__(self, apparatus: Apparatus, sight: Sight, edge: ActingEdge) -> None:
        self._apparatus, self._sight, self._edge = apparatus, sight, edge
        self._lasers: Shutting | None = None
        self._alone: Alone | None = None
        self._minded = frozenset[tuple[str, str]]()

    async def armings(self) -> tuple[Kept, ...]:
        """Return what the bench keeps of armings, broken ones, too."""
        from pico.edge.armings import kept

        return kept(self._apparatus.place)

    async def arm(self, arming: Arming) -> Arming:
        """Keep an arming, see `pico.edge.contract.EdgeLicensing`."""
        from pico.edge.armings import keep
        from pico.edge.emission import require_commissioned, require_ended
        from pico.edge.guard.table_lock import require
        from pico.policy.arming import refusal

        own = self._apparatus
        require_attached(own.place)
        require(own.place)
        if (why := own.wiring.refusal()) is not None:
            raise PicoError(why, ExitCode.DENIED)
        given = replace(arming, backend=(await own.device.describe()).name)
        if wrong := refusal(own.setup, given, own.now()):
            raise PicoError(wrong, ExitCode.DENIED)
        await require_commissioned(own.setup, own.place, own.device, own.now(), given)
        await require_ended(own.setup, own.device, given)
        keep(own.place, given)
        return given

    async def disarm(self, laser: str, by: str) -> bool:
        """End what arms a laser, and shut it; see `pico.edge.contract.EdgeLicensing`."""
        from pico.edge.armings import keep
        from pico.policy.arming import ended

        own, edge = self._apparatus, self._edge
        _require_not_elsewhere(own.place)
        now, known = own.now(), {one.laser: one.arming for one in await self.armings()}
        keep(own.place, ended(own.setup, known.get(laser), laser, by, (await own.device.describe()).name, now))
        refused: PicoError | None = None
        for _ in range(SHUT_WITHIN):
            if edge.lease is None and await edge.holder() is None:
                try:
                    await edge.release(await edge.acquire(DISARMING))
                except PicoError as exc:
                    code = exc.diagnostics[0].code
                    if exc.exit_code != ExitCode.LOCKED or code == "enrolled":
                        # nobody else shuts it: a journal that can't be used, say, or a coordinator that is far away
                        return await self._shut_unrecorded(laser)
                    if code != "locked":
                        refused = exc
            if laser not in {one.laser for one in await self.armings()}:
                return True
            await asyncio.sleep(AGAIN)
        if refused is not None:
            raise refused
        return False

    async def _shut_unrecorded(self, laser: str) -> bool:
        """Shut a laser though the bench cannot be taken as usual: light never stays on for a journal that is damaged, a
        Lab or a lock that is, or a question that is open. Nothing records it. Returns whether it is shut; raises
        PicoError."""
        from pico.edge.armings import forget
        from pico.edge.emission import shutting
        from pico.edge.lease import BenchLock
        from pico.edge.running import new_run_id

        own = self._apparatus
        lock = BenchLock(own.place, own.now)
        lock.safety = True
        try:
            token = lock.acquire(DISARMING).token
        except PicoError as exc:
            if exc.exit_code == ExitCode.LOCKED:
                raise
            token = int(time.time())  # what is in the place of the lock keeps nobody out: closing needs no lock
        try:
            await own.device.take(token, lambda _: None, lambda: None)
            try:
                operation = shutting(own.setup, await self._sight.observe(), laser, "it is disarmed")
                if operation is not None:
                    key = f"{new_run_id()}/{operation.id}/1"
                    if (await own.device.execute(operation, key, lambda _: None)).outcome != "done":
                        return False
            finally:
                await own.device.leave()
        finally:
            lock.release()
        forget(own.place, laser)
        return True

    def arming_over(self) -> bool:
        """Return whether an arming has ended since this was asked last, while the bench is free."""
        from pico.edge import emission

        own = self._apparatus
        over = frozenset(emission.over(own.setup, own.place, own.now()).items())
        if self._edge.lease is not None or over <= self._minded:
            return False
        self._minded = over
        return True

    async def shut_over(self, seen: Observation | None = None) -> None:
        """See `pico.edge.shutting.Shutting.shut_over`; for who has the bench."""
        if self._lasers is None:
            from pico.edge.shutting import Shutting

            self._lasers = Shutting(self._edge)
        await self._lasers.shut_over(seen)

    def notices(self) -> tuple[Diagnostic, ...]:
        """Return, once, which lasers were shut, and why."""
        return self._lasers.told() if self._lasers is not None else ()

    # the light on samples

    async def doses(self) -> tuple[Dose, ...]:
        """Return what the samples of the bench had; see `pico.edge.contract.EdgeLicensing`."""
        return self.doses_until(await self._sight.observe()) if self._apparatus.has_samples else ()

    def doses_until(self, seen: Observation) -> tuple[Dose, ...]:
        """Return what the samples of the bench had until it was seen so."""
        if not self._apparatus.has_samples:
            return ()
        from pico.edge.dose import read

        own = self._apparatus
        return read(own.place).until(own.setup, seen).doses(own.setup)

    def guard(self, inner: Executing, bare: Callable[[], bool]) -> Executing:
        """Return what does the same, lets light out by a licence only, and counts the light on samples. `bare` says
        that no plan asks for an operation, see `pico.edge.emission.Guarded`."""
        from pico.edge.emission import Guarded

        own, observe = self._apparatus, self._sight.observe
        guarded = Guarded(own.setup, inner, observe, bare, self.alone.most, self._refused, own.wiring.refusal)
        if not own.has_samples:
            return guarded
        from pico.edge.dose import Dosing

        return Dosing(own.setup, own.place, guarded, observe)

    def _refused(self) -> Diagnostic | None:
        """Return why a person at the table lets nothing through that goes on now, None if it is let through."""
        from pico.edge.guard.table_lock import refusal

        try:
            return refusal(self._apparatus.place, alone=self.alone.goes)
        except PicoError as exc:  # of a lock that can't be read nobody knows whose work it lets in
            return exc.diagnostics[0]

    # runs that run unattended

    @property
    def alone(self) -> Alone:
        """What holds an unattended run to its terms."""
        from pico.edge.unattended import Alone

        if self._alone is None:
            self._alone = Alone(self._edge)
        return self._alone

    async def hold(self, terms: Terms) -> Left | None:
        """Hold an unattended run to its terms; see `pico.edge.contract.EdgeLicensing`."""
        from pico.edge.guard.table_lock import require

        require_attached(self._apparatus.place)
        require(self._apparatus.place, alone=True)
        return await self.alone.hold(terms)

    def hear(self, recipe: str) -> None:
        """Hear that a recipe starts something, if one is held. Raises PicoError if the edge ended it."""
        if self._alone is not None:
            self._alone.goes_on(recipe)

    async def unattended(self) -> Terms | None:
        """Return the terms of an unattended run; see `pico.edge.contract.EdgeLicensing`."""
        from pico.edge.terms_store import is_known

        known = self._alone is not None or is_known(self._apparatus.place)
        return self.alone.known() if known else None

    def restore_terms(self) -> None:
        """Write the terms of an unattended run that was killed anew if their file is gone; raises PicoError."""
        from pico.edge.terms_store import restore

        restore(self._apparatus.place)

    def about(self) -> dict[str, Any]:
        """Return what the journal holds about a run for the terms that it is held to; nothing if it is held to none."""
        from pico.edge.terms_store import ABOUT

        terms = self._alone.terms if self._alone is not None else None
        return {} if terms is None or terms.left is not None else {ABOUT: as_json(terms)}

    async def close(self) -> None:
        """Hold nothing any more: this process ends."""
        if self._alone is not None:
            await self._alone.close()
