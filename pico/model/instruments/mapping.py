"""Which property of a device each tunable and measurable of a component is."""

from __future__ import annotations

from pico.model.instruments.declaration import Declaration
from pico.model.instruments.kinds import kind_of
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wired


def mapped(setup: Setup, about: Declaration, entry: DeviceEntry, component: str) -> dict[str, Wired]:
    """Return the property of a device that each tunable and measurable of a component is: as `map` says, or else as
    its kind has it. Raises PicoError for a kind that there is not."""
    if entry.map:
        return dict(entry.map)
    kind = kind_of(about.kind)
    found = {name: Wired(property=of) for name, of in kind.usual.items()}
    if kind.by_name and component in setup.lab.inventory:
        own = setup.measurables_of(component).keys() & about.properties_of(entry).keys()
        found |= {name: Wired(property=name) for name in sorted(own)}
    return found
