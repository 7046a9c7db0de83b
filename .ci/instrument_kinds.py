"""Print docs/reference/instrument-kinds.md from the kinds of instruments in `pico/drivers/kinds`."""

from __future__ import annotations

from pathlib import Path

from pico.model.instruments.kind import InstrumentKind
from pico.model.instruments.kinds import INTERFACE, kind_of
from pico.plug_ins.known import FOLDERS
from pico.registered import own

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reference" / "instrument-kinds.md"
_HEAD = """# Kinds of instruments

What each driver is one of. This page is printed from the files in `pico/drivers/kinds` (`make docs`); do not edit it.
`pico devices` shows the kind of each device of a lab.

A kind states the protocol of its drivers, what `pico devices check` shows, and what an instrument of it is in a lab
without `map`. A new kind is one file: beside those of PICO, or in a package by the entry point `pico.kinds`. Its `KIND`
is an `InstrumentKind` (`pico/model/instruments/kind.py`): `reads` gives the words of `devices check`, `drives` what
sets a tunable, `measures` what reads a measurable. PICO checks that what a plug-in's driver makes has all methods of
the protocol of its kind (`pico/drivers/protocols.py`; those of `number` and `choice` are in their files).

| kind | what it is | without `map` | sets tunables of | methods |
|---|---|---|---|---|
"""


def page() -> str:
    """Return the page."""
    names = own(FOLDERS[INTERFACE.group], INTERFACE.group)
    return _HEAD + "\n".join(_row(kind_of(name.replace("_", " "))) for name in names) + "\n"


def _row(kind: InstrumentKind) -> str:
    usual = [f"`{prop}` is `{name}`" for name, prop in kind.usual.items()]
    if kind.by_name:
        usual.append("a property is the tunable or measurable of its name")
    if kind.role != "part":
        usual = [
            f"the {kind.role} of its name or `of:`" if kind.role != "safety input" else "named by `safety_inputs:`"
        ]
    elif not usual:
        usual = ["needs a `map`"]
    methods = ", ".join(f"`{name}`" for name in kind.methods)
    takes = ", ".join(kind.datatypes) or "none"
    return f"| `{kind.name}` | {kind.about} | {'; '.join(usual)} | {takes} | {methods} |"


if __name__ == "__main__":
    import sys

    from printing import printed

    sys.exit(printed(PAGE, page()))
