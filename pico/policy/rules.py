"""The rules of a lab against a plan, before anything moves. What can't be told is denied."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from pico.diagnostics import Diagnostic, error
from pico.expressions import ExpressionError, Language, UnknownValue, words_of
from pico.model.lab import PolicyRule
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.vocabulary import POLICY_NAMES, functions_of, names_of, shown, spoken_of, values_of
from pico.optics.audit.findings import Audit
from pico.policy.context import policy_values
from pico.policy.reaching import reaching

_NOBODY = "nothing tells whether somebody is at the table"


def denials(found: Iterable[Mapping[str, Any]]) -> tuple[Diagnostic, ...]:
    """Return an error for each verdict on a mandatory rule that does not hold."""
    return tuple(_denied(one) for one in found if not one["holds"] and one["level"] == "mandatory")


def verdicts(
    setup: Setup, plan: Plan, seen: Observation, audited: Callable[[], Audit]
) -> tuple[Mapping[str, Any], ...]:  # fmt: skip
    """Return for each rule of the lab `rule` (its name), `level`, `holds` and, if it does not hold, `text`. `audited`
    returns the verdict on the light of the plan, for rules that speak of it."""
    rules = setup.lab.policy.rules
    spoken = [n for n in spoken_of(setup, (rule.that for rule in rules)) if n not in POLICY_NAMES]
    values, unknown = values_of(setup, seen, spoken)
    words = words_of(rule.that for rule in rules)
    values |= policy_values(setup, plan, seen, words)
    if "audit" in words:
        audit = audited()
        values["audit"] = {"passes": audit.passes, "findings": [f.text for f in audit.findings]}
    if seen.person is not None:
        values["human_present"] = seen.person
    language = Language({**names_of(setup, spoken), **POLICY_NAMES}, functions_of(setup, seen, reaching(setup, seen)))
    return tuple(_verdict(language, rule, values, {**unknown, "human_present": _NOBODY}) for rule in rules)


def _verdict(
    language: Language, rule: PolicyRule, values: dict[str, Any], unknown: Mapping[str, str]
) -> Mapping[str, Any]:  # fmt: skip
    try:
        holds = bool(language.compile(rule.that).evaluate(values))
        why = "" if holds else shown(rule.that, {n: v for n, v in values.items() if not isinstance(v, dict | list)})
    except UnknownValue as exc:
        holds, why = False, f"can't be told: {unknown.get(exc.name, exc)}"
    except ExpressionError as exc:
        holds, why = False, f"can't be told: {exc}"
    text = "; ".join(words for words in (rule.message or f"`{rule.that}` does not hold", why) if words)
    return {"rule": rule.name, "level": rule.level, "holds": holds, "text": "" if holds else text}


def _denied(verdict: Mapping[str, Any]) -> Diagnostic:
    hint = "the rule stands under `policy:` in the lab; `pico plan --json` shows what it was asked about"
    return error("denied", f"the policy of this lab denies it: {verdict['rule']}: {verdict['text']}", hint=hint)
