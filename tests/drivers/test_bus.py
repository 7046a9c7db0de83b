"""A bus: one thread, a deadline for each call, and what hangs is left behind without doing any more."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable

import pytest

from pico.diagnostics import PicoError, error
from pico.drivers import bus as bus_file
from pico.drivers.bus import Bus
from pico.drivers.line import Line
from pico.drivers.protocols import Identity


class Link:
    """A link that hangs while `hung` is not set."""

    def __init__(self, number: int) -> None:
        self.number, self.closed, self.said = number, threading.Event(), list[str]()
        self.hung = threading.Event()

    def hang(self) -> None:
        self.hung.wait(20)


class Wire:
    """Links as they are opened."""

    def __init__(self) -> None:
        self.links: list[Link] = []

    def bus(self) -> Bus[Link]:
        return Bus(self.opened, lambda link: link.closed.set())

    def opened(self) -> Link:
        self.links.append(Link(len(self.links)))
        return self.links[-1]

    def let_go(self) -> None:
        for link in self.links:
            link.hung.set()


def code(wrong: pytest.ExceptionInfo[PicoError]) -> str:
    return wrong.value.diagnostics[0].code


def test_calls_of_a_bus_share_a_link_and_a_thread() -> None:
    wire = Wire()
    bus = wire.bus()

    async def go() -> list[tuple[int, int]]:
        asked = [bus.ask("a", "read", lambda link: (link.number, threading.get_ident())) for _ in range(5)]
        found = await asyncio.gather(*asked)
        await bus.close()
        return list(found)

    assert len(set(asyncio.run(go()))) == 1 and wire.links[0].closed.is_set()


def test_what_is_late_is_named_and_the_next_call_has_a_new_link() -> None:
    wire = Wire()
    bus = wire.bus()

    async def go() -> int:
        with pytest.raises(PicoError) as late:
            await bus.ask("p1", "read its angle", lambda link: link.hang(), within=0.05)
        assert code(late) == "device-late" and late.value.diagnostics[0].address == "p1"
        assert "p1 did not answer" in str(late.value) and "read its angle" in str(late.value)
        number = await bus.ask("p1", "read its angle", lambda link: link.number)
        await bus.close()
        return number

    assert asyncio.run(go()) == 1
    assert wire.links[0].closed.wait(5), "the link that hung is closed"
    wire.let_go()


def test_who_was_left_behind_does_no_more_when_it_comes_back() -> None:
    wire = Wire()
    bus = wire.bus()
    moved = threading.Event()

    async def go() -> threading.Thread:
        worker: list[threading.Thread] = []

        def hang(link: Link) -> None:
            worker.append(threading.current_thread())
            link.hang()

        with pytest.raises(PicoError):
            await bus.ask("arm", "move", lambda link: moved.set(), before=hang, within=0.05)
        await bus.close()
        return worker[0]

    left_behind = asyncio.run(go())
    wire.let_go()
    left_behind.join(5)
    assert not left_behind.is_alive() and not moved.is_set()


def test_who_waits_behind_what_hangs_gets_its_turn_on_the_new_link() -> None:
    wire = Wire()
    bus = wire.bus()

    async def go() -> int:
        hung = asyncio.create_task(bus.ask("a", "read", lambda link: link.hang(), within=0.2))
        await asyncio.sleep(0)
        number = await bus.ask("b", "read", lambda link: link.number, within=0.2)
        with pytest.raises(PicoError):
            await hung
        await bus.close()
        return number

    assert asyncio.run(go()) == 1
    wire.let_go()


def test_a_cancelled_call_that_has_not_begun_never_does() -> None:
    wire = Wire()
    bus = wire.bus()
    moved = threading.Event()

    async def go() -> None:
        begun, on = threading.Event(), threading.Event()
        first = asyncio.create_task(bus.ask("a", "read", lambda link: (begun.set(), on.wait(5))))
        while not begun.is_set():
            await asyncio.sleep(0)
        second = asyncio.create_task(bus.ask("a", "move", lambda link: moved.set()))
        await asyncio.sleep(0)
        second.cancel()
        await asyncio.gather(second, return_exceptions=True)
        on.set()
        await first
        await bus.ask("a", "read", lambda link: None)
        await bus.close()

    asyncio.run(go())
    assert not moved.is_set()


def failing(exc: Exception) -> Callable[[Link], None]:
    def fail(link: Link) -> None:
        raise exc

    return fail


@pytest.mark.parametrize(
    ("exc", "told", "links"),
    [(OSError("no such cable"), "device-lost", 2), (PicoError(error("device-fault", "too hot")), "device-fault", 1)],
)
def test_what_a_device_says_leaves_the_link_and_what_breaks_it_does_not(exc: Exception, told: str, links: int) -> None:
    wire = Wire()
    bus = wire.bus()

    async def go() -> None:
        with pytest.raises(PicoError) as wrong:
            await bus.ask("a", "read", failing(exc))
        assert code(wrong) == told
        await bus.ask("a", "read", lambda link: None)
        await bus.close()

    asyncio.run(go())
    assert len(wire.links) == links


def test_a_stop_goes_first_and_what_waits_to_move_never_does() -> None:
    wire = Wire()
    line = Line("arm", wire.bus(), {}, lambda link: Identity(vendor="v", model="m", serial="s"))
    order: list[str] = []

    async def go() -> None:
        begun, on = threading.Event(), threading.Event()
        first = asyncio.create_task(line.ask("read", lambda link: (begun.set(), on.wait(5))))
        while not begun.is_set():
            await asyncio.sleep(0)
        move = asyncio.create_task(line.move("move", lambda link: order.append("moved")))
        read = asyncio.create_task(line.ask("read", lambda link: order.append("read")))
        await asyncio.sleep(0)
        stop = asyncio.create_task(line.stop(lambda link: order.append("stopped")))
        await asyncio.sleep(0)
        on.set()
        with pytest.raises(PicoError) as stopped:
            await move
        assert code(stopped) == "device-stopped"
        await asyncio.gather(first, read, stop)
        await line.move("move", lambda link: order.append("moved again"))
        await line.close()

    asyncio.run(go())
    assert order == ["stopped", "read", "moved again"]


def test_after_a_lost_link_it_is_asked_again_who_answers() -> None:
    wire = Wire()
    serials = iter(["1", "2"])
    line = Line("p1", wire.bus(), {"serial": "1"}, lambda link: Identity(vendor="v", model="m", serial=next(serials)))
    moved: list[int] = []

    async def go() -> None:
        assert (await line.connect()).serial == "1"
        with pytest.raises(PicoError):
            await line.ask("read", failing(OSError("pulled")))
        with pytest.raises(PicoError) as other:
            await line.move("move", lambda link: moved.append(1))
        assert code(other) == "device-identity" and "its serial is `2`, the lab's is `1`" in str(other.value)
        await line.close()

    asyncio.run(go())
    assert moved == []


def test_a_link_is_looked_after_while_nobody_asks_anything(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is let go of once it says twice in a row that it is lost; the next call has a new one."""
    monkeypatch.setattr(bus_file, "BEAT", 0.001)
    wire, beats = Wire(), list[int]()

    def alive(link: Link) -> None:
        beats.append(link.number)
        if link.number == 0 and len(beats) in (2, 5, 6):
            raise ConnectionError("nothing was heard of it")

    bus = Bus(wire.opened, lambda link: link.closed.set(), alive)

    async def go() -> int:
        await bus.ask("a", "read", lambda link: link.number)
        assert await asyncio.to_thread(wire.links[0].closed.wait, 20)
        assert beats == [0] * 6 and bus.lost == "nothing was heard of it"
        number = await bus.ask("a", "read", lambda link: link.number)
        await bus.close()
        return number

    assert asyncio.run(go()) == 1
    assert bus.lost == "nothing was heard of it", "who was got ready by that link is to know"
