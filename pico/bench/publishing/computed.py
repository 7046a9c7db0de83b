"""What follows from a state: the state itself, how it differs from the one before, the plan from there, pictures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.bench.publishing.parts import File, file
from pico.history.git.commit import Commit
from pico.model.diff import Change
from pico.model.record import canonical
from pico.model.setup import Setup
from pico.model.state import LabState

if TYPE_CHECKING:
    from pico.drawing.picture import View


VIEWS: Mapping[View, str] = {
    "top": "the table from above",
    "perspective": "the table as somebody in front of it sees it",
}


def types(setup: Setup) -> list[File]:
    """Return the packaged component types that the bench uses; its own are among its manifests."""
    from pico.manifest.catalog import catalog_names
    from pico.resources import catalog_dir

    used = sorted(set(setup.catalog) & set(catalog_names()))
    contents = {name: (catalog_dir() / f"{name}.yaml").read_bytes() for name in used}
    return [file(f"catalog/{name}.yaml", data, f"component type {name}") for name, data in contents.items()]


def states(state: LabState, before: LabState, changes: Sequence[Change], parents: Sequence[str]) -> list[File]:
    """Return the state, whose digest is that of the file, and how it differs from the one before."""
    old = f"the state of the commit before, {parents[0][:7]}" if parents else "before anything: every part at home"
    said = "".join(f"{c.component}{'' if c.tunable == 'pose' else f'.{c.tunable}'}: {c.text}\n" for c in changes)
    return [
        file("state.json", canonical(state.as_json()).encode(), "the laboratory state, in canonical JSON"),
        file("before.json", canonical(before.as_json()).encode(), old),
        file("diff.json", canonical(changes).encode(), "the physical diff from the state before"),
        file("diff.txt", said.encode(), "the physical diff in words"),
    ]


def plan_between(setup: Setup, before: LabState, state: LabState, commit: Commit) -> File:
    """Return the plan from the state before to the one of a commit, as the planner of today makes it."""
    from pico.bench.checking.trial import plan_from, stood_as
    from pico.planning.checks.target import no_source

    parent = commit.parents[0] if commit.parents else None
    seen = replace(stood_as(setup, before), observed_at="")  # by nobody, at no time
    plan = plan_from(
        setup, seen, state, base=parent, name=commit.short, fidelity=setup.lab.sim.fidelity, source=no_source
    )
    return file("plan.json", plan.to_json().encode(), "the plan from the state before to this one")


def pictures_of(setup: Setup, state: LabState) -> Iterator[File]:
    """Yield pictures of the bench as it stands in a state."""
    from pico.bench.picturing.contents import standing
    from pico.drawing.picture import png, render

    poses = standing(setup, state)
    for view, said in VIEWS.items():
        yield file(f"pictures/{view}.png", png(render(setup, poses, {}, view=view)), said)
