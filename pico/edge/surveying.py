"""Surveys at the edge: one operation to everybody else, many settings and measurements of the device; whatever ends it,
its tunables go back to where they stood."""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from pico.backends.device import Began, Device
from pico.diagnostics import Diagnostic, error
from pico.edge.aligning import Aligning, ways
from pico.model.measurement import Measurement, measurement_from_json
from pico.model.operation import Operation, OperationResult
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.trace.event import Event

ATTEMPTS = 2
"""How often a tunable is set, at most, and a measurement taken."""
DIMMED, LESS = 3, 8.0
"""How often a camera that is saturated is exposed for less, and by which factor."""
Do = Callable[[str, str, Mapping[str, Any]], Awaitable[OperationResult]]


class Surveying:
    """A device that knows surveys; all else it hands to `inner`. `stopping`: whether somebody asked to stop; `tell`
    hears of each measurement."""

    def __init__(
        self, setup: Setup, inner: Aligning, device: Device, stopping: Callable[[], str], tell: Callable[[Event], None]
    ) -> None:
        self._setup, self._inner, self._device = setup, inner, device
        self._stopping, self._tell = stopping, tell
        self._steps, self._now = 0, 0.0

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation: of a survey take the shots one after the other, then set all back."""
        if operation.primitive != "survey":
            return await self._inner.execute(operation, key, began)
        seen = await self._device.observe()
        before = seen.components.get(operation.component)
        began(before)
        self._operation, self._key = operation, key
        begin, shots = operation.arguments["from"], operation.arguments["what"]["shots"]
        stands, start = dict(begin), seen.time
        taken: list[Mapping[str, Any] | None] = []
        wrong: Diagnostic | None = None
        for number, shot in enumerate(shots):
            if self._stopping():
                break
            wrong = await self._set(stands, {**begin, **shot["at"]})
            if wrong:
                break
            found = await self._measured(stands, shot["address"])
            taken.append(as_json(found) if isinstance(found, Measurement) else {"unknown": found.summary})
            self._progress(shot, (number + 1) / len(shots))
        back = None if self._stopping() == "now" else await self._set(stands, begin, patient=True)
        ended = await self._device.observe()
        result: dict[str, Any] = {"shots": taken, "cut_short": len(taken) < len(shots), "last": stands}
        if failed := wrong or back:
            return OperationResult(key=key, outcome="failed", error=failed, before=before, ended=ended.time)
        return OperationResult(
            key=key, outcome="done", before=before, after=ended.components.get(operation.component),
            seconds=ended.time - start, ended=ended.time, data=result,
        )  # fmt: skip

    async def _set(
        self, stands: dict[str, Any], wanted: Mapping[str, Any], *, patient: bool = False
    ) -> Diagnostic | None:
        """Bring tunables to values, from the side of their axes; return what is wrong with the first that does not come
        there, of a `patient` one after all others were brought."""
        first: Diagnostic | None = None
        for address, value in wanted.items():
            wrong = await self._brought(stands, address, value)
            first = first or wrong
            if wrong and not patient:
                return wrong
        return first

    async def _brought(self, stands: dict[str, Any], address: str, value: Any) -> Diagnostic | None:
        component, _, tunable = address.partition(".")
        kind = self._setup.type_of(component).tunables[tunable]
        if stands[address] == value:
            return None
        wrong: Diagnostic | None = None
        for _ in range(ATTEMPTS):
            for goal in ways(kind, stands[address], value, kind.range or (-math.inf, math.inf)):
                arguments = {"tunable": tunable, "from": stands[address], "to": goal}
                result = await self._do("set", component, arguments)
                if result.outcome != "done":
                    said = result.error.summary if result.error else "the device does not say why"
                    text = f"{address} does not go where it is sent; it last stood at {stands[address]:g}: {said}"
                    wrong = error("axis", text, address=component)
                    break
                stands[address] = goal
            else:
                return None
        return wrong

    async def _dimmed(self, stands: dict[str, Any], component: str) -> bool:
        """Expose a camera for less; return whether it could."""
        address = f"{component}.exposure"
        if address not in stands:
            return False
        least = (self._setup.type_of(component).tunables["exposure"].range or (0.0, 0.0))[0]
        less = max(least, stands[address] / LESS)
        return less < stands[address] and await self._brought(stands, address, less) is None

    async def _measured(self, stands: dict[str, Any], address: str) -> Measurement | Diagnostic:
        component, _, measurable = address.partition(".")
        found: Measurement | None = None
        for _ in range(ATTEMPTS + DIMMED):
            result = await self._do("measure", component, {"measurable": measurable})
            if result.outcome == "done" and "measurement" in result.data:
                found = measurement_from_json(result.data["measurement"])
                if "not saturated" not in found.not_assured or not await self._dimmed(stands, component):
                    break
        if found is None:
            return result.error or error("survey", f"{address} was not measured", address=component)
        if "not saturated" in found.not_assured:
            return error("survey", f"{address} is saturated: {found.not_assured['not saturated']}", address=component)
        return found

    def _progress(self, shot: Mapping[str, Any], fraction: float) -> None:
        self._tell(Event(
            run=self._key.split("/", maxsplit=1)[0], seq=0, kind="operation_progress", time=self._now,
            operation=self._operation.id, component=self._operation.component,
            data={"phase": shot["address"], "fraction": fraction, "point": dict(shot["at"])},
        ))  # fmt: skip

    async def _do(self, primitive: str, component: str, arguments: Mapping[str, Any]) -> OperationResult:
        """Have the device do one step, of which nobody else hears."""
        self._steps += 1
        step = Operation(
            id=f"{self._operation.id}.{self._steps}", primitive=primitive, component=component, arguments=arguments,
            reason=self._operation.reason,
        )  # fmt: skip
        run, _, rest = self._key.partition("/")
        result = await self._device.execute(step, f"{run}~/{rest}.{self._steps}", lambda _: None)
        self._now = max(self._now, result.ended)
        return result
