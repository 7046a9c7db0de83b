"""What is offered to continuous integration and to pre-commit runs as it stands there."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from pico_cli.app import build

ROOT = Path(__file__).resolve().parent.parent
CI = ROOT / "examples" / "ci"
GITHUB = yaml.safe_load((CI / "github.yml").read_text())
GITLAB = yaml.safe_load((CI / "gitlab.yml").read_text())
HOOKS = {hook["id"]: hook for hook in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())}
STEPS: list[dict[str, Any]] = GITHUB["jobs"]["check"]["steps"]


def commands() -> Iterator[str]:
    """Yield every line that calls pico, of workflows, hooks and the page about them."""
    lines = [step["run"] for step in STEPS if "run" in step]
    lines += [*GITLAB["lab"]["script"], *(hook["entry"] for hook in HOOKS.values())]
    page = (ROOT / "docs" / "how-to" / "ci.md").read_text()
    lines += [*re.findall(r"(?m)^\$ (pico .*)$", page), *re.findall(r"`(pico check[^`]*)`", page)]
    yield from (line for line in lines if line.startswith("pico "))


@pytest.mark.parametrize("line", sorted(set(commands())))
def test_every_command_and_option_exists(line: str) -> None:
    words = shlex.split(line.partition(">")[0])[1:]
    command = build().get_command(None, words[0])
    known = {option for parameter in command.params for option in parameter.opts}
    assert {w for w in words[1:] if w.startswith("-")} <= known


def test_what_is_installed_is_the_labs_own_pin_for_there_is_no_package_to_name() -> None:
    (github,) = [step["run"] for step in STEPS if "pip install" in step.get("run", "")]
    (gitlab,) = GITLAB["lab"]["before_script"]
    assert [shlex.split(line, comments=True)[-2:] for line in (github, gitlab)] == 2 * [["-r", "pico.txt"]]
    assert "`pico.txt`" in (CI / "README.md").read_text()


@pytest.fixture
def pull_request(case_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A clone as continuous integration makes it: of a branch merged into main, HEAD detached, and `pico` on PATH."""
    shutil.copytree(case_study, tmp_path / "origin")
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.setenv("RUNNER_TEMP", str(tmp_path / "temp"))
    (tmp_path / "temp").mkdir()
    clone = tmp_path / "clone"
    for words in (("clone", "-q", "origin", "clone"), ("-C", "clone", "checkout", "-q", "--detach", "origin/e1"),
                  ("-C", "clone", "merge", "-q", "--no-ff", "-m", "merge", "origin/main")):  # fmt: skip
        subprocess.run(["git", *words], cwd=tmp_path, check=True, capture_output=True)
    tools = tmp_path / "bin"
    tools.mkdir()
    program = "import sys; from pico_cli.main import main; sys.exit(main())"
    (tools / "pico").write_text(f'#!/bin/sh\nexec {sys.executable} -c "{program}" "$@"\n')
    (tools / "pico").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tools}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    return clone


def shell(line: str, folder: Path, **environment: str) -> int:
    """Run a step as GitHub's runner does."""
    words = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", line]
    return subprocess.run(words, cwd=folder, env=os.environ | environment, check=False, capture_output=True).returncode


@pytest.mark.parametrize(("broken", "code"), [pytest.param(False, 0, marks=pytest.mark.slow), (True, 3)])
def test_the_check_of_the_github_workflow_runs(pull_request: Path, broken: bool, code: int) -> None:
    if broken:
        state = pull_request / "state" / "table.yaml"
        state.write_text(state.read_text().replace("x: 520", "x: 320"))
    (line,) = [step["run"] for step in STEPS if step.get("name") == "Check"]
    temp = pull_request.parent / "temp"
    assert shell(line, pull_request, GITHUB_ACTIONS="true", GITHUB_BASE_REF="main") == code
    said = (temp / "comment.md").read_text()
    assert said.startswith(f"<!-- pico check -->\n## {'✗' if broken else '✓'} shel: ") and "origin/main" in said
    made = {str(path.relative_to(temp)) for path in temp.rglob("*") if path.is_file()}
    assert made == {"comment.md", "report/report.md", "report/junit.xml", "report/pictures/shel-before.png",
                    "report/pictures/shel-after.png"}  # fmt: skip
    left = subprocess.run(["git", "status", "--porcelain", "--ignored"], cwd=pull_request, check=True,
                          capture_output=True, text=True)  # fmt: skip
    assert left.stdout.split() == (["M", "state/table.yaml"] if broken else [])


