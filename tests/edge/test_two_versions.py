"""Two versions of PICO at one lab: `requires_pico`, client and edge that differ, files that a newer one wrote."""

from __future__ import annotations

import os
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from commanding import Answer, Pico, edit
from serving import served

from pico import version
from pico.base.formats import Format
from pico.base.state_files import OWN_LAB
from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.edge import own_lab
from pico.manifest.load import load_files
from pico.resources import labs_dir

OTHER = "0.2.0"
UPGRADE = "upgrade PICO: `"


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small lab in Git, its first commit tagged `before`, to be copied."""
    root = Path(shutil.copytree(labs_dir() / "minimal", tmp_path_factory.mktemp("first") / "lab"))
    with pytest.MonkeyPatch.context() as patch, chdir(root):
        by_a_physicist(patch)
        git("init", "-q", "-b", "main")
        commit("the lab", "before")
    return root


@pytest.fixture(scope="module")
def second(first: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same with a second commit, tagged `after`, that requires a newer PICO and has what only that knows."""
    root = Path(shutil.copytree(first, tmp_path_factory.mktemp("second") / "lab"))
    require(root, '">=0.2"')
    edit(root / "lab.yaml", "inventory:\n", "laser_curtains: [north]\ninventory:\n")  # a key that 0.2 will know
    edit(root / "state" / "table.yaml", "components:\n", "components:\n  what_02_knows: {glows: true}\n")
    with pytest.MonkeyPatch.context() as patch, chdir(root):
        by_a_physicist(patch)
        commit("require PICO 0.2", "after")
    return root


