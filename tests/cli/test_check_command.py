"""`pico check` as a person and continuous integration call it, its reports, and the files that hooks hand over."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree as xml

import pytest
from commanding import Pico, edit
from hypothesis import given
from hypothesis import strategies as st
from pico_cli.views.check_junit import junit
from pico_cli.views.check_markdown import report
from pico_cli.views.markdown import fenced, prose

from pico.bench.checking import Check, CheckReport, LabChecked
from pico.diagnostics import error
from pico.history.repository.comparison_base import ComparisonBase
from pico.model.diff import Change

STATE = "state/table.yaml"
HOSTILE = (
    "a | b @octocat #1 `x` ``` <img src=x> [y](http://z) ![i](j) ~~~ !2 www.evil.org HTTPS://EVIL.ORG mailto:a@b.org "
    "a@b.org\n## z \u202e\x1b[31m"
)


@pytest.fixture(autouse=True)
def _nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY", "GITHUB_BASE_REF"):
        monkeypatch.delenv(name, raising=False)


def tilt(shel: Path) -> None:
    edit(shel / STATE, "x: 520\n      y: 420\n      yaw: 0", "x: 520\n      y: 420\n      yaw: 30")


def test_verdicts_and_what_changes_are_shown(shel: Path, pico: Pico) -> None:
    tilt(shel)
    answer = pico("check")
    assert answer.code == 0 and answer.err == ""
    assert answer.out.startswith("shel · C3 with edits against main (") and "p2  turned +30°" in answer.out
    assert answer.out.count("✓") == 7 and answer.out.rstrip().endswith("Passed: all is well.")
    assert not (shel / ".pico").exists()


def test_a_refusal_names_the_pair_and_ends_with_3(shel: Path, pico: Pico) -> None:
    edit(shel / STATE, "x: 520", "x: 320")
    answer = pico("check", "C3")
    assert answer.code == 3 and "Refused: physically impossible." in answer.out
    assert re.search(r"error\[impossible\]: .*\bp1\b.*\bp2\b", answer.err) and "--> state/table.yaml:" in answer.err


def test_as_json_it_is_one_document(shel: Path, pico: Pico) -> None:
    edit(shel / STATE, "exposure: 10", "exposure: 2 kg")
    answer = pico("check", "--json")
    assert answer.code == 1 and answer.err == "" and answer.data["schema"] == "pico.check/v1"
    (lab,) = answer.data["labs"]
    assert answer.data["exit_code"] == lab["exit_code"] == 1
    assert lab["checks"][0]["diagnostics"][0]["source"]["path"] == STATE
    assert [c["verdict"] for c in lab["checks"]][2:] == ["skipped"] * 5


def test_the_report_is_written_with_its_pictures_and_printed_without(shel: Path, pico: Pico) -> None:
    tilt(shel)
    printed = pico("check", "--report", "out/report.md", "--junit", "out/junit.xml", "--markdown").out
    written = (shel / "out" / "report.md").read_text()
    links = re.findall(r"!\[\w+\]\(([^)]*)\)", written)
    assert [(shel / "out" / link).is_file() for link in links] == [True, True]
    assert printed.startswith("<!-- pico check -->\n## ✓ shel: all is well") and "![" not in printed
    assert "Pictures: out/pictures/shel-before.png, out/pictures/shel-after.png." in printed.replace("\\", "")
    assert str(shel) not in printed + written
    assert "| p2 | pose | (520, 420, 0°) | (520, 420, 30°) | turned +30° |" in printed
    assert "**Plan**: 1 move, 0 staged" in printed
    assert pico("check", "--report", "r.md", "--pictures", "none").code == 0 and "![" not in (shel / "r.md").read_text()


def test_a_report_does_not_follow_a_link_that_a_branch_put_there(shel: Path, pico: Pico, tmp_path: Path) -> None:
    (tmp_path / "precious").write_text("precious")
    (shel / "report.md").symlink_to(tmp_path / "precious")
    assert pico("check", "--report", "report.md", "--pictures", "none").code == 0
    assert (tmp_path / "precious").read_text() == "precious" and not (shel / "report.md").is_symlink()


def test_at_github_findings_stand_beside_their_lines_and_the_report_on_the_page_of_the_job(
    shel: Path, pico: Pico, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary"))
    edit(shel / STATE, "x: 520", "x: 320")
    with (shel / STATE).open("a") as file:
        file.write("expect:\n  - {that: 'p2.pose.x > 0.0', message: '::add-mask::p2'}\n")
    answer = pico("check")
    (command,) = [line for line in answer.err.splitlines() if line.lstrip().startswith("::")]
    assert command.startswith("::error file=state/table.yaml,line=") and "::p1 cannot stand at" in command
    assert (tmp_path / "summary").read_text().startswith("<!-- pico check -->")


def test_no_line_of_a_manifest_is_a_command_to_the_runner(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    words = "x" * 70 + " ::stop-commands::token"
    with (shel / STATE).open("a") as file:
        file.write(f"expect:\n  - {{that: 'p2.pose.x < 0.0', message: '{words} ::error::no'}}\n")
    answer = pico("check")
    assert answer.code == 6
    commands = [x for x in (answer.out + answer.err).splitlines() if x.lstrip().startswith("::")]
    assert [c.partition(" ")[0] for c in commands] == ["::error"]


# what a hostile branch says


def hostile(labs: int = 1, changes: int = 3, findings: int = 3) -> CheckReport:
    found = tuple(error("impossible", f"{n} {HOSTILE}", detail=HOSTILE * 4, hint=HOSTILE) for n in range(findings))
    failed = Check(question="stands", verdict="failed", text=HOSTILE, diagnostics=found)
    change = tuple(Change(component=f"c{n}", tunable=HOSTILE, before=HOSTILE, text=HOSTILE) for n in range(changes))
    one = LabChecked(lab=HOSTILE, folder=HOSTILE, checks=(failed,), changes=change, bench=(HOSTILE,), notes=(HOSTILE,))
    return CheckReport(what=HOSTILE, base=ComparisonBase(name=HOSTILE), labs=(one,) * labs)


def outside_code(markdown: str) -> str:
    return re.sub(r"(?ms)^(`{3,})text\n.*?^\1$", "", markdown)


@pytest.mark.parametrize("labs", [1, 3])
def test_nothing_that_a_branch_says_mentions_links_embeds_or_breaks_a_table(labs: int) -> None:
    text = outside_code(report(hostile(labs)))
    assert "octocat" in text
    assert not re.search(r"@\w|(?<!&)#\w|!\w|<(?!!-- pico check -->|details>|summary>|/)|://|www\.|mailto:", text)
    assert not re.search(r"(?<!\\)[`\[\]~]", text)
    assert "\u202e" not in text and "\x1b" not in text
    for block in re.findall(r"(?m)(?:^\|.*\n)+", text):
        assert len({line.count("|") for line in block.splitlines()}) == 1
    assert len(re.findall("(?m)^#", text)) == (1 if labs == 1 else 1 + labs)


def test_a_block_of_code_can_not_be_ended_from_within() -> None:
    block = fenced("a\n```\n````` x\nb").splitlines()
    assert block[0] == "``````text" and block[-1] == "``````" and block[1:-1] == ["a", "```", "````` x", "b"]


def test_prose_reads_as_it_was_written() -> None:
    assert prose("lx_125 (395, 420, 0°) → storage/a1, 5 %") == "lx_125 (395, 420, 0°) → storage/a1, 5 %"
    assert prose("_x_ *y*\nz") == r"\_x\_ \*y\* z"


@pytest.mark.parametrize(("labs", "changes", "findings"), [(1, 3000, 300), (10, 100, 30), (300, 2, 1)])
def test_a_report_fits_into_a_comment_and_counts_what_it_leaves_out(labs: int, changes: int, findings: int) -> None:
    text = report(hostile(labs, changes, findings))
    assert len(text) <= 60_000 and re.search(r"… and \d+ (more tunable|more finding|lab)s?", text)
    assert len(re.findall(r"(?m)^`{3,}", text)) % 2 == 0


# JUnit: the elements and attributes that Jenkins' schema of it has, in their order

SCHEMA = {
    "testsuites": ({"name", "time", "tests", "failures", "disabled", "errors"}, ["testsuite"]),
    "testsuite": (
        {"name", "tests", "failures", "errors", "time", "disabled", "skipped", "timestamp", "hostname", "id"},
        ["properties", "testcase", "system-out", "system-err"],
    ),
    "testcase": (
        {"name", "assertions", "time", "classname", "status", "file", "line"},
        ["skipped", "error", "failure", "system-out", "system-err"],
    ),
    "failure": ({"type", "message"}, []),
    "skipped": ({"type", "message"}, []),
    "system-out": (set(), []),
}  # fmt: skip


def breaches(node: xml.Element) -> Iterator[str]:
    attributes, children = SCHEMA[node.tag]
    yield from (f"{node.tag} has {name}" for name in node.attrib if name not in attributes)
    yield from (f"{node.tag} holds {child.tag}" for child in node if child.tag not in children)
    yield from (f"{node.tag} {k}={v}" for k, v in node.attrib.items() if k in ("tests", "line") and not v.isdigit())
    for child in node:
        yield from breaches(child)


def test_junit_has_a_case_for_each_question_and_each_expectation(shel: Path, pico: Pico) -> None:
    tilt(shel)
    with (shel / STATE).open("a") as file:
        file.write(
            'expect:\n  - that: p2.pose.yaw == 30.0\n  - {that: p2.pose.x < 0.0, message: "]]> & \\u0007 <x>"}\n'
        )
    assert pico("check", "--junit", "junit.xml").code == 6
    top = xml.parse(shel / "junit.xml").getroot()
    assert list(breaches(top)) == []
    suite = top[0]
    assert [suite.get(key) for key in ("name", "tests", "failures", "skipped")] == ["shel", "9", "2", "0"]
    (case,) = suite.findall("testcase[@name='expect: p2.pose.x < 0.0']")
    assert "]]> & \ufffd <x>" in str(case[0].get("message")) and "p2.pose.x is 520" in str(case[0].text)


def test_junit_of_what_is_not_valid_names_the_place_and_skips_the_rest(shel: Path, pico: Pico) -> None:
    edit(shel / STATE, "exposure: 10", "exposure: 2 kg")
    assert pico("check", "--junit", "junit.xml").code == 1
    top = xml.parse(shel / "junit.xml").getroot()
    assert list(breaches(top)) == []
    assert (top[0][0].get("file"), top[0][0].get("line")) == (STATE, "10") and top[0].get("skipped") == "5"


ANY = st.text(st.characters() | st.sampled_from("|`*_[]()<>@#!~&\n\x00\ud800"), max_size=60)


@given(ANY)
def test_whatever_is_said_is_one_cell_of_a_table_and_a_legal_document(words: str) -> None:
    cell = prose(words)
    assert not set(cell) & set("\n|<>") and not re.search(r"(?<!\\)`", cell)
    failed = Check(question="stands", verdict="failed", text=words, diagnostics=(error("impossible", words),))
    found = CheckReport(what=words, labs=(LabChecked(lab=words, checks=(failed,)),))
    assert list(breaches(xml.fromstring(junit(found).encode()))) == []
    assert report(found).encode()


# files that hooks hand over


def test_validate_checks_the_labs_of_the_files_and_passes_others_over(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(shel.parent)
    (shel.parent / "other.yaml").write_text("title: [not a manifest\n")
    assert pico("validate", "other.yaml").code == 0
    assert pico("validate", "shel/state/table.yaml", "other.yaml").out.startswith("shel: the manifests are valid")
    edit(shel / STATE, "exposure: 10", "exposure: 2 kg")
    answer = pico("validate", "shel/lab.yaml", "shel/state/table.yaml")
    assert answer.code == 1 and "--> shel/state/table.yaml:10:15" in answer.err
    (shel.parent / "lost.yaml").write_text("apiVersion: pico/v1\nkind: LabState\n")
    assert pico("validate", "lost.yaml").code == 1
    assert pico("validate", "nowhere.yaml").code == 1


def test_fmt_passes_files_of_other_programs_over(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(shel.parent)
    (shel.parent / "other.yaml").write_text("title: [not a manifest\n")
    edit(shel / STATE, "exposure: 10", "exposure:   10")
    assert pico("fmt", "--check", "other.yaml").code == 0
    assert pico("fmt", "other.yaml", "shel/state/table.yaml").out.startswith("shel/state/table.yaml")
