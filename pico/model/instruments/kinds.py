"""The kinds of instruments by name: the files in `pico/drivers/kinds`, and those of plug-ins."""

from __future__ import annotations

from typing import cast

from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.instruments.kind import InstrumentKind
from pico.plug_ins.calling import Interface, instance
from pico.plug_ins.known import FOLDERS
from pico.registered import module, modules

GROUP = "pico.kinds"
INTERFACE = Interface(GROUP, {"KIND": instance(InstrumentKind)})


def kind_names() -> tuple[str, ...]:
    """Return the names of all kinds, PICO's own first; imports none."""
    return tuple(name.replace("_", " ") for name in modules(FOLDERS[GROUP], GROUP))


def kind_of(name: str) -> InstrumentKind:
    """Return the kind of this name; raises PicoError (code `kind`) for one that there is not, with those that there
    are, and (code `plugin`) for a plug-in that is broken."""
    if name not in kind_names():
        near = did_you_mean(name[:40], kind_names())
        known = f"the kinds are {', '.join(kind_names())}; a plug-in adds one by the entry point `{GROUP}`"
        hint = f"{near} {known}" if near.startswith("did") else known
        raise PicoError(error("kind", f"there is no kind of instrument `{name[:40]}`", hint=hint))
    return cast(InstrumentKind, module(INTERFACE, name.replace(" ", "_")).KIND)
