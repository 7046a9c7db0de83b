"""How recipes went in the simulator: a line each, as JSON, and as JUnit XML."""

from __future__ import annotations

from collections.abc import Sequence
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
    mark = paint("green", "✓") if found.passed else paint("red", "✗")
    at = f"  {found.outcome} at step {found.at}" if found.at else "" if found.passed else f"  {found.outcome}"
    return f"{mark} {found.name}{at}  {paint('dim', seconds(found.seconds))}"


def text(found: Sequence[Rehearsed]) -> str:
    """Return how many passed."""
    if not found:
        return "no recipes here: files of `recipes/` that say `kind: Recipe`"
    failed = [one.name for one in found if not one.passed]
    return f"{count(len(found) - len(failed), 'recipe')} passed" + (f", {len(failed)} failed" if failed else "")


def data(found: Sequence[Rehearsed]) -> dict[str, Any]:
    """Return schema `pico.recipe_tests/v1`: `recipes` with `name`, `outcome`, `at`, `seconds`, `returns` and
    `diagnostics`."""
    rows = [
        {
            "name": one.name, "outcome": one.outcome, "at": one.at, "seconds": one.seconds,
            "returns": dict(one.returns), "diagnostics": as_json(one.diagnostics),
        } for one in found
    ]  # fmt: skip
    return {"schema": "pico.recipe_tests/v1", "passed": all(one.passed for one in found), "recipes": rows}


def junit(found: Sequence[Rehearsed], lab: str) -> str:
    """Return JUnit XML: one suite, a case a recipe."""
    failures = str(sum(not one.passed for one in found))
    took = f"{sum(one.seconds for one in found):.3f}"
    totals = {"tests": str(len(found)), "failures": failures, "errors": "0", "time": took}
    top = xml.Element("testsuites", {"name": "pico test", **totals})
    suite = xml.SubElement(top, "testsuite", {"name": legal(lab), **totals})
    for one in found:
        about = {"classname": legal(lab), "name": legal(one.name), "time": f"{one.seconds:.3f}"}
        case = xml.SubElement(suite, "testcase", about)
        if not one.passed:
            said = legal(plain(diagnostics.text(one.diagnostics)))
            failure = xml.SubElement(
                case, "failure", message=legal(f"{one.outcome} at step {one.at}"), type=one.outcome
            )
            failure.text = said
    xml.indent(top)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + xml.tostring(top, encoding="unicode") + "\n"
