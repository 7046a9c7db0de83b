"""A run where nobody is there, held to its terms by the edge, also where its client is killed, hangs, or is cut off.

The terms are kept as `pico.edge.terms_store` says. Who holds a run to them has a kernel lock beside them, which is free
once that process has died: the next one that takes the bench then shuts it and puts out its lamps, as the terms state.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

from pico.base import clock
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.edge import emission
from pico.edge.protocol import RECIPE, Job
from pico.edge.terms_store import alive, erase, lock, mark, read, write
from pico.model.arming import LaserClass
from pico.model.observation import Observation
from pico.model.operation import Operation, Reason
from pico.model.setup import Setup
from pico.model.trace.unattended import LAMPS_OFF, PARKED, SHUT, Left, Terms
from pico.places.bench import BenchPlace
from pico.policy.arming import lasers

if TYPE_CHECKING:
    from pico.backends.device import Capabilities
    from pico.edge.protocol import Lease
    from pico.model.trace.report import RunReport

LAMP = "illumination"
"""The tunable of what lights the table."""
LOOKS = 0.2
"""Seconds between two looks at whether a run is over by its terms."""
SILENCE = 660.0
"""Seconds in which a client has to say that it goes on, where its terms do not leave it longer (`Terms.every`)."""
GRACE = 60.0
"""So much longer may it take than its terms say [s], and so long may the bench take to get free at the end."""
KILLED = "its process was killed"
GONE = "its client is gone: it was killed, or its link was lost"


class Held(Protocol):
    """The edge that holds a run, see `pico.edge.local`."""

    @property
    def setup(self) -> Setup: ...

    @property
    def place(self) -> BenchPlace: ...

    async def describe(self) -> Capabilities: ...
    async def observe(self) -> Observation: ...
    async def acquire(self, holder: str, wait: float = 0.0) -> Lease: ...
    async def release(self, lease: Lease) -> None: ...
    async def start(self, job: Job, run: str) -> str: ...
    async def report(self, run: str) -> RunReport: ...
    async def end_of(self, holder: str) -> None: ...
    def now(self) -> str: ...
    def moving(self) -> bool: ...


class Alone:
    """What holds a run on one edge to its terms. `left_as`: how it is left, while that comes about."""

    def __init__(self, edge: Held) -> None:
        self._edge = edge
        self.terms: Terms | None = None
        self._lock: int | None = None
        self._watching: asyncio.Task[None] | None = None
        self._ending = asyncio.Lock()
        self._left_as: Left | None = None
        self._heard = 0.0

    async def hold(self, terms: Terms) -> Left | None:
        """Hold a run to its terms from now on; return how the edge left the bench when it ended that run before. Raises
        PicoError (exit code LOCKED) where one is held."""
        before, place = read(self._edge.place), self._edge.place
        if before is not None and before.recipe != terms.recipe and before.left is None and not alive(place):
            await self._edge.release(await self._edge.acquire("the end of an unattended run", GRACE))
        self._lock = lock(place)
        if self._lock is None:
            who = before.recipe if before else "another one"
            text = f"the unattended run {who} is under way"
            raise PicoError(error("locked", text, hint="`pico stop` ends it"), ExitCode.LOCKED)
        self.terms, self._heard = replace(terms, left=None), time.monotonic()
        write(place, self.terms)
        mark(self._lock, self.terms)
        self._watching = asyncio.create_task(self._watch())
        return before.left if before is not None and before.recipe == terms.recipe else None

    def goes_on(self, recipe: str) -> None:
        """Hear that the client of a run is there, and goes on. Raises PicoError (exit code INTERRUPTED) where the edge
        ended it."""
        if self.terms is None or self.terms.recipe != recipe:
            return
        self._heard = time.monotonic()
        if self.terms.left is not None:
            raise PicoError(ended(self.terms.left), ExitCode.INTERRUPTED)

    async def leave(self, recipe: str, *, moves: bool) -> Left:
        """Bring the bench to the end state of a run, unless the edge did so already, and hold it no more. Where nothing
        `moves` any more arms stay where they are, and the run may go on later."""
        async with self._ending:
            if self.terms is None or self.terms.recipe != recipe:
                return Left()
            left = self.terms.left or await self._bring("", moves)
            if moves and not left.why:
                erase(self._edge.place)
            self._drop()
            return left

    async def gone(self, recipe: str) -> None:
        """Hear that the client of a run is gone."""
        async with self._ending:
            if self.terms is not None and self.terms.recipe == recipe:
                await self._give_up(GONE, moves=True)

    async def close(self) -> None:
        """Hold nothing any more: this process ends."""
        async with self._ending:
            await self._give_up("the process of the bench ended", moves=False)

    async def _give_up(self, why: str, moves: bool) -> None:
        if self.terms is not None and self.terms.left is None:
            await self._bring(why, moves)
        self._drop()

    def _drop(self) -> None:
        if self._watching is not None:
            self._watching.cancel()
        if self._lock is not None:
            if self.terms is not None and self.terms.left is not None:
                mark(self._lock, None)
            os.close(self._lock)
        self.terms = self._lock = self._watching = None

    # while it goes on

    @property
    def goes(self) -> bool:
        """Whether a run is held to its terms now."""
        return self.terms is not None and self.terms.left is None

    def most(self) -> LaserClass | None:
        """Return the highest class that a laser may emit as now; None where no run is held to one."""
        return self.terms.laser_class if self.terms is not None and self.terms.left is None else None

    async def _watch(self) -> None:
        while self.terms is not None and self.terms.left is None:
            await asyncio.sleep(LOOKS)
            if self.terms is not None and (why := self._over(self.terms)):
                async with self._ending:
                    if self.terms is not None and self.terms.left is None:
                        await self._bring(why, moves=True)

    def _over(self, terms: Terms) -> str:
        if clock.seconds_between(terms.until, self._edge.now()) >= 0:
            return f"it was to end at {terms.until}"
        if self._edge.moving():
            self._heard = time.monotonic()
        silent = time.monotonic() - self._heard
        return f"its client said nothing for {silent:.0f} s" if silent > max(terms.every, SILENCE) + GRACE else ""

    def known(self) -> Terms | None:
        """Return the terms of the run that goes on, or of the last one that was not left by its client as it states;
        None for none. Of one whose process has died, and that nobody tidied up after yet, `left` says so."""
        if self.terms is not None:
            return self.terms
        before = self._due()
        if before is None:
            return read(self._edge.place)
        text = f"the bench is not left {', '.join(before.end) or 'as it stood'} yet"
        wrong = error("unattended", text, hint="`pico recover` does so, and so does whatever takes the bench next")
        return replace(before, left=Left(why=KILLED, wrong=(wrong,)))

    # its end

    async def _bring(self, why: str, moves: bool) -> Left:
        """End what the run has under way, and bring about its end state."""
        assert self.terms is not None
        edge, terms = self._edge, self.terms
        self._left_as = Left(why=why)
        try:
            await edge.end_of(f"{RECIPE} {terms.recipe}")
            await edge.release(await edge.acquire(f"the end of {terms.recipe}", GRACE))  # shuts it, see `tidies`
            await self._found(terms, await edge.observe())
            if PARKED in terms.end:
                await self._park(terms, moves)
        except PicoError as exc:
            self._wrong(f"the bench is not left as {terms.recipe.partition('@')[0]} states", exc)
        left, self._left_as = self._left_as, None
        self.terms = replace(terms, left=left)
        with suppress(PicoError):  # a full disk must not hide how the bench was left
            write(edge.place, self.terms)
        return left

    def due(self) -> bool:
        """Return whether an end state is to be brought about now."""
        return self._due() is not None

    def told(self, done: Operation) -> Diagnostic:
        """Return what is said of an operation that brought about a part of it."""
        text = f"{done.address} was set to {done.arguments['to']}: {done.reason.text}"
        return warning("unattended", text, address=done.component)

    def tidies(self, setup: Setup, seen: Observation) -> Iterator[Operation]:
        """Yield what brings lasers and lamps to the end state of a run that ends now, or whose process has died."""
        terms = self._due()
        if terms is None:
            return
        known = set[str]()
        why = f"the unattended run {terms.recipe.partition('@')[0]} is over"
        shut = (emission.shutting(setup, seen, name, why) for name in lasers(setup)) if SHUT in terms.end else ()
        dark = _dark(setup, seen, why) if LAMPS_OFF in terms.end else ()
        for one in (*shut, *dark):
            if one is not None and one.address not in known:
                known.add(one.address)
                yield one

    def _due(self) -> Terms | None:
        """Return the terms whose end state is due now."""
        if self._left_as is not None:
            return self.terms
        if self.terms is not None:
            return None
        before = read(self._edge.place)
        return before if before is not None and before.left is None and not alive(self._edge.place) else None

    def tidied(self, done: tuple[Operation, ...]) -> None:
        """Hear what was done of that; of a run whose process has died it is written down."""
        was = {one.address: one.arguments["from"] for one in done if one.arguments.get("from") is not None}
        if self._left_as is not None:
            self._left_as = replace(self._left_as, was=was)
        elif (before := self._due()) is not None:
            reached = tuple(end for end in before.end if end != PARKED)
            left = Left(why=KILLED, reached=reached, was=was)
            write(self._edge.place, replace(before, left=left))
            if (file := lock(self._edge.place)) is not None:
                mark(file, None)
                os.close(file)

    async def _found(self, terms: Terms, seen: Observation) -> None:
        setup = self._edge.setup
        emits = [name for name in lasers(setup) if emission.shutting(setup, seen, name, "") is not None]
        if SHUT in terms.end and not emits:
            self._reached(SHUT)
        elif SHUT in terms.end:
            self._wrong(f"{', '.join(emits)} may emit still", hint=f"`pico laser disarm {emits[0]}`")
        lit = [one.component for one in _dark(setup, seen, "")]
        if LAMPS_OFF in terms.end and not lit:
            self._reached(LAMPS_OFF)
        elif LAMPS_OFF in terms.end:
            self._wrong(f"{', '.join(lit)} may be lit still")

    async def _park(self, terms: Terms, moves: bool) -> None:
        from pico.edge.running import new_run_id
        from pico.motion.deferred import DeferredMotion
        from pico.planning import Planner, park

        edge, seen = self._edge, await self._edge.observe()
        robots = edge.setup.lab.robots
        away = [n for n, one in sorted(seen.robots.items()) if one.holding or not robots[n].is_parked(one.joints)]
        if away and moves:
            able = await edge.describe()
            planner = Planner(edge.setup, DeferredMotion(edge.setup), seen, able.name, able.fidelity)
            plan = planner.plan(park(planner)).for_recipe(terms.recipe, "unattended")
            if plan.operations:
                await edge.report(await edge.start(Job(plan=plan, holder="the edge", wait=GRACE), new_run_id()))
            seen = await edge.observe()
        for name, one in sorted(seen.robots.items()):
            if one.holding or not robots[name].is_parked(one.joints):
                held = f" and holds {one.holding}" if one.holding else ""
                self._wrong(f"{name} stands where it stopped{held}", hint="`pico recover`")
                return
        self._reached(PARKED)

    def _reached(self, end: str) -> None:
        assert self._left_as is not None
        self._left_as = replace(self._left_as, reached=(*self._left_as.reached, end))

    def _wrong(self, text: str, exc: PicoError | None = None, hint: str = "") -> None:
        assert self._left_as is not None
        said = f"{text}: {exc.diagnostics[0].summary}" if exc else text
        found = error("unattended", said, hint=exc.diagnostics[0].hint if exc else hint)
        self._left_as = replace(self._left_as, wrong=(*self._left_as.wrong, found))


def ended(left: Left) -> Diagnostic:
    """Return that the edge ended a run by itself."""
    text = f"the edge ended the run: {left.why}"
    return error("unattended", text, hint="`pico run --resume --unattended` goes on with it")


def _dark(setup: Setup, seen: Observation, why: str) -> Iterator[Operation]:
    """Yield what puts out the lamps that are lit, or of which nobody knows."""
    for name in sorted(setup.lab.inventory):
        now = seen.known_values.get(name, {}).get(LAMP)
        if LAMP in setup.type_of(name).tunables and now is not False:
            yield Operation(
                id=f"dark_{name}", primitive="set", component=name, reason=Reason(kind="interlock", text=why),
                arguments={"tunable": LAMP, "from": now, "to": False}, resources=(f"{name}.{LAMP}", name),
            )  # fmt: skip
