"""What a kernel is: a file with a declaration, `KERNEL`, and a function, `apply`; and what it returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

from pico.kernels.frame import Frame, Readings

Kind = Literal["image", "readings"]


@dataclass(frozen=True)
class Parameter:
    """A number that a kernel is told: its unit, its least value, and what it is without being told, None for must."""

    unit: str
    default: float | None = None
    least: float | None = None


@dataclass(frozen=True)
class Declaration:
    """What a kernel `takes` and what it gives: `units` of numbers by name, in their order; without any it gives an
    image. `version` changes whenever a value would."""

    version: str
    takes: Kind
    units: Mapping[str, str] = field(default_factory=dict)
    parameters: Mapping[str, Parameter] = field(default_factory=dict)

    @property
    def gives(self) -> Literal["image", "numbers"]:
        """What comes out."""
        return "numbers" if self.units else "image"

    @property
    def unit(self) -> str:
        """The units as a measurement has them: `um, um`."""
        return ", ".join(self.units.values())


@dataclass(frozen=True)
class Result:
    """Numbers by name with one standard deviation each, in the units of the same names; where there are none, `unknown`
    says why. `kernel` and its version: what made them. `remark`: what of the picture was left out, in words."""

    value: Mapping[str, float] = field(default_factory=dict)
    sigma: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    unknown: str = ""
    kernel: str = ""
    version: str = ""
    remark: str = ""


Given = Frame | Readings


class Kernel(Protocol):
    """A kernel's file. It imports nothing heavy at its top, for a lab is checked without numpy."""

    KERNEL: Declaration

    def apply(self, given: Given, parameters: Mapping[str, float]) -> Result | Frame:
        """Return what it makes of what is given; always the same of the same, and never raises: what can't be said is
        unknown."""
        ...
