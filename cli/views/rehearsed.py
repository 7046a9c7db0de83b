"""How recipes went in the simulator: a line each, as JSON, and as JUnit XML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as xml

from pico.model.record import as_json

from . import diagnostics
from .check_junit import legal
from .style import count, paint, plain, seconds

if TYPE_CHECKING:
    from pico.recipes.rehearsing import Rehearsed


def line(found: Rehearsed) -> str:
    """Return how one recipe went."""
    if found.skipped:
        return f"{paint('dim', '–')} {found.name}  skipped: {found.why}"
    mark = paint("green", "✓") if found.passed else paint("red", "✗")
    at = f"  {found.outcome} at step {found.at}" if found.at else "" if found.passed else f"  {found.outcome}"
    return f"{mark} {found.name}{at}  {paint('dim', seconds(found.seconds))}"


def text(found: Sequence[Rehearsed]) -> str:
    """Return how many passed."""
    if not found:
        return "no recipes here: files of `recipes/` that say `kind: Recipe`"
    failed, skipped = sum(not one.passed for one in found), sum(one.skipped for one in found)
    more = [f"{number} {word}" for number, word in ((failed, "failed"), (skipped, "skipped")) if number]
    return ", ".join([f"{count(len(found) - failed - skipped, 'recipe')} passed", *more])


def data(labs: Mapping[str, Sequence[Rehearsed]]) -> dict[str, Any]:
    """Return schema `pico.recipe_tests/v1`: `recipes` with `lab`, `name`, `outcome`, `at`, `why` it was skipped,
    `seconds`, `returns` and `diagnostics`."""
    rows = [
        {
            "lab": lab, "name": one.name, "outcome": one.outcome, "at": one.at, "why": one.why,
            "seconds": one.seconds, "returns": dict(one.returns), "diagnostics": as_json(one.diagnostics),
        } for lab, found in labs.items() for one in found
    ]  # fmt: skip
    passed = all(one.passed for found in labs.values() for one in found)
    return {"schema": "pico.recipe_tests/v1", "passed": passed, "recipes": rows}


def junit(labs: Mapping[str, Sequence[Rehearsed]]) -> str:
    """Return JUnit XML: a suite a lab, a case a recipe."""
    totals = _totals([one for found in labs.values() for one in found])
    del totals["skipped"]  # which the schema gives to suites alone
    top = xml.Element("testsuites", {"name": "pico test", **totals})
    for lab, found in labs.items():
        suite = xml.SubElement(top, "testsuite", {"name": legal(lab), **_totals(found)})
        for one in found:
            about = {"classname": legal(lab), "name": legal(one.name), "time": f"{one.seconds:.3f}"}
            _case(xml.SubElement(suite, "testcase", about), one)
    xml.indent(top)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + xml.tostring(top, encoding="unicode") + "\n"


def _totals(found: Sequence[Rehearsed]) -> dict[str, str]:
    return {
        "tests": str(len(found)), "failures": str(sum(not one.passed for one in found)), "errors": "0",
        "skipped": str(sum(one.skipped for one in found)), "time": f"{sum(one.seconds for one in found):.3f}",
    }  # fmt: skip


def _case(case: xml.Element, one: Rehearsed) -> None:
    """Write down why a recipe was skipped, or how it failed."""
    if one.skipped:
        xml.SubElement(case, "skipped", message=legal(one.why))
    if not one.passed:
        about = legal(f"{one.outcome} at step {one.at}")
        xml.SubElement(case, "failure", message=about, type=one.outcome).text = legal(
            plain(diagnostics.text(one.diagnostics))
        )
