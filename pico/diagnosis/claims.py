"""Claims of a lab against what its tolerances allow: the error budget of a state, and whether it carries them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from pico.diagnosis.budget import ErrorBudget, Tighter, error_budget, tighter
from pico.diagnosis.nominal import Nominal
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.manifest.checks.claims import claim_errors, share_of, size_of
from pico.manifest.checks.goals import look_errors
from pico.manifest.load import Manifests
from pico.manifest.text.places import where
from pico.manifest.text.scalars import resolve
from pico.model.goal import Looks
from pico.model.quantities import QuantityError, Value, convert
from pico.model.setup import Setup
from pico.model.state import LabState, place_of, references_of

_REQUESTS = ("shutter", "emission")
_SUPPOSED = "supposed"


@dataclass(frozen=True)
class Budgeted:
    """An error budget with what is wanted of it: of a `claim` by name, or empty; None where it cannot be told, and
    `why`. `wanted`: one standard deviation, in the result's unit, of what was asked for, `to`; `tighter`: to what must
    be held what contributes most, for that."""

    claim: str
    budget: ErrorBudget | None = None
    why: str = ""
    to: Value | None = None
    wanted: float | None = None
    tighter: tuple[Tighter, ...] = ()

    @property
    def carried(self) -> bool:
        """Whether the tolerances leave no more than is wanted, as far as anybody can tell."""
        if self.budget is None or self.wanted is None:
            return True
        return self.budget.tolerated <= self.wanted and not self.budget.lost


def budgeted(
    setup: Setup, state: LabState, of: str, looks: Looks | None = None, at: Mapping[str, Value] | None = None
) -> ErrorBudget:
    """Return the error budget of an expression over measured numbers in a state, with tunables supposed to be set `at`
    others than it says, and all light on; raises PicoError."""
    given = {look: _in_units(setup, own) for look, own in (looks or {}).items()}
    supposed = _in_units(setup, at or {})
    wrong = [*look_errors(setup, given), *look_errors(setup, {_SUPPOSED: supposed})]
    if wrong:
        raise PicoError([one for _, one in wrong])
    poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    values = {
        name: {k: v for k, v in own.values.items() if k not in _REQUESTS} for name, own in state.components.items()
    }
    for address, value in supposed.items():
        component, _, tunable = address.partition(".")
        values.setdefault(component, {})[tunable] = value
    budget = error_budget(Nominal(setup, poses, values), of, given)
    found = references_of(state).keys() - supposed.keys()
    for address in (row.address for row in budget.rows if not row.look and row.address in found):
        text = f"light finds {address}, and nobody knows in advance what it will be"
        raise PicoError(error("by-light", text, hint=f"`--set {address}=VALUE` supposes one"))
    return budget


def _in_units(setup: Setup, settings: Mapping[str, Value]) -> dict[str, Value]:
    """Return values of tunables in their units; what is none stays as it is, to be told."""
    found = dict(settings)
    for address, value in settings.items():
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component).tunables.get(tunable) if component in setup.lab.inventory else None
        if kind and kind.datatype == "float" and isinstance(value, str):
            try:
                found[address] = convert(value, kind.unit)
            except QuantityError as exc:
                raise PicoError(error("value", str(exc), address=address)) from exc
    return found


def settings_of(setup: Setup, words: Iterable[str]) -> tuple[dict[str, dict[str, Value]], dict[str, Value]]:
    """Return looks, and what is supposed for all, of words `a.p1.angle=1` and `p1.angle=1`; raises PicoError."""
    looks: dict[str, dict[str, Value]] = {}
    supposed: dict[str, Value] = {}
    for word in words:
        address, equals, text = word.partition("=")
        look, _, own = address.strip().partition(".") if address.count(".") == 2 else ("", "", address.strip())
        if not equals or own.count(".") != 1:
            hint = "PART.TUNABLE=VALUE, or LOOK.PART.TUNABLE=VALUE: `p1.angle=1`, `plus.p1.angle=1`"
            raise PicoError(error("usage", f"--set can't read `{word[:60]}`", hint=hint))
        (looks.setdefault(look, {}) if look else supposed)[own] = resolve(text.strip()) or text.strip()
    return looks, supposed


def judged(budget: ErrorBudget, to: Value | None, name: str = "") -> Budgeted:
    """Return a budget with what is wanted of it: `2 %` or `1 um`, None where nothing is; raises PicoError for what is
    neither."""
    if to is None:
        return Budgeted(name, budget)
    try:
        share = share_of(to)
        if share is not None and budget.nothing:
            text = f"the result is 0 in this state, of which there is no {to}"
            size = f"1 {budget.unit}".rstrip()
            hint = f"ask of a state that has some, `pico budget {name or 'EXPRESSION'} REV`; or of a size, `{size}`"
            raise PicoError(error("value", text, hint=hint))
        most = size_of(to, budget.unit) if share is None else share * abs(budget.value)
    except QuantityError as exc:
        hint = f"a share of the result, `2 %`, or a size of it, `1 {budget.unit}`".rstrip()
        raise PicoError(error("value", str(exc), hint=hint)) from exc
    return Budgeted(name, budget, to=to, wanted=most, tighter=tighter(budget, most))


def claims_in(setup: Setup, state: LabState) -> Iterator[Budgeted]:
    """Yield the claims of a lab with their budgets in a state; of those that cannot be told there, why."""
    for name, claim in (setup.lab.claims or {}).items():
        wrong = [one.summary for _, one in claim_errors(setup, {name: claim})]
        try:
            yield (
                Budgeted(name, why=wrong[0])
                if wrong
                else judged(budgeted(setup, state, claim.of, claim.looks), claim.to, name)
            )
        except PicoError as exc:
            yield Budgeted(name, why=exc.diagnostics[0].summary, to=claim.to)


def uncarried(setup: Setup, state: LabState, revision: str | None = None) -> Iterator[tuple[str, Diagnostic]]:
    """Yield the claims of a lab, by name, that the tolerances of a state do not carry, as warnings; of those that
    cannot be told there, for no light comes to where they are measured, nothing is said. `revision`: where the state is
    from, if not from the manifest."""
    for one in claims_in(setup, state):
        if not one.carried:
            yield one.claim, _warning(one, f"pico budget {one.claim} {revision or ''}".rstrip())


def check_carried(read: Manifests) -> tuple[Diagnostic, ...]:
    """Return the claims of a lab that the tolerances of its state do not carry, each at its place."""
    setup, state = read.require()
    lab = read.documents.get("Lab", ())
    at = (lambda name: where(lab[0], "claims", name, "to")) if lab else lambda _: None
    return tuple(replace(one, source=at(name)) for name, one in uncarried(setup, state))


def _warning(one: Budgeted, command: str) -> Diagnostic:
    budget = one.budget
    assert budget is not None  # else nobody knows
    text = f"the tolerances do not carry {one.claim}: it is claimed to {one.to}"
    if budget.lost:
        return warning("claim", text, detail=f"no light may be left within the tolerance of {budget.lost[0]}")
    has = f"{budget.tolerated:.2g} {budget.unit}".rstrip()
    share = f", {100 * budget.tolerated / abs(budget.value):.2g} %" if budget.value else ""
    first, more = "".join(held.said for held in one.tighter[:1]), len(one.tighter) - 1
    others = f" and {more} other{'s' if more > 1 else ''} tighter" if more > 0 else ""
    hint = f"{first}{others}; `{command}` says what would" if first else f"`{command}` says what would"
    return warning("claim", text, detail=f"they leave {has}{share}, one standard deviation", hint=hint)