@pytest.fixture
def lab(first: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the first lab as the current directory."""
    return here(first, tmp_path, monkeypatch)


@pytest.fixture
def newer(second: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the second lab as the current directory."""
    return here(second, tmp_path, monkeypatch)


def here(made: Path, to: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = Path(shutil.copytree(made, to / "lab"))
    monkeypatch.chdir(root)
    by_a_physicist(monkeypatch)
    return root


def by_a_physicist(patch: pytest.MonkeyPatch) -> None:
    for who in ("AUTHOR", "COMMITTER"):
        patch.setenv(f"GIT_{who}_NAME", "A Physicist")
        patch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")


def git(*words: str) -> None:
    subprocess.run(["git", *words], check=True, capture_output=True)


def commit(message: str, tag: str) -> None:
    git("add", ".")
    git("commit", "-qm", message)
    git("tag", tag)


def require(lab: Path, specifier: str) -> None:
    edit(lab / "lab.yaml", "table:\n", f"requires_pico: {specifier}\ntable:\n")


@pytest.fixture
def other(pico: Pico) -> Pico:
    """The command line of a PICO of another version."""

    def call(*words: str) -> Answer:
        with of_version(OTHER):
            return pico(*words)

    return call


@contextmanager
def served_by_other(root: Path) -> Iterator[None]:
    """Serve the bench by a PICO of another version meanwhile."""
    with of_version(OTHER):
        serving = served(root)
        serving.__enter__()
    try:
        yield
    finally:
        serving.__exit__(None, None, None)


def refused(answer: Answer, at: str, requirement: str = ">=0.2") -> bool:
    """Return whether an answer is one error alone: what is required and installed, where, and the command to run."""
    text = " ".join(answer.err.split())
    wanted = (
        f"error[requires-pico]: this lab requires PICO {requirement}, and this is PICO {version.__version__}",
        f"--> {at}:",
        f"= help: install that version: `{version.upgrade_command(requirement)}`",
    )
    return answer.code == 1 and answer.err.count("error[") == 1 and all(part in text for part in wanted)


@pytest.mark.parametrize("words", [
    "validate", "plan", "plan before", "plan HEAD", "apply --auto-approve", "status", "capture", "commit -m x", "log",
    "diff", "show", "set lens angle=3 -y", "move lens x=500 -y", "measure lens.pose", "recipe list", "run scan.yaml",
    "test", "check", "drift", "recover", "undo", "edge", "gui --no-open", "bench update", "bench use hardware",
    "catalog list", "catalog new mine --from linear_polarizer", "devices", "sim reset", "merge before", "git attach",
])  # fmt: skip
def test_an_older_pico_refuses_a_lab_with_every_command_that_reads_it(newer: Path, pico: Pico, words: str) -> None:
    answer = pico(*words.split())
    assert refused(answer, "lab.yaml") or refused(answer, f"{head()}:lab.yaml"), answer


def head() -> str:
    return subprocess.run(["git", "rev-parse", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()


def test_a_satisfied_requirement_changes_nothing(lab: Path, pico: Pico) -> None:
    before = pico("plan", "--json").data["operations"]
    require(lab, '">=0.1,<0.2"')
    assert pico("validate").code == 0 and pico("plan", "--json").data["operations"] == before
    with of_version("0.1.0.dev3"):
        assert refused(pico("validate"), "lab.yaml", ">=0.1,<0.2"), "0.1.0.dev3 precedes 0.1"
    with of_version("0.1.1rc1"):
        assert pico("validate").code == 0


@contextmanager
def of_version(known: str) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(version, "__version__", known)
        yield


def test_an_old_commit_that_requires_another_pico_is_not_planned(lab: Path, pico: Pico, other: Pico) -> None:
    require(lab, '">=0.2"')
    commit("require PICO 0.2", "after")
    git("checkout", "-q", "before")
    then = head()
    assert pico("plan").code == 0
    for words in (
        "plan after",
        "apply after --auto-approve",
        "checkout after",
        "checkout after --files-only",
        "merge after",
    ):
        at = "before+after:lab.yaml" if "merge" in words else "after:lab.yaml"
        assert refused(pico(*words.split()), at), words
    assert head() == then
    assert "can't be read: this lab requires PICO >=0.2, and this is PICO" in pico("log", "after").out
    assert other("plan", "after").code == 0, "a PICO that satisfies it plans the same commit"


@pytest.mark.parametrize(
    ("specifier", "said"),
    [
        ('"0.2"', "requires_pico is `0.2`, which is not a version specifier"),
        ('">=x"', "requires_pico is `>=x`, which is not a version specifier"),
        ('""', "requires_pico is ``, which is not a version specifier"),
        ("0.2", '| 8 | requires_pico: 0.2 | ^^^ | = help: expected text: put it in quotes, ">=0.2"'),
        ('"^0.3"', 'requires_pico is `^0.3`, which is not a version specifier'),
        (">=0.2", "`>` and `|` begin a block of text"),
    ],
)  # fmt: skip
def test_what_is_no_version_specifier_is_an_error_at_its_line(lab: Path, pico: Pico, specifier: str, said: str) -> None:
    edit(lab / "lab.yaml", "table:\n", f"requires_pico: {specifier}\ntable:\n")
    line = 1 + (lab / "lab.yaml").read_text().splitlines().index(f"requires_pico: {specifier}")
    answer = pico("validate")
    text = " ".join(answer.err.split()).replace(f"lab.yaml:{line}:", "lab.yaml:8:").replace(f"| {line} |", "| 8 |")
    assert answer.code == 1 and answer.err.count("error[") == 1, answer.err
    assert said in text and "--> lab.yaml:8:" in text and '">=0.' in text, text
    assert "^" not in specifier or '`requires_pico: ">=0.3"`' in text


@pytest.mark.parametrize(
    ("specifier", "way"),
    [
        (">=0.2", "newer"), (">0.1", "newer"), (">0.1.0", "newer"), ("~=0.2", "newer"), ("==0.2.*", "newer"),
        ("==0.2", "newer"), (">=0.2,<0.4", "newer"), (">=1!0.1", "newer"), (">=0.2rc1", "newer"),
        ("==0.1.0+own", "newer"),
        ("<0.1", "older"), ("<0.1.0", "older"), ("<=0.0.9", "older"), ("==0.0.*", "older"), ("~=0.0.3", "older"),
        ("==0.1.0.dev3", "older"), (">=0.0.2,!=0.1.0,<0.1.1.dev0", "other"), ("!=0.1.0", "other"), ("!=0.1.*", "other"),
        (">=0.3,<0.2", "never"), (">0.2,<=0.2", "never"), ("==0.2,==0.3", "never"), (">=0.2,!=0.2.*,<0.3", "never"),
        ("<0", "never"), ("~=0.2,<0.1", "never"), ("===latest", "other"), ("===0.2", "newer"),
    ],
)  # fmt: skip
def test_what_a_requirement_needs_is_said(specifier: str, way: str) -> None:
    with of_version("0.1.0"):
        assert not version.satisfies(specifier) and version.needed(specifier) == way


@pytest.mark.parametrize(
    ("specifier", "said"),
    [
        ('"<0.1"', "install an older PICO: `"),
        ('"!=0.1.0"', "install another PICO: `"),
        ('">=0.3,<0.2"', "no version satisfies all of it: correct `requires_pico`"),
    ],
)
def test_who_needs_no_newer_pico_is_not_sent_to_one(lab: Path, pico: Pico, specifier: str, said: str) -> None:
    require(lab, specifier)
    with of_version("0.1.0"):
        answer = pico("validate")
    assert answer.code == 1 and said in answer.err and "install that version" not in answer.err, answer.err
    assert "pull" not in answer.err or "another" in said


def test_files_that_are_wrong_are_checked_out_with_the_way_back(lab: Path, pico: Pico) -> None:
    git("checkout", "-qb", "wrong")
    edit(lab / "lab.yaml", "type: plano_convex_100", "type: nonsuch")
    commit("no such lens", "nonsuch")
    git("checkout", "-q", "before")
    git("checkout", "-qb", "here")
    answer = pico("checkout", "wrong", "--files-only")
    assert answer.code == 1 and "there is no component type `nonsuch`" in answer.err
    assert "the files are at wrong now" in answer.err and "`git checkout here` goes back" in answer.err
    git("checkout", "-q", "here")
    assert pico("validate").code == 0


def test_a_client_of_another_version_works_at_the_edge_while_the_lab_allows_both(
    lab: Path, pico: Pico, other: Pico
) -> None:
    with served_by_other(lab):
        assert pico("move", "lens", "x=600", "-y").code == 0
        assert '"x": 600' in " ".join(pico("get", "lens", "--json").out.split())
        assert other("status").code == 0


def test_an_edge_refuses_to_adopt_a_lab_that_requires_a_newer_pico(lab: Path, pico: Pico, other: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    kept = own_lab.read(bench_at(lab))
    with served(lab):
        require(lab, '">=0.2"')
        answer = other("bench", "update", "--yes")
        assert refused(answer, "lab.yaml"), answer
        assert own_lab.read(bench_at(lab)) == kept
        assert other("plan").code == 0, "plans go by the Lab that the edge has"


def test_an_older_client_refuses_the_lab_of_a_newer_edge(lab: Path, pico: Pico, other: Pico) -> None:
    with served_by_other(lab):
        assert other("apply", "--auto-approve").code == 0
        require(lab, '">=0.2"')
        assert other("bench", "update", "--yes").code == 0
        git("checkout", "-q", "lab.yaml")
        kept = own_lab.read(bench_at(lab))
        at = "the bench's own lab.yaml"
        for words in (["plan"], ["apply", "--auto-approve"], ["bench", "update", "--yes"]):
            assert refused(pico(*words), at), words
        assert own_lab.read(bench_at(lab)) == kept
    assert refused(pico("status"), at), "without the edge its files say the same"


def test_a_call_of_a_newer_client_is_refused_with_the_versions(lab: Path) -> None:
    from pico.edge.link.wire import read_answer, read_call

    with pytest.raises(PicoError) as at_the_edge:
        read_call(b'{"call": "glow", "with": []}')
    with pytest.raises(PicoError) as at_the_client:
        read_answer("holder", b'{"value": {"glows": true}}')
    for found in (at_the_edge, at_the_client):
        hint = found.value.diagnostics[0].hint
        assert f"PICO {version.__version__}" in hint and UPGRADE in hint


def newer_journal(lab: Path) -> Path:
    path = lab / ".pico/benches/sim/journal.sqlite"
    with sqlite3.connect(path) as database:
        database.execute("PRAGMA user_version=99")
    database.close()
    return path


def newer_lab(lab: Path) -> Path:
    kept = own_lab.read(bench_at(lab))
    assert kept is not None
    newer = replace(OWN_LAB, format=Format("pico.bench-lab", (dict,) * 98))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(own_lab, "OWN_LAB", newer)
        own_lab.write(bench_at(lab), kept)
    return OWN_LAB.path(lab / ".pico/benches/sim")


@pytest.mark.parametrize("write", [newer_journal, newer_lab])
def test_a_file_of_a_newer_pico_is_refused_and_left_untouched(
    lab: Path, pico: Pico, write: Callable[[Path], Path]
) -> None:
    with Bench.open(lab) as bench:
        bench.apply()
    path = write(lab)
    before = path.read_bytes()
    edit(lab / "state" / "table.yaml", "x: 660", "x: 640")
    edit(lab / "lab.yaml", "A laser, a lens", "A laser and a lens")
    for words in ("apply --auto-approve", "move lens x=600 -y", "undo", "recover", "commit -m x", "bench update --yes"):
        answer = pico(*words.split())
        text = " ".join(answer.err.split())
        assert answer.code == 1 and path.name in text and UPGRADE in text, (words, answer)
        assert path.read_bytes() == before, words


def test_the_upgrade_command_fits_how_pico_was_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    python, clone = sys.executable, tmp_path / "a clone"
    (clone / ".git").mkdir(parents=True)
    for installed, command in {
        (str(clone), "pip"): f"git -C '{clone}' pull && {python} -m pip install -e '{clone}'",
        ("", "pip"): f"{python} -m pip install --upgrade 'pico-lab>=0.2,<1'",
        ("", "uv"): f"uv pip install --python {python} --upgrade 'pico-lab>=0.2,<1'",
        (str(tmp_path / "deleted"), "pip"): f"{python} -m pip install --upgrade 'pico-lab>=0.2,<1'",
    }.items():  # fmt: skip
        monkeypatch.setattr(version, "_installation", lambda found=installed: found)
        assert version.upgrade_command(">=0.2, <1") == command


def test_a_lab_without_the_requirement_never_imports_its_library(lab: Path) -> None:
    program = "import sys; from pico_cli.main import main; main(['plan']); print('packaging' in sys.modules)"
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ)
    assert done.stdout.splitlines()[-1] == "False"


def test_a_lab_document_in_memory_is_refused_the_same(lab: Path) -> None:
    require(lab, '">=0.2"')
    files = {path.name: path.read_bytes() for path in lab.rglob("*.yaml")}
    found = load_files(files)
    assert [d.code for d in found.diagnostics] == ["requires-pico"] and found.setup is None and found.state is None
