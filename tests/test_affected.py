"""`make affected`: which test files a change concerns, by what imports and names what."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / ".ci"))

from affected import changed, concerned, deleted, report  # noqa: E402
from import_graph import Graph  # noqa: E402

SMALL = {
    "pyproject.toml": '[project.entry-points."pico.drivers"]\n"stage.z" = "pico.drivers.stage:Z"\n',
    "pico/__init__.py": "",
    "pico/model.py": "",
    "pico/drivers/__init__.py": "",
    "pico/drivers/bus.py": "",
    "pico/drivers/stage.py": "from pico.drivers.bus import Bus\n",
    "pico/planning/__init__.py": "",
    "pico/planning/check.py": "import pico.model\n",
    "pico/planning/pass_.py": "from pico.planning import check\n",
    "pico/planning/planner.py": "from pico.planning.pass_ import run\n",
    "pico/planning/typed.py": "import typing\nif TYPE_CHECKING:\n    from pico.planning import check\n",
    "pico/kernels/__init__.py": "",
    "pico/kernels/known.py": 'FOLDER = "pico.kernels.standard"\n',
    "pico/kernels/standard/__init__.py": "",
    "pico/kernels/standard/mean.py": "",
    "pico/bench.py": "from pico.planning.planner import plan\n",
    "cli/__init__.py": "",
    "cli/main.py": "",
    "cli/commands/__init__.py": "",
    "cli/commands/go.py": "def run():\n    from pico.bench import Bench\n    from ..views import shown\n",
    "cli/commands/stop.py": "",
    "cli/views.py": "",
    "catalog/lens.yaml": "name: lens\n",
    "labs/two/lab.yaml": "inventory:\n  a: {}\n  type: lens\n",
    "benchmarks/speed.py": "",
    "pico/drawing/page.html": "",
    "docs/how.md": "",
    "docs/why.md": "",
    "tests/conftest.py": "import pytest\n@pytest.fixture\ndef pico():\n    from pico_cli.main import main\n",
    "tests/commanding.py": "",
    "tests/benches.py": "from pico.bench import Bench\n",
    "tests/drivers/test_stage.py": 'DRIVER = "stage.z"\n',
    "tests/drivers/test_bus.py": "import pico.drivers.bus\n",
    "tests/planning/conftest.py": (
        "import pytest\nfrom pico.planning import planner\n"
        "@pytest.fixture\ndef planned():\n    return planner.plan()\n@pytest.fixture\ndef other():\n    return 1\n"
    ),
    "tests/planning/test_planner.py": "def test_it(planned):\n    pass\n",
    "tests/planning/test_other.py": "def test_it(other):\n    pass\n",
    "tests/planning/golden/plans_1.txt": "",
    "tests/kernels/test_known.py": "from pico.kernels.known import FOLDER\n",
    "tests/test_bench.py": "from benches import Bench\n",
    "tests/test_order.py": (
        'ROOT = Path(__file__).parent\nfor top in ("pico", "tests"):\n    (ROOT / top).rglob("*.py")\n'
    ),
    "tests/test_speed.py": "import speed\n",
    "tests/test_two.py": 'LAB = "labs/two"\n',
    "tests/test_docs.py": 'PAGES = (ROOT / "docs").glob("*.md")\nONE = "how.md"\n',
    "tests/cli/test_go.py": 'from commanding import Pico\ndef test_go(pico):\n    pico("--json", "go", "p1")\n',
    "tests/cli/test_stop.py": 'from commanding import Pico\ndef test_stop(pico):\n    pico(*"stop now".split())\n',
}
"""A repository in small: what each file imports and names."""


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Graph:
    root = tmp_path_factory.mktemp("small")
    for path, text in SMALL.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text)
    return Graph(root)


LISTING = {"tests/test_order.py"}
"""It lists the files of pico/ and tests/."""


@pytest.mark.parametrize(
    ("path", "tests"),
    [
        ("pico/runs/new.py", ""),
        ("benchmarks/speed.py", "test_speed"),
        ("pico/drivers/stage.py", "drivers/test_stage"),
        ("pico/drivers/bus.py", "drivers/test_bus drivers/test_stage"),
        ("pico/planning/check.py", "planning/test_planner"),
        ("pico/planning/planner.py", "planning/test_planner test_bench"),
        ("pico/planning/typed.py", ""),
        ("pico/kernels/standard/mean.py", "kernels/test_known"),
        ("pico/bench.py", "test_bench cli/test_go"),
        ("cli/commands/go.py", "cli/test_go"),
        ("cli/commands/stop.py", "cli/test_stop"),
        ("cli/views.py", "cli/test_go"),
        ("pico/planning/__init__.py", "planning/test_planner test_bench"),
        ("tests/benches.py", "test_bench"),
        ("tests/test_bench.py", "test_bench"),
        ("tests/planning/conftest.py", "planning/test_planner planning/test_other"),
        ("tests/planning/golden/plans_1.txt", "planning/test_planner planning/test_other"),
        ("catalog/lens.yaml", "test_two"),
        ("labs/two/lab.yaml", "test_two"),
        ("docs/how.md", "test_docs"),
        ("docs/why.md", "test_docs"),
        ("ui/src/page.ts", ""),
    ],
)
def test_a_change_chooses_the_tests_that_depend_on_it(small: Graph, path: str, tests: str) -> None:
    listing = LISTING if path.startswith(("pico/", "tests/")) else set()
    assert {*concerned(small, path)} == {f"tests/{name}.py" for name in tests.split()} | listing


def changed_graph(root: Path, gone: tuple[str, ...] = (), new: Mapping[str, str] | None = None) -> Graph:
    """Return the repository in small without some files, whose texts are known, and with new ones."""
    for path, text in {**{p: t for p, t in SMALL.items() if p not in gone}, **(new or {})}.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text)
    return Graph(root, {path: SMALL[path].encode() for path in gone})


@pytest.mark.parametrize(
    ("gone", "tests"),
    [
        ("pico/kernels/standard/mean.py", "kernels/test_known test_order"),
        ("pico/drivers/bus.py", "drivers/test_bus drivers/test_stage test_order"),
        ("pico/drivers/stage.py", "drivers/test_stage test_order"),
        ("cli/commands/stop.py", "cli/test_stop"),
        ("tests/benches.py", "test_bench test_order"),
        ("tests/test_bench.py", "test_order"),
        ("tests/planning/conftest.py", "planning/test_planner planning/test_other test_order"),
    ],
)
def test_what_is_deleted_or_renamed_chooses_those_that_needed_it(tmp_path: Path, gone: str, tests: str) -> None:
    graph = changed_graph(tmp_path, (gone,), {"pico/runs/renamed.py": SMALL[gone]})
    assert {*concerned(graph, gone)} == {f"tests/{name}.py" for name in tests.split()}


@pytest.mark.parametrize(
    ("path", "tests"),
    [
        ("pico/planning/check.py", "planning/test_planner test_order"),
        ("tests/test_bench.py", "test_bench test_order"),
        ("tests/benches.py", "test_bench test_order"),
        ("tests/planning/conftest.py", "planning/test_planner planning/test_other test_order"),
    ],
)
@pytest.mark.parametrize("text", ["def (\n", "x = 1\0\n"])
def test_a_file_that_is_no_python_chooses_its_tests_and_is_named(
    tmp_path: Path, path: str, tests: str, text: str
) -> None:
    graph = changed_graph(tmp_path, new={path: text})
    found = {path: concerned(graph, path)}
    assert {*found[path]} == {f"tests/{name}.py" for name in tests.split()}
    assert "cannot be read as Python" in "\n".join(report(found, graph))


def test_a_file_of_the_product_that_no_test_names_chooses_all(small: Graph) -> None:
    assert {*concerned(small, "pico/drawing/page.html")} == {*small.tests}


def test_texts_of_deleted_files_are_those_at_the_merge_base(tmp_path: Path) -> None:
    def git(*words: str) -> None:
        who = ("-c", "user.name=A", "-c", "user.email=a@localhost")
        subprocess.run(["git", *who, *words], cwd=tmp_path, check=True, capture_output=True)

    git("init", "-q", "-b", "main")
    (tmp_path / "one.py").write_text("import two\n")
    git("add", ".")
    git("commit", "-qm", "first")
    (tmp_path / "one.py").unlink()
    assert deleted(tmp_path, "main", ["one.py", "none.py", "page.md"]) == {"one.py": b"import two\n", "none.py": b""}


def test_more_depth_follows_more_imports_through_all_rooms(small: Graph) -> None:
    near, far = (concerned(small, "pico/planning/check.py", depth) for depth in (1, 3))
    assert "tests/test_bench.py" in far.keys() - near.keys()
    assert near["tests/planning/test_planner.py"] == "import it by way of pico/planning"


@pytest.mark.parametrize("path", ["pyproject.toml", "constraints.txt", "tests/conftest.py", "pico/__init__.py"])
def test_what_may_change_any_test_chooses_all(small: Graph, path: str) -> None:
    all_of_it = {t for t in small.tests if path != "pico/__init__.py" or "pico" in " ".join(small.tests[t].imports)}
    assert {*concerned(small, path)} >= all_of_it and all_of_it


def test_the_answer_says_what_why_and_how_many_of_how_many(small: Graph) -> None:
    found = {path: concerned(small, path) for path in ("pico/planning/check.py", "ui/src/page.ts")}
    assert [*report(found, small)] == [
        "  pico/planning/check.py: 2 (1 list the files of pico/, 1 import it by way of pico/planning)",
        "  ui/src/page.ts: no test reads it",
        f"Chosen: 2 of {len(small.tests)} test files, without slow tests. CI runs all of them.",
    ]


def test_what_changed_is_committed_edited_or_new(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def git(*words: str) -> None:
        who = ("-c", "user.name=A", "-c", "user.email=a@localhost")
        subprocess.run(["git", *who, *words], cwd=tmp_path, check=True, capture_output=True)

    def write(*names: str) -> None:
        for name in names:
            (tmp_path / name).write_text(f"{name} {len(names)}")

    git("init", "-q", "-b", "main")
    write("kept", "committed", "edited", "deleted", ".gitignore")
    (tmp_path / ".gitignore").write_text("ignored\n")
    git("add", ".")
    git("commit", "-qm", "first")
    git("checkout", "-qb", "branch")
    write("committed")
    git("commit", "-qam", "second")
    git("checkout", "-q", "main")
    write("kept", "of_main")
    git("add", ".")
    git("commit", "-qm", "main goes on")
    git("checkout", "-q", "branch")
    write("edited", "new", "ignored")
    (tmp_path / "deleted").unlink()
    assert changed(tmp_path)[1] == ["committed", "deleted", "edited", "new"]
    assert changed(tmp_path, "HEAD")[1] == ["deleted", "edited", "new"]


def test_in_this_repository_a_change_chooses_its_own_tests_and_not_all() -> None:
    graph = Graph()
    every = len(graph.tests)
    driver, check = (concerned(graph, f"pico/{path}.py") for path in ("drivers/elliptec", "planning/checks/emission"))
    assert "tests/drivers/test_driver_contract.py" in driver and len(driver) < every / 16
    assert "tests/planning/test_golden.py" in check and len(check) < every / 3
    assert not {t for t in check if t.startswith(("tests/drivers/", "tests/vision/", "tests/kernels/"))}
    assert "tests/cli/test_undo_commands.py" in concerned(graph, "cli/commands/undo.py")
    assert "tests/test_affected.py" in concerned(graph, ".ci/affected.py")
    assert len(concerned(graph, "tests/conftest.py")) == every == len(concerned(graph, "tests/asked_once.py"))
