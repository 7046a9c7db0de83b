"""The beam audit of a state, as its manifests tell it: what `pico validate` says of light."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pico.diagnostics import Diagnostic
from pico.manifest.load import Manifests
from pico.model.setup import Setup
from pico.model.state import place_of
from pico.optics.audit.findings import told
from pico.optics.audit.lasers import lasers_of
from pico.optics.ends import stray_beams


def _at_rest(setup: Setup, name: str) -> dict[str, Any]:
    """Return the angles of a mirror as they are after power-up, for a state that does not say them: a plan takes those
    that the bench reads."""
    found = {}
    for key, kind in setup.type_of(name).tunables.items():
        if key in ("tip", "tilt"):
            middle = sum(kind.range) / 2 if kind.range else 0.0
            home = kind.axis.home if kind.axis else middle
            found[key] = home if kind.initial is None else kind.initial
    return found


def check_light(read: Manifests) -> tuple[Diagnostic, ...]:
    """Return what is wrong with where light goes in a state: an error where one that it turns on is of a laser above
    class 2, else a warning; and where beams end, of lasers whose shutter it keeps closed. Where no laser shines,
    nothing is traced."""
    setup, state = read.require()
    poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    values = {name: part.values for name, part in state.components.items()}
    values |= {name: {**_at_rest(setup, name), **values.get(name, {})} for name in setup.lab.inventory}
    lasers = lasers_of(setup, poses, values)
    found: tuple[Diagnostic, ...] = ()
    ends: set[str] = set()
    if lasers:
        from pico.optics.audit.audit import audit

        verdict = audit(setup, poses, values, lasers)
        ends = {f.source for f in verdict.findings if f.kind == "end"}
        drawn = "`pico beam --manifest --picture beams.png`"
        refused = frozenset() if setup.lab.policy.enclosed else frozenset(lasers)
        for one in verdict.findings:
            said = told(replace(verdict, findings=(one,)), refused=refused, drawn=drawn)
            found += tuple(replace(d, source=read.source(f"{one.source}.emission")) for d in said)
        if verdict.unjudged:
            text = f"the damage threshold of {', '.join(verdict.unjudged)} is unknown: damage is not judged there"
            hint = "a parameter `damage_threshold` of the type, say {value: 5000, unit: mW/mm^2}, off its data sheet"
            found += (Diagnostic("note", "damage-threshold", text, hint=hint, address=verdict.unjudged[0]),)
    strays = (replace(one, source=read.source(one.address)) for one in stray_beams(setup, state, ends))
    return (*found, *strays)
