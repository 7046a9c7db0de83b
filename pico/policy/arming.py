"""Who may arm a laser, and which armings count: pure functions over the policy of a lab and the time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from datetime import timedelta

from pico.base import clock
from pico.diagnostics import Diagnostic, error
from pico.model.arming import Arming, ArmingPolicy, LaserClass, LaserRole, Licence, within
from pico.model.plan import UNARMED
from pico.model.setup import Setup

AHEAD = timedelta(days=7)
"""So long before it begins an arming may be given."""
_SHOWN = "policy: {arming: {roles: {laser_user: {people: [%s], laser_class: %s, hours: 8}}}}"


def lasers(setup: Setup) -> list[str]:
    """Return the sources of light of a bench, by name."""
    return [name for name in sorted(setup.lab.inventory) if setup.type_of(name).optics.element == "source"]


def policy_of(setup: Setup) -> ArmingPolicy:
    """Return what a lab says of arming; nobody may where it says nothing."""
    return setup.lab.policy.arming or ArmingPolicy()


def role_for(setup: Setup, person: str, of: LaserClass, hours: float) -> str | None:
    """Return the first role in which a person may arm a laser of a class for so many hours; None for no such role."""
    roles = policy_of(setup).roles
    return next((n for n, role in sorted(roles.items()) if not _beyond(role, person, of, hours)), None)


def _beyond(role: LaserRole, person: str, of: LaserClass, hours: float) -> str:
    """Return why a person may not arm in a role; empty where that is allowed."""
    if person not in role.people:
        return f"{person} is not in it"
    if not within(of, role.laser_class):
        return f"it is for lasers up to class {role.laser_class}"
    return f"it is for {role.hours:g} h at most" if hours > role.hours + 1e-6 else ""


def nobody(setup: Setup, person: str, laser: str, of: LaserClass, hours: float) -> Diagnostic:
    """Return the diagnostic that a person may not arm a laser, with what would let them."""
    roles = policy_of(setup).roles
    why = [f"{name}: {_beyond(role, person, of, hours)}" for name, role in sorted(roles.items())]
    text = f"{person or 'nobody'} may not arm {laser} (class {of}) for {hours:g} h"
    detail = "; ".join(why) if why else "the lab's policy has no role that may arm a laser"
    shown = _SHOWN % (person or "NAME", of)
    hint = f"whoever answers for the lab writes `{shown}` into lab.yaml; then `pico bench update`"
    return error(UNARMED, text, detail=detail, hint=hint, address=laser)


def needless(setup: Setup, person: str, laser: str, of: LaserClass, hours: float) -> Diagnostic:
    """Return the same of a laser that nobody has to arm: what lets its light out instead."""
    hint = f"nobody has to arm it here: `pico apply` lets its light out, or `pico set {laser} shutter=open`"
    return replace(nobody(setup, person, laser, of, hours), hint=hint)


def refusal(setup: Setup, arming: Arming, now: str) -> Diagnostic | None:
    """Return why an arming must not be given, None where it may."""
    if arming.laser not in lasers(setup):
        hint = f"lasers here: {', '.join(lasers(setup)) or 'none'}"
        return error("unknown-component", f"there is no laser `{arming.laser[:40]}`", hint=hint)
    begins, ends, at = (clock.parse(t) for t in (arming.begins, arming.ends, now))
    hours = (ends - begins).total_seconds() / 3600
    if ends <= at or hours <= 0:
        return error(UNARMED, f"the arming of {arming.laser} ends before it begins", address=arming.laser)
    if begins > at + AHEAD:
        return error(UNARMED, f"an arming is given at most {AHEAD.days} days ahead", address=arming.laser)
    role = policy_of(setup).roles.get(arming.role)
    if not arming.by or role is None or _beyond(role, arming.by, arming.laser_class, hours):
        return nobody(setup, arming.by, arming.laser, arming.laser_class, hours)
    return None


def over(setup: Setup, arming: Arming, now: str) -> str:
    """Return why an arming is over, in words; empty for one that counts, or will."""
    if arming.seen_over or at_its_end(arming, now):
        who = f"the arming by {arming.by}"
        return f"{arming.ended_by} disarmed it" if arming.ended_by else f"{who} ended at {arming.ends}"
    role = policy_of(setup).roles.get(arming.role)
    if role is None or _beyond(role, arming.by, arming.laser_class, 0.0):
        return f"{arming.by} is no {arming.role} for class {arming.laser_class} any more"
    return ""


def at_its_end(arming: Arming, now: str) -> bool:
    """Return whether the time of an arming is up."""
    return clock.seconds_between(arming.ends, now) >= 0


def ended(setup: Setup, known: Arming | None, laser: str, by: str, backend: str, now: str) -> Arming:
    """Return the arming of a laser once a person has ended it: over, so that whoever has the bench shuts it."""
    if known is None:
        known = Arming(
            laser=laser, by=by, role="", laser_class="1", begins=now, ends=now, backend=backend
        )  # fmt: skip
    return replace(known, ends=now, ended_by=by)


def in_force(setup: Setup, arming: Arming, backend: str, now: str) -> bool:
    """Return whether an arming counts now, on a backend."""
    begun = clock.seconds_between(arming.begins, now) >= 0
    return begun and arming.backend == backend and not over(setup, arming, now)


def waived(setup: Setup, evidence: str) -> bool:
    """Return whether nobody has to arm a laser for what counts as this evidence; never for hardware."""
    return evidence != "hardware" and evidence in policy_of(setup).waived


def licences(
    setup: Setup, evidence: str, armings: Iterable[Arming], backend: str, now: str
) -> Mapping[str, Licence]:  # fmt: skip
    """Return what lets lasers emit now, by name: the waiver of the lab, else armings in force."""
    if waived(setup, evidence):
        return {name: Licence(laser_class="4") for name in lasers(setup)}
    return {
        one.laser: Licence(laser_class=one.laser_class, by=one.by, ends=one.ends, unattended=one.unattended)
        for one in armings
        if one.laser in lasers(setup) and in_force(setup, one, backend, now)
    }
