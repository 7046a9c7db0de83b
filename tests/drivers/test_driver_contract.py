"""What every driver does, through the vendor's own library, whatever happens on the wire; at its other end an emulator.

Nobody waits longer than LONGEST for anything: `within` fails where somebody does.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np
import pytest
from devices import CASES, Case
from proxy import FAULTS, Fault, Faults, Proxy

from pico.diagnostics import PicoError
from pico.drivers.bus import LONGEST
from pico.drivers.registry import Buses, driver, known
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench

T = TypeVar("T")
DRIVERS = [name for name in CASES if name in known()]
MOVING = [name for name in DRIVERS if CASES[name].moves]
AXES = [name for name in DRIVERS if CASES[name].stuck is not None]


@dataclass
class Wired:
    """A device under contract, with a proxy on its wire."""

    case: Case
    faults: Faults
    proxy: Proxy
    behind: Alone
    instrument: Any
    buses: Buses

    def other(self) -> tuple[str, Any]:
        """What is to be written behind it, to be something else."""
        return next(iter(self.case.at_first)), self.case.other

    def changed(self) -> Any:
        """What it reads then."""
        return int(self.case.other.sum()) if isinstance(self.case.other, np.ndarray) else self.case.other

    async def ready(self) -> None:
        await within(self.instrument.connect())
        if self.case.begins:
            await self.case.begins(self.instrument)


@contextmanager
def wired(name: str, **changed: Any) -> Iterator[Wired]:
    case = CASES[name]
    behind, faults, buses = Alone(case.at_first), Faults(), Buses()
    bench = EmulatedBench({"it": case.entry}, lambda n, e: behind)
    proxy = Proxy(dict(bench.entries["it"].address), faults)
    entry = replace(case.entry, address={**case.entry.address, **proxy.address}, **changed)
    try:
        yield Wired(case, faults, proxy, behind, buses.opened("it", entry), buses)
    finally:
        asyncio.run(buses.close())
        proxy.close()
        bench.close()


async def within(asked: Awaitable[T]) -> T:
    """Return what comes, or fail where it does not come in time; what a busy machine adds is not counted."""
    return await asyncio.wait_for(asked, LONGEST + 10)


def near(value: Any, **within: float) -> Any:
    """Return what a number is compared with; a name as it is."""
    return value if isinstance(value, str) else pytest.approx(value, **within)


def run(go: Callable[[], Awaitable[None]]) -> None:
    async def all_() -> None:
        await go()

    asyncio.run(all_())


def test_every_driver_of_ours_is_under_contract() -> None:
    own = {name for name, entry in known().items() if entry.value.startswith("pico.")}
    elsewhere = {n for n in own if n.split(".")[0] in ("xarm", "basler", "realsense")}
    elsewhere |= {
        "zaber.gantry",
        "switches.gripper",
    }  # test_zaber_gantry.py, tests/backends/hardware/test_gantry_of_stages.py
    assert own - elsewhere == set(CASES)
    assert {driver(name).maturity for name in CASES} == {"emulated"}


@pytest.mark.parametrize("name", DRIVERS)
def test_who_answers_is_who_the_lab_names_and_reads_what_is_there(name: str) -> None:
    with wired(name) as it:

        async def go() -> None:
            identity = await it.instrument.connect()
            assert identity.serial == it.case.entry.identity["serial"]
            if it.case.begins:
                await it.case.begins(it.instrument)
            assert await it.case.reads(it.instrument) == pytest.approx(it.case.is_, abs=1e-6)
            await it.instrument.close()
            await it.instrument.close()

        run(go)


@pytest.mark.parametrize("name", DRIVERS)
def test_another_device_is_refused_before_anything_else_is_asked(name: str) -> None:
    with wired(name, identity={"serial": "999"}) as it:

        async def go() -> None:
            for ask in (it.instrument.connect, lambda: (it.case.moves or it.case.reads)(it.instrument)):
                if not it.case.tells and ask != it.instrument.connect:
                    assert await ask() is None
                    continue
                with pytest.raises(PicoError) as other:
                    await within(ask())
                assert other.value.diagnostics[0].code == "device-identity"
                assert other.value.diagnostics[0].address == "it"

        run(go)
        assert it.behind.read(it.case.moved[0]) == it.case.at_first.get(it.case.moved[0])


@pytest.mark.parametrize("fault", [f if f == "duplicated" else pytest.param(f, marks=pytest.mark.slow) for f in FAULTS])
@pytest.mark.parametrize("name", DRIVERS)
def test_what_is_wrong_on_the_wire_is_told_or_made_good_and_never_believed(name: str, fault: Fault) -> None:
    with wired(name) as it:

        async def go() -> None:
            await it.ready()
            it.faults.fault = fault
            await _believed(it, it.case.is_)
            it.behind.write(*it.other())
            await _believed(it, it.changed())
            await _believed(it, it.changed())
            it.faults.fault = "none"
            await _well_again(it, it.changed())

        run(go)


async def _believed(it: Wired, there: Any) -> None:
    """Fail where it reads anything else than is there."""
    try:
        found = await within(it.case.reads(it.instrument))
    except PicoError as exc:
        assert exc.diagnostics[0].address == "it" and it.case.tells
    else:
        assert found is None or found == near(there, rel=1e-3, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in DRIVERS if CASES[name].entry.emulator != "elliptec"])
def test_a_link_that_was_cut_is_opened_again(name: str) -> None:
    with wired(name) as it:

        async def go() -> None:
            await it.ready()
            it.proxy.cut()
            await _well_again(it, it.case.is_)

        run(go)


async def _well_again(it: Wired, there: Any) -> None:
    """Fail where it does not read what is there again after a few tries; what it reads until then is that, or told."""
    for _ in range(4):
        try:
            found = await within(it.case.reads(it.instrument))
        except PicoError:
            continue
        if found is not None:
            assert found == near(there, rel=1e-3, abs=1e-6)
            return
    pytest.fail("it never answered again")


@pytest.mark.parametrize("name", [name for name in DRIVERS if CASES[name].beyond])
def test_beyond_its_limits_nothing_is_asked_of_it(name: str) -> None:
    with wired(name) as it:

        async def go() -> None:
            await it.ready()
            it.faults.heard.clear()
            with pytest.raises(PicoError) as limit:
                assert it.case.beyond
                await it.case.beyond(it.instrument)
            assert limit.value.diagnostics[0].code == "device-limit"

        run(go)
        assert it.faults.heard == []


@pytest.mark.parametrize("name", MOVING)
def test_it_moves_and_reads_where_it_is(name: str) -> None:
    with wired(name) as it:

        async def go() -> None:
            await it.ready()
            assert it.case.moves
            found = await it.case.moves(it.instrument)
            what, wanted = it.case.moved
            assert found == near(wanted, abs=0.01) and it.behind.read(what) == near(wanted, abs=0.01)
            if not it.case.silent:
                assert await it.case.reads(it.instrument) == pytest.approx(wanted, abs=0.01)

        run(go)


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("name", [name for name in MOVING if name not in AXES])
def test_what_it_says_that_it_switched_is_switched(name: str, fault: Fault) -> None:
    with wired(name) as it:

        async def go() -> None:
            await it.ready()
            it.faults.fault = fault
            assert it.case.moves
            try:
                found = await within(it.case.moves(it.instrument))
            except PicoError as exc:
                assert exc.diagnostics[0].address == "it"
            else:
                assert found == it.behind.read(it.case.moved[0])

        run(go)


@pytest.mark.parametrize("name", AXES)
def test_a_fault_on_the_way_is_told_by_name(name: str) -> None:
    with wired(name) as it:

        async def go() -> None:
            await it.ready()
            it.behind.write("stuck", it.case.stuck)
            with pytest.raises(PicoError) as fault:
                assert it.case.moves
                await within(it.case.moves(it.instrument))
            assert fault.value.diagnostics[0].code in ("device-fault", "device-missed")
            assert "it " in str(fault.value)

        run(go)
        assert it.behind.read(it.case.moved[0]) == pytest.approx(it.case.stuck)


@pytest.mark.parametrize("name", AXES)
def test_after_a_stop_nothing_moves_any_more(name: str) -> None:
    with wired(name) as it:
        what, wanted = it.case.moved

        async def go() -> None:
            await it.ready()
            assert it.case.moves
            moving = asyncio.create_task(it.case.moves(it.instrument))
            while not it.behind.read(what):
                await asyncio.sleep(0.001)
            await within(it.instrument.stop())
            stopped_at = it.behind.read(what)
            with pytest.raises(PicoError) as stopped:
                await within(moving)
            assert stopped.value.diagnostics[0].code == "device-stopped"
            assert await it.case.reads(it.instrument) == pytest.approx(stopped_at, abs=0.01)
            assert 0 < stopped_at < wanted and it.behind.read(what) == stopped_at

        run(go)


@pytest.mark.parametrize(
    "name", [n for n in MOVING if CASES[n].moved[1] is True and n.startswith("scpi") and not CASES[n].silent]
)
def test_after_a_stop_there_is_no_light(name: str) -> None:
    with wired(name) as it:

        async def go() -> None:
            await it.ready()
            assert it.case.moves
            await it.case.moves(it.instrument)
            await within(it.instrument.stop())
            assert await it.case.reads(it.instrument) is False

        run(go)
        assert it.behind.read(it.case.moved[0]) is False
