"""What became of a check as JUnit XML, which every continuous integration reads: a suite a lab, a case a question."""

from __future__ import annotations

import re
from xml.etree import ElementTree as xml

from pico.bench.checking.verdict import TITLES, Check, CheckReport, LabChecked
from pico.model.trace.expectation import Expected

from . import diagnostics
from .style import plain

_ILLEGAL = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What XML 1.0 can't hold, not even escaped."""


def junit(checked: CheckReport) -> str:
    """Return the document. Advice is no failure: it is the output of its case."""
    top = xml.Element("testsuites", name="pico check")
    for lab in checked.labs:
        top.append(_suite(lab))
    for key in ("tests", "failures"):
        top.set(key, str(sum(int(suite.get(key, "0")) for suite in top)))
    top.set("errors", "0")
    top.set("time", f"{sum(c.seconds for lab in checked.labs for c in lab.checks):.3f}")
    xml.indent(top)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + xml.tostring(top, encoding="unicode") + "\n"


def _suite(lab: LabChecked) -> xml.Element:
    name = lab.lab if lab.folder == "." else f"{lab.lab} ({lab.folder})"
    suite = xml.Element("testsuite", name=legal(name))
    for check in lab.checks:
        suite.append(_case(name, check))
        if check.question == "expectations":
            suite.extend(_expected(name, one) for one in lab.expectations)
    suite.set("tests", str(len(suite)))
    suite.set("failures", str(len(suite.findall("testcase/failure"))))
    suite.set("errors", "0")
    suite.set("skipped", str(len(suite.findall("testcase/skipped"))))
    suite.set("time", f"{sum(c.seconds for c in lab.checks):.3f}")
    return suite


def _case(lab: str, check: Check) -> xml.Element:
    title = TITLES[check.question]
    case = xml.Element("testcase", classname=legal(lab), name=title, time=f"{check.seconds:.3f}")
    source = next((d.source for d in check.diagnostics if d.source), None)
    if source:
        case.set("file", legal(source.path))
        case.set("line", str(source.start.line))
    body = legal(plain(diagnostics.text(check.diagnostics)))
    if check.verdict == "failed":
        failure = xml.SubElement(case, "failure", message=legal(check.text), type=check.question)
        failure.text = body or legal(check.text)
    elif check.verdict == "skipped":
        xml.SubElement(case, "skipped", message=legal(check.text))
    elif words := "\n\n".join(part for part in (legal(check.text), body) if part):
        xml.SubElement(case, "system-out").text = words
    return case


def _expected(lab: str, one: Expected) -> xml.Element:
    case = xml.Element("testcase", classname=legal(lab), name=legal(f"expect: {one.that}"), time="0.000")
    if not one.holds and not one.failed:
        xml.SubElement(case, "skipped", message=legal(one.why))
    elif not one.holds:
        verb = "fails" if one.holds is False else "can't be told"
        message = f"{one.message or one.that} {verb}"
        xml.SubElement(case, "failure", message=legal(message), type="expectation").text = legal(one.why or message)
    return case


def legal(text: str) -> str:
    """Return text as XML can hold it."""
    return _ILLEGAL.sub("\ufffd", text)