def test_the_script_of_the_gitlab_job_runs(pull_request: Path) -> None:
    with_one_recipe(pull_request)
    for line in GITLAB["lab"]["script"]:
        assert shell(line, pull_request, CI_MERGE_REQUEST_TARGET_BRANCH_NAME="main") == 0
    kept = [pull_request / path for path in GITLAB["lab"]["artifacts"]["paths"]]
    assert all(path.is_dir() for path in kept)
    assert all((pull_request / path).is_file() for path in GITLAB["lab"]["artifacts"]["reports"]["junit"])


def test_the_workflow_runs_the_recipes_without_an_identity(pull_request: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where nothing was checked before: it fails by its own recipe alone."""
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.delenv(f"GIT_{who}_NAME")
        monkeypatch.delenv(f"GIT_{who}_EMAIL")
    with_one_recipe(pull_request)
    (line,) = [step["run"] for step in STEPS if step.get("run", "").startswith("pico test")]
    assert shell(line, pull_request) == 0
    assert (pull_request.parent / "temp" / "report" / "recipes.xml").is_file()


def with_one_recipe(lab: Path) -> None:
    """Leave a lab one recipe, that takes no time, takes a branch that only `origin` has, and writes a note."""
    shutil.rmtree(lab / "recipes")
    (lab / "recipes").mkdir()
    steps = "steps:\n- apply: e1\n- note: {p1: was here}\n"
    (lab / "recipes" / "one.yaml").write_text(f"apiVersion: pico/v1\nkind: Recipe\nmetadata: {{name: one}}\n{steps}")


def test_the_comment_is_written_over_the_one_before(pull_request: Path) -> None:
    """With a stand-in for GitHub's own command, which writes down how it was called."""
    (line,) = [step["run"] for step in STEPS if step.get("name") == "Comment"]
    temp, tools = pull_request.parent / "temp", pull_request.parent / "bin"
    told = temp / "told"
    (tools / "gh").write_text(f'#!/bin/sh\necho "$*" >> {told}\ncase "$*" in *--jq*) printf "%s" "$BEFORE";; esac\n')
    (tools / "gh").chmod(0o755)
    given = {"NUMBER": "7", "GITHUB_REPOSITORY": "a/b", "RUN": "the run"}
    assert shell(line, pull_request, **given) == 0 and not told.exists()
    (temp / "comment.md").write_text("<!-- pico check -->\n")
    assert shell(line, pull_request, **given, BEFORE="") == 0
    assert told.read_text().splitlines()[-1].startswith("pr comment 7 --repo a/b --body-file")
    assert shell(line, pull_request, **given, BEFORE="99") == 0
    assert "PATCH repos/a/b/issues/comments/99" in told.read_text().splitlines()[-1]
    assert "the run" in (temp / "comment.md").read_text()


def test_a_fork_never_meets_a_secret_or_a_token_that_may_write() -> None:
    assert set(GITHUB[True]) == {"pull_request", "push"}  # YAML 1.1 reads `on` as true
    assert GITHUB["permissions"] == {"contents": "read", "pull-requests": "write"}
    assert "secrets." not in (CI / "github.yml").read_text()
    (comment,) = [step for step in STEPS if step.get("name") == "Comment"]
    assert "head.repo.full_name == github.repository" in comment["if"]
    checkout = next(step["with"] for step in STEPS if step.get("uses", "").startswith("actions/checkout"))
    assert checkout == {"fetch-depth": 0, "persist-credentials": False} and GITLAB["lab"]["variables"]["GIT_DEPTH"] == 0
    assert all("${{" not in step["run"] for step in STEPS if "run" in step)  # what a branch is called is no shell


@pytest.mark.parametrize(
    ("path", "ours"),
    [("lab.yaml", True), ("labs/a/state/table.yaml", True), ("trunks/x.yaml", True), (".github/x.yaml", False),
     (".hidden.yaml", False), ("runs/2026/x.yaml", False), ("labs/a/runs/x.yaml", False), ("mkdocs.yml", False)],
)  # fmt: skip
def test_hooks_look_at_what_pico_reads(path: str, ours: bool) -> None:
    for name in ("pico-fmt", "pico-validate"):
        assert bool(re.search(HOOKS[name]["files"], path)) == ours


@pytest.mark.slow
def test_the_hooks_run_as_pre_commit_calls_them(pull_request: Path) -> None:
    files = [str(p.relative_to(pull_request)) for p in pull_request.rglob("*.yaml")]
    for hook in HOOKS.values():
        given = files if hook.get("pass_filenames", True) else []
        assert shell(shlex.join([*shlex.split(hook["entry"]), *given]), pull_request) == 0, hook["id"]
    shutil.copy(pull_request / "state" / "table.yaml", pull_request / "state" / "again.yaml")
    assert shell(f"{HOOKS['pico-validate']['entry']} state/again.yaml", pull_request) == 1
    assert HOOKS["pico-feasible"]["stages"] == ["pre-merge-commit", "pre-push"]
    assert HOOKS["pico-feasible"]["pass_filenames"] is False
