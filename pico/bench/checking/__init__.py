"""`pico check`: what a change does to a lab, asked before anybody takes it over. The bench itself is not touched."""

from pico.bench.checking.labs import check
from pico.bench.checking.verdict import Check, CheckReport, LabChecked

__all__ = ["Check", "CheckReport", "LabChecked", "check"]
