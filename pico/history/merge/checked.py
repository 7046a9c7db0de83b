"""`pico merge`: the values of two branches united, and the result asked whether it can stand on the table."""

from __future__ import annotations

from pico.backends.devices import SIMULATOR
from pico.diagnostics import Diagnostic
from pico.history.lab.folder import LabFolder
from pico.history.merge.commits import MergeMade, merge_revision
from pico.manifest.load import Manifests
from pico.model.observation import Observation, ObservedComponent, ObservedValue
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
    from pico.planning import PlanGoal, Planner

    setup, wanted = merged.require()
    standing = overlapping(merged)
    if standing:
        return standing
    planner = Planner(setup, DeferredMotion(setup), _as_seen(setup, before))
    found = planner.plan(PlanGoal(wanted, source=merged.source))
    return tuple(d for d in found.diagnostics if d.severity == "error")


def overlapping(merged: Manifests) -> tuple[Diagnostic, ...]:
    """Return which parts can't stand where the state wants them, each with the part that it meets."""
    from pico.planning import PlanGoal
    from pico.planning.checks.target import check_target
    from pico.planning.passes.actors import actors
    from pico.planning.passes.comparison import compared
    from pico.planning.passes.draft import Draft

    setup, wanted = merged.require()
    goal = PlanGoal(wanted, exact=True, source=merged.source)
    movers, obstacles, put_off = actors(compared(Draft(setup, None, _as_seen(setup, None), goal)))
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
