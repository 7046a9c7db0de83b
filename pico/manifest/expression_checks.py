"""Whether the expressions of a lab's policy, goals and claims and of a state's expectations make sense, before
anything is evaluated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pico.diagnostics import Diagnostic, did_you_mean, error
from pico.expressions import ExpressionError, Language
from pico.manifest.load import Manifests
from pico.manifest.text.places import find, where
from pico.manifest.text.tree import Document, List, Scalar
from pico.manifest.text.within import inside
from pico.model.address import Renaming, renamed_expression, renaming_of
from pico.model.setup import Setup
from pico.model.vocabulary import POLICY_NAMES, cameras_of, functions_of, names_of

_SAME: Renaming = {}
_SPEAK = "expectations speak of a component's pose, slot, tunables and measurables: `p2.pose.x`, `distance(p1, p2)`"
_RULES = "rules speak of plan, operations, components, lasers, lab, human_present and of components: `laser.shutter`"


def check_rules(manifests: Manifests) -> list[Diagnostic]:
    """Return what is wrong with the rules of a lab that is right otherwise, each at its place."""
    setup = manifests.setup
    return [d for lab in manifests.documents.get("Lab", ()) for d in _rules(lab, setup)] if setup else []


def check_goals(manifests: Manifests) -> list[Diagnostic]:
    """Return what is wrong with the goals of a lab that is right otherwise, each at its place."""
    setup = manifests.setup
    if setup is None or not setup.lab.goals:
        return []
    from pico.manifest.checks.goals import goal_errors

    lab = manifests.documents.get("Lab", ())[0]
    return [replace(wrong, source=where(lab, "goals", *path)) for path, wrong in goal_errors(setup, setup.lab.goals)]


def check_claims(manifests: Manifests) -> list[Diagnostic]:
    """Return what is wrong with the claims of a lab that is right otherwise, each at its place."""
    setup = manifests.setup
    if setup is None or not setup.lab.claims:
        return []
    from pico.manifest.checks.claims import claim_errors

    lab = manifests.documents.get("Lab", ())[0]
    return [replace(wrong, source=where(lab, "claims", *path)) for path, wrong in claim_errors(setup, setup.lab.claims)]


def check_ignored(manifests: Manifests) -> list[Diagnostic]:
    """Return what a lab's policy ignores though it does not exist, each at its place."""
    setup = manifests.setup
    return [d for lab in manifests.documents.get("Lab", ()) for d in _ignored(lab, setup)] if setup else []


def check_expectations(manifests: Manifests) -> list[Diagnostic]:
    """Return what is wrong with the expectations of a state that is right otherwise, each at its place."""
    setup, state = manifests.setup, manifests.state
    if setup is None or state is None or not state.expect:
        return []
    language = Language(names_of(setup, [*setup.lab.inventory, *cameras_of(setup)]), functions_of(setup))
    documents = manifests.documents.get("LabState", ())
    what = "this expectation can't be told"
    names = renaming_of(setup.lab)
    return [found for document in documents for found in _each(document, language, ("expect",), what, _SPEAK, names)]


def _rules(document: Document, setup: Setup) -> Iterator[Diagnostic]:
    rules = setup.lab.policy.rules
    if not rules:
        return
    named = [rule.name for rule in rules]
    for n, name in enumerate(named):
        if name in named[:n]:
            at = where(document, "policy", "rules", n, "name")
            yield error("duplicate", f"two rules are called `{name}`", hint="give each its own name", source=at)
    speaking = [n for n in (*setup.lab.inventory, *cameras_of(setup)) if n not in POLICY_NAMES]
    language = Language({**names_of(setup, speaking), **POLICY_NAMES}, functions_of(setup))
    yield from _each(document, language, ("policy", "rules"), "this rule can't be told, so it would deny", _RULES)


def _each(
    document: Document, language: Language, path: tuple[str, ...], what: str, hint: str, names: Renaming = _SAME
) -> Iterator[Diagnostic]:
    entry = find(document, *path)
    for n, _ in enumerate(entry[1].items if entry and isinstance(entry[1], List) else ()):
        said = find(document, *path, n, "that")
        if said is None or not isinstance(said[1], Scalar):
            continue
        text = renamed_expression(names, said[1].text)
        try:
            language.compile(text)
        except ExpressionError as exc:
            at = document.source.range(said[1].start, said[1].end)
            at = at if text != said[1].text else inside(document.source, said[1], exc.start, exc.end)
            yield error("expression", f"{what}: {exc}", hint=exc.hint or hint, source=at)


def _ignored(document: Document, setup: Setup) -> Iterator[Diagnostic]:
    known = [a for n in setup.lab.inventory for a in (n, f"{n}.pose", *(f"{n}.{t}" for t in setup.type_of(n).tunables))]
    for n, name in enumerate(setup.lab.policy.ignore):
        if name not in known:
            hint = did_you_mean(name[:40], known) or "a component, or one of its tunables: `cam.exposure`"
            at = where(document, "policy", "ignore", n)
            yield error("unknown-tunable", f"there is no `{name[:40]}` to be ignored", hint=hint, source=at)
