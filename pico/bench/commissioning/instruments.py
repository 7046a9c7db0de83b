"""Steps that ask instruments and move nothing: who answers, and whether that is who stands there."""

from __future__ import annotations

from dataclasses import replace

from pico.bench.commissioning.standing import AtBench, Found
from pico.diagnostics import PicoError
from pico.drivers.checking import reading
from pico.drivers.registry import driver
from pico.model.record import as_json


def devices(at: AtBench) -> Found:
    """Every device of the lab's files answers, is the one that they name, and can be read. Raises PicoError."""
    links = at.device.links
    bench = at.bench.wait(links.instruments())
    if lacking := [replace(one, severity="error") for why in bench.lacking.values() for one in why]:
        raise PicoError(lacking)
    found = {
        name: {
            "driver": entry.driver,
            "tried": driver(entry.driver).maturity,
            "identity": as_json(bench.who[name]),
            "reads": at.bench.wait(reading(driver(entry.driver).kind, bench.all[name])),
        }
        for name, entry in links.entries.items()
    }
    return Found(told=f"{len(found)} devices answer", data={"devices": found})


def identities(at: AtBench) -> Found:
    """A person has compared who answers with what stands on the table. Raises PicoError."""
    who = at.bench.wait(at.device.links.instruments()).who
    entries = at.device.links.entries
    for name, one in who.items():
        own = entries[name].of or name
        at.asks.say(
            f"  {name} of {own}: {one.vendor} {one.model}, serial {one.serial or 'none'}, {one.firmware or '-'}"
        )
    unnamed = sorted(name for name, entry in entries.items() if "serial" not in entry.identity)
    if unnamed:
        at.asks.say(f"  The files name no serial of {', '.join(unnamed)}: whoever answers there is taken.")
    at.require("Are these the devices that stand there, by their labels?", by_person=True)
    told = f"{len(who)} devices are those that stand there"
    if unnamed:
        told += f"; of {len(unnamed)} the files name no serial"
    return Found(told=told, data={"unnamed": unnamed})
