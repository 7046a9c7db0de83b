"""`pico merge`: the values of two branches united, and the result asked whether it can stand on the table."""

from __future__ import annotations

from pico.backends.devices import SIMULATOR
from pico.diagnostics import Diagnostic
from pico.history.lab.folder import LabFolder
from pico.history.merge.commits import MergeMade, merge_revision
from pico.manifest.load import Manifests
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.plan import Base, Target
from pico.model.setup import Setup
from pico.model.state import LabState, home_state, place_of
from pico.motion.deferred import DeferredMotion


def merge(folder: LabFolder, revision: str, message: str = "") -> MergeMade:
    """Merge a revision into what is checked out; see `merge_revision`. The bench is not asked, and nothing moves.

    The merged state must be one to which the bench could be brought from the state at HEAD. Raises PicoError.
    """
    with folder.writing("pico merge"):
        before = folder.committed()
        return merge_revision(folder, revision, lambda merged: impossible(merged, before), message)


def impossible(merged: Manifests, before: LabState | None) -> tuple[Diagnostic, ...]:
    """Return why a merged state can't stand, else why a bench in the state `before` (None: every part at home) can't be
    brought to it."""
    from pico.planning import plan

    setup, wanted = merged.require()
    standing = overlapping(merged)
    if standing:
        return standing
    found = plan(
        setup,
        _as_seen(setup, before),
        wanted,
        motion=DeferredMotion(setup),
        backend=SIMULATOR,
        fidelity="kinematic",
        base=Base(),
        target=Target(),
        source=merged.source,
    )
    return tuple(d for d in found.diagnostics if d.severity == "error")


def overlapping(merged: Manifests) -> tuple[Diagnostic, ...]:
    """Return which parts can't stand where the state wants them, each with the part that it meets."""
    from pico.planning.actors import actors
    from pico.planning.checks.target import check_target
    from pico.planning.parts.situation import read_situation
    from pico.planning.request import Request

    setup, wanted = merged.require()
    request = Request(setup, _as_seen(setup, None), wanted, None, merged.source)
    movers, obstacles, put_off = actors(request, read_situation(setup, request.seen, wanted, exact=True))
    found = (*put_off, *check_target(setup, movers, obstacles, merged.source))
    return tuple(d for d in found if d.severity == "error")


def _as_seen(setup: Setup, state: LabState | None) -> Observation:
    """Return what would be seen of a bench in a state; a part that the state does not have is at home."""
    home, parts = home_state(setup), dict(state.components if state else {})
    known = {n: p for n, p in parts.items() if p.slot is None or p.slot in setup.lab.slots}
    whole = LabState(lab=setup.lab.name, components={**home.components, **known})
    seen = {}
    for name in setup.lab.inventory:
        values = {k: ObservedValue(value=v) for k, v in whole.components[name].values.items()}
        seen[name] = ObservedComponent(pose=place_of(setup, whole, name)[1], values=values)
    return Observation(backend=SIMULATOR, components=seen)
