"""Opening the edge of a bench and its memory: at a coordinator, else of who serves it here, else in this process."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import TYPE_CHECKING

from pico.base.state_files import EDGE, JOURNAL
from pico.edge.network.remotes import Far, Place
from pico.model.setup import Setup
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.device import Capabilities
    from pico.edge.contract import Edge
    from pico.edge.link.line import Line
    from pico.edge.protocol import Holder, OwnLab
    from pico.runs.memory import Memory


def opened(setup: Setup, place: Place, fidelity: str, lab: OwnLab | None = None) -> Edge:
    """Return the edge of a bench: the one that serves it, else one in this process.

    `lab`: what `setup` was read from. Raises PicoError for a device that there is not.
    """
    line = line_of(place)
    if line is None:
        from pico.edge.local import embedded

        assert not isinstance(place, Far)
        return embedded(setup, place, fidelity, lab)
    from pico.edge.link.client import RemoteEdge

    return RemoteEdge(line)


def line_of(place: Place) -> Line | None:
    """Return the line to the edge of a bench, None if none serves it."""
    if isinstance(place, Far):
        from pico.edge.network.line import line_to

        return line_to(place)
    if not EDGE.path(place.folder).exists():
        return None
    from pico.edge.link.line import SocketLine
    from pico.edge.link.place import find

    socket = find(place)
    return None if socket is None else SocketLine(socket, place)


def own_lab(place: Place) -> OwnLab | None:
    """Return the Lab that a bench keeps as its own; None if it keeps none yet. Raises PicoError if it can't be
    read."""
    line = line_of(place)
    if line is None:
        from pico.edge import own_lab

        assert not isinstance(place, Far)
        return own_lab.read(place)
    found: OwnLab | None = line.call("lab")
    return found


def served(place: Place) -> Capabilities | None:
    """Return what the process can do that serves a bench; None if none does."""
    line = line_of(place)
    able: Capabilities | None = None if line is None else line.call("describe")
    return able


def holder_of(place: Place) -> Holder | None:
    """Return who moves a bench, None if nobody does."""
    if isinstance(place, BenchPlace):
        from pico.edge.lease import BenchLock

        return BenchLock(place).holder()
    line = line_of(place)
    found: Holder | None = None if line is None else line.call("holder")
    return found


@contextmanager
def remembered(place: Place) -> Iterator[Memory | None]:
    """Give what a bench remembers of its runs, only to read it, and None if there was none yet. Raises PicoError if it
    can't be read."""
    line, path = line_of(place), JOURNAL.path(place.folder)
    if line is not None:
        from pico.edge.link.client import RemoteEdge

        yield RemoteEdge(line).memory
    elif path.exists():
        from pico.runs.journal import Journal

        with closing(Journal(path, looking=True)) as journal:
            yield journal
    else:
        yield None
