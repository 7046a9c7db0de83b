"""A lab together with the component types that its inventory uses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.model.catalog import (
    Catalog,
    ComponentType,
    Measurable,
    SeatingKind,
    as_first_written,
    value_of,
    with_mass,
    with_parameters,
    with_restore,
)
from pico.model.lab import Lab, Part
from pico.model.record import digest, record, remembered

if TYPE_CHECKING:
    from pico.model.wiring import Wiring

EXPOSURE = "exposure"
"""The tunable of a detector that `auto_range` finds."""


@record
class Setup:
    """A lab together with the component types that its inventory uses: what every computation about a bench needs.

    `wiring`: its instruments, where any are known; no part of the digest, for a plan is the same without them.
    """

    lab: Lab
    catalog: Catalog
    wiring: Wiring | None = None

    def type_of(self, component: str) -> ComponentType:
        """Return the type of `component`, with the parameters and the mass that are the part's own, and how it is
        restored; raises KeyError for a part that the inventory does not have."""
        part = self.lab.inventory[component]
        kind = self.catalog[part.type]
        if part.restore:
            kind = with_restore(kind, part.restore)
        if part.mass is not None:
            kind = with_mass(kind, part.mass)
        return with_parameters(kind, part.parameters) if part.parameters else kind

    def ranges(self, component: str) -> bool:
        """Return whether `component` finds an exposure of its own."""
        if component not in self.lab.inventory:
            return False
        kind = self.type_of(component)
        return "auto_range" in kind.primitives and EXPOSURE in kind.tunables

    def seating_of(self, component: str) -> SeatingKind:
        """Return how `component` is seated: the part's own word, else its type's."""
        return self.lab.inventory[component].seating or self.type_of(component).seating

    def ends_beams(self, component: str) -> bool:
        """Return whether `component` is meant to end beams: the part's own word, else its type's; a block is."""
        own, optics = self.lab.inventory[component].ends_beams, self.type_of(component).optics
        said = optics.ends_beams if own is None else own
        return optics.element == "block" if said is None else said

    def requests(self, component: str, tunable: str) -> bool:
        """Return whether what a state says of a tunable is a request: light, which is asked for and never restored."""
        kind = self.type_of(component).tunables.get(tunable)
        return kind is not None and kind.restore.kind == "request"

    def loose(self, component: str) -> bool:
        """Return whether `component` may be moved at all, by an arm or by a person: it is not bolted."""
        return self.lab.inventory[component].pose is None and self.seating_of(component) != "bolted"

    def movable(self, component: str) -> bool:
        """Return whether an arm may move `component`: not bolted, has a grasp, and its type says that an arm does."""
        kind = self.type_of(component)
        return self.loose(component) and kind.pose.mover == "arm" and kind.geometry.grasp is not None

    @remembered
    def measurables_of(self, name: str) -> Mapping[str, Measurable]:
        """Return what can be asked to be measured of a component or a camera over the bench; nothing for another name.

        Besides the measurables of its type a component has its `pose`, as cameras see it, and its set-points, read
        back; a camera has its `frame`.
        """
        if name in self.lab.inventory:
            kind = self.type_of(name)
            read = {t: Measurable(datatype="setpoint", unit=tunable.unit) for t, tunable in kind.tunables.items()}
            return {**read, "pose": Measurable(datatype="pose", unit="mm, mm, deg"), **kind.with_needs}
        camera = self.lab.cameras.get(name)
        return {} if camera is None or camera.robot else {"frame": Measurable(datatype="image", unit="count")}

    def measurable_of(self, name: str, measurable: str) -> Measurable:
        """Return one of `measurables_of`, or what kernels in a row (`image | centroid`) make of the picture of one.

        Raises PicoError where there is none of that name, or the kernels can't make numbers of it.
        """
        from pico.diagnostics import PicoError, did_you_mean, error
        from pico.kernels.pipeline import parsed, require_numbers

        known = self.measurables_of(name)
        pipeline = parsed(measurable) if "|" in measurable else None
        asked = pipeline.source if pipeline else measurable
        found = known.get(asked)
        if found is None:
            hint = did_you_mean(asked[:40], known) or f"known: {', '.join(sorted(known)) or 'none'}"
            text = f"{name} has no measurable `{asked[:40]}`" if asked else f"what of {name} is to be measured?"
            raise PicoError(error("unknown-measurable", text, hint=hint, address=name))
        if pipeline is None:
            return found
        if found.datatype != "image" or found.kernel:
            text = f"{name}.{asked} is no picture: kernels have nothing to work on"
            raise PicoError(error("kernel", text, address=name))
        require_numbers(pipeline)
        kind = "float" if len(pipeline.last.units) == 1 else "numbers"
        return replace(found, datatype=kind, unit=pipeline.last.unit, kernel=measurable)  # type: ignore[arg-type]

    def at_speed(self, speed: float | None) -> Setup:
        """Return the same with every robot at a share of its joint limits; as it is where that is None."""
        if speed is None:
            return self
        robots = {name: replace(robot, speed=speed) for name, robot in self.lab.robots.items()}
        return replace(self, lab=replace(self.lab, robots=robots))

    def same_as(self, other: Setup) -> bool:
        """Whether this is the same lab with the same types, as digests tell it."""
        return self == other or self.digest() == other.digest()

    @remembered
    def digest(self) -> str:
        """Return the digest of the lab and its types as the first release wrote them, as a plan records it; parameters
        of a part count by their values, however they are written."""
        lab = self.lab
        if any(part.parameters is not None for part in lab.inventory.values()):
            lab = replace(lab, inventory={name: self._converted(part) for name, part in lab.inventory.items()})
        return digest({"lab": lab, "catalog": {n: as_first_written(kind) for n, kind in self.catalog.items()}})

    def _converted(self, part: Part) -> Part:
        if not part.parameters:
            return part if part.parameters is None else replace(part, parameters=None)
        declared = self.catalog[part.type].parameters
        return replace(part, parameters={name: value_of(declared[name], v) for name, v in part.parameters.items()})
