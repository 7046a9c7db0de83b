"""The three states side by side: committed, desired and live, for each tunable of each component."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import field
from types import MappingProxyType
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.catalog import Tunable
from pico.model.diff import (
    Change,
    deviation,
    diff_observed,
    diff_states,
    place_json,
    show_value,
    slot_left,
    unread_values,
)
from pico.model.observation import Observation, ObservedComponent, doubtful, slot_at
from pico.model.pose import Pose, angle_between, short
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.shown.html import table
from pico.model.state import LabState, is_reference, place_of, references_of

NOTHING: Mapping[str, str] = {}


@record
class StatusRow:
    """One tunable in the three states; a place is a slot's name or a pose as {x, y, yaw}.

    `edited`: desired differs from committed. `off`: live differs from desired by more than the tolerance. `drifted`:
    it is off and differs from committed too, so nobody asked for it. `exact`: live equals desired without any
    deviation; `near` says what a tolerated deviation is, `aside` how far off the center of a slot it stands. `unit`: of
    the values. `requested`: it differs, and is light that is asked for, which no state is. `note`: missing, held,
    toppled or uncertain. `kept`: the goal that has the last word on it, if it differs and stays at its live value.
    `unread`: no device of the bench reads it, so that it is compared with nothing. `unstated`: it was set here, and
    neither commit nor manifest names it; None for every other one.
    """

    component: str
    tunable: str
    committed: Any = None
    desired: Any = None
    live: Any = None
    edited: bool = False
    off: bool = False
    drifted: bool = False
    exact: bool = False
    near: str = ""
    aside: str = ""
    unit: str = ""
    requested: bool = False
    note: str = ""
    kept: str = ""
    unread: bool = False
    unstated: bool | None = None

    @property
    def address(self) -> str:
        """`p2` for a pose, `p1.angle` for another tunable."""
        return self.component if self.tunable == "pose" else f"{self.component}.{self.tunable}"

    @property
    def equal(self) -> bool:
        """Whether there is nothing to tell about it."""
        return not (self.edited or self.off or self.note or self.requested or self.kept or self.unread or self.unstated)


@record
class Status:
    """The three states of a bench. `head`: what the commit is called, empty without Git or before a first commit.
    `cut_short`: that the last run was killed or an arm left standing, and what to do. `lacking`: the devices that can't
    be used, with why; all others work."""

    schema: str = "pico.status/v1"
    lab: str
    backend: str
    head: str = ""
    observed_at: str = ""
    rows: tuple[StatusRow, ...] = ()
    unknown: Mapping[str, Pose] = field(default_factory=dict)
    cut_short: tuple[Diagnostic, ...] = ()
    lacking: tuple[Diagnostic, ...] = ()

    def __repr__(self) -> str:
        counts = {
            "not committed": sum(row.edited for row in self.rows), "off": sum(row.off for row in self.rows),
            "not seen as it should be": sum(bool(row.note) for row in self.rows),
            "set, but in no state": sum(bool(row.unstated) for row in self.rows),
            "unknown": sum(row.unread for row in self.rows), "strangers": len(self.unknown),
        }  # fmt: skip
        said = ", ".join(f"{number} {what}" for what, number in counts.items() if number)
        head = f" against {self.head}" if self.head else ""
        return f"<status of {self.lab} on {self.backend}{head}: {len(self.rows)} values, {said or 'all equal'}>"

    def _repr_html_(self) -> str:
        rows = [
            (row.address, _shown(row.committed), _shown(row.desired), row.note or _shown(row.live), row.unit)
            for row in self.rows if not row.equal
        ]  # fmt: skip
        return table(repr(self)[1:-1], ("", "committed", "desired", "live", "unit"), rows)


def _shown(value: Any) -> str:
    if isinstance(value, Mapping) and "x" in value:
        return f"({value['x']:g}, {value['y']:g}, {value.get('yaw', 0.0):g}°)"
    return "" if value is None else show_value(value)


def compare(
    setup: Setup, committed: LabState | None, desired: LabState, seen: Observation, head: str = "", *,
    only: Collection[str] | None = None, unaligned: Mapping[str, str] = NOTHING,
    unstated: Mapping[str, Value] = MappingProxyType({}),
) -> Status:  # fmt: skip
    """Return the three states side by side, sorted by component and tunable; `committed` is None without a commit.

    `only`: these components. `unaligned`: set-points of `desired` that light has yet to find, by address, with why.
    `unstated`: what was set here and no state names, by address, with its live value.
    """
    off = _by_address([*diff_observed(setup, seen, desired), *_unfound(desired, unaligned)])
    moved = _by_address(diff_observed(setup, seen, committed)) if committed else {}
    rows: list[StatusRow] = []
    unread = {*unread_values(seen, desired)}
    for name in sorted(setup.lab.inventory if only is None else setup.lab.inventory.keys() & set(only)):
        rows.append(_pose_row(setup, name, committed, desired, seen, off, moved))
        values = _value_rows(setup, name, committed, desired, seen, off, moved, unread)
        values += [_unstated_row(setup, a, v) for a, v in unstated.items() if a.partition(".")[0] == name]
        rows.extend(sorted(values, key=lambda row: row.tunable))
    unknown = {name: thing.pose for name, thing in seen.unknown.items()}
    return Status(
        lab=setup.lab.name,
        backend=seen.backend,
        head=head,
        observed_at=seen.observed_at,
        rows=tuple(rows),
        unknown=unknown,
    )


_Changes = Mapping[tuple[str, str], Change]


def _unfound(desired: LabState, unaligned: Mapping[str, str]) -> Iterator[Change]:
    """Yield where the bench is not, or not known to be, where light says that it should."""
    for address, one in references_of(desired).items():
        component, _, tunable = address.partition(".")
        if address in unaligned:
            yield Change(component=component, tunable=tunable, after=one.as_json(), text=unaligned[address])


def _by_address(changes: Iterable[Change]) -> dict[tuple[str, str], Change]:
    return {(c.component, c.tunable): c for c in changes}


def _pose_row(
    setup: Setup, name: str, committed: LabState | None, desired: LabState, seen: Observation, off: _Changes,
    moved: _Changes,
) -> StatusRow:  # fmt: skip
    slot, goal = place_of(setup, desired, name)
    before = place_json(*place_of(setup, committed, name)) if committed else None
    after = place_json(slot, goal)
    part = seen.components.get(name)
    note = _note(setup, name, part)
    live = part.pose if part and not note else None
    at_home = slot and live and slot_at(setup, live) == slot
    in_slot = slot if at_home else slot_left(setup, name, live, goal) if live else None
    return StatusRow(
        component=name,
        tunable="pose",
        committed=before,
        desired=after,
        live=place_json(in_slot, live) if live else None,
        edited=committed is not None and before != after,
        note=note,
        near=_deviation(goal, live) if live else "",
        aside=_aside(setup, name, in_slot, live) if in_slot and live else "",
        **_verdict((name, "pose"), off, moved),
    )


def _value_rows(
    setup: Setup, name: str, committed: LabState | None, desired: LabState, seen: Observation, off: _Changes,
    moved: _Changes, unread: Collection[str],
) -> list[StatusRow]:  # fmt: skip
    before = _values(committed, name)
    after = _values(desired, name)
    kinds = setup.type_of(name).tunables
    part = seen.components.get(name)
    live = {k: v.value for k, v in part.values.items() if v.status != "unknown"} if part else {}
    return [
        StatusRow(
            component=name,
            tunable=tunable,
            committed=before.get(tunable),
            desired=after.get(tunable),
            live=live.get(tunable),
            edited=committed is not None and before.get(tunable) != after.get(tunable),
            near=_near(kinds.get(tunable), off.get((name, tunable)), live.get(tunable), after.get(tunable)),
            unit=kinds[tunable].unit if tunable in kinds else "",
            unread=f"{name}.{tunable}" in unread,
            **_verdict(
                (name, tunable), off, moved, other=is_reference(after.get(tunable)) or f"{name}.{tunable}" in unread
            ),
        )
        for tunable in sorted(before.keys() | after.keys())
    ]


def _unstated_row(setup: Setup, address: str, value: Value) -> StatusRow:
    component, _, tunable = address.partition(".")
    unit = setup.type_of(component).tunables[tunable].unit
    return StatusRow(component=component, tunable=tunable, live=value, unit=unit, unstated=True)


def _near(kind: Tunable | None, change: Change | None, live: Any, goal: Any) -> str:
    """Return what is told beside a value that is not exactly right: by how much it deviates; of one that light finds
    why it is not."""
    if is_reference(goal):
        return change.text if change is not None else f"({show_value(live)})"
    if kind is None or not isinstance(live, int | float) or not isinstance(goal, int | float):
        return ""
    off = -angle_between(live, goal, kind.period) if kind.period else live - goal
    return f"{off:+.3g} {kind.unit}".rstrip() if off else ""


def _values(state: LabState | None, name: str) -> Mapping[str, Any]:
    return state.components[name].given if state and name in state.components else {}


def _verdict(key: tuple[str, str], off: _Changes, moved: _Changes, *, other: bool = False) -> dict[str, Any]:
    change, drift = off.get(key), moved.get(key)
    is_off = change is not None and change.counts
    return {
        "off": is_off,
        "drifted": is_off and drift is not None and not drift.tolerated,
        "exact": change is None and not other,
        "requested": change is not None and bool(change.requested),
        "kept": change.aligned.goal if change is not None and change.aligned is not None else "",
    }


def _note(setup: Setup, name: str, part: ObservedComponent | None) -> str:
    if part is None or (part.pose is None and part.presence == "seen"):
        return "missing"
    if part.presence != "seen":
        return "unknown" if part.is_unlooked else part.presence
    return "uncertain" if doubtful(setup, name, part) else ""


def _deviation(goal: Pose, live: Pose) -> str:
    turned = angle_between(goal.yaw, live.yaw)
    angle = f", {abs(turned):.2f}°" if abs(turned) >= 0.005 else ""
    return f"({goal.distance(live):.2f} mm{angle} off)"


def _aside(setup: Setup, name: str, slot: str, live: Pose) -> str:
    center = setup.lab.slots[slot].pose
    if deviation(setup, name, live, None, center) != "off":
        return ""
    off = (short(live.distance(center)), "mm"), (short(abs(angle_between(center.yaw, live.yaw))), "°")
    words = [f"{number} {unit}".replace(" °", "°") for number, unit in off if number != "0"]
    return f"{' and '.join(words)} off its center"


def refuse_unapplied(
    setup: Setup, committed: LabState | None, desired: LabState, seen: Observation,
    components: Collection[str] | None = None, *, unaligned: Mapping[str, str] = NOTHING, unset: Collection[str] = (),
) -> None:  # fmt: skip
    """Raise PicoError where the manifest holds edits that the bench does not show: they were never applied.

    Edits of a part that nobody sees, or not surely, count as well: nobody can say that they were. `components`: only of
    these. `unaligned`: see `compare`. `unset`: tunables with `restore: align` that kept their live values and never had
    the numbers of the manifest.
    """
    edited = None if committed is None else {c.component for c in diff_states(setup, committed, desired)}
    among = edited if components is None else set(components) & (edited if edited is not None else set(components))
    if among is not None and not among:
        return
    rows = compare(setup, committed, desired, seen, only=among, unaligned=unaligned).rows
    unsure = {row.component: row.note for row in rows if row.note}
    edits = [
        row for row in rows
        if (row.edited or row.committed is None)
        and (row.off or row.address in unset or (row.component in unsure and row.desired is not None))
    ]  # fmt: skip
    if edits:
        shown = [f"{row.address}{_why(unsure, row)}" for row in edits[:6]]
        names = ", ".join(shown) + (" and others" if len(edits) > 6 else "")
        light = [f"`pico optimize {row.address}`" for row in edits if row.address in unaligned]
        named = [row.address for row in edits if row.address in unset]
        light += [f"`pico apply -- {' '.join(named)}`"] if named else []
        first = light if len(light) + max(0, len(named) - 1) == len(edits) else ["`pico apply`", *light]
        hint = (
            f"{', '.join(first)} first; or `--capture`: the bench wins; or `--planned`: the edit is committed, unproven"
        )
        raise PicoError(error("unapplied", f"the manifest holds edits that were never applied: {names}", hint=hint))


def _why(unsure: Mapping[str, str], row: StatusRow) -> str:
    return f" ({unsure[row.component]})" if row.component in unsure and not row.off else ""
