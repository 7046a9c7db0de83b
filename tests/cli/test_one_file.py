"""What is added to PICO as one file is there everywhere: a command, and a type of component."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pico_cli.commands
import pytest
from commanding import Pico, edit
from pico_cli.at_once.complete import candidates
from pico_cli.at_once.help import help_text

from pico.resources import catalog_dir, labs_dir

ROOT = Path(__file__).resolve().parents[2]

BLINK = '''"""`pico blink-twice`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from pico_cli.arguments import Component
from pico_cli.session import Session

HEADING = "The main job"
ORDER = 25

How = Annotated[str, typer.Option("--how", metavar="slowly|fast", help="At what pace.")]
Where = Annotated[Path | None, typer.Option(metavar="FILE", help="Where it is told.")]


def blink_twice(
    context: typer.Context, part: Component, how: How = "fast", told_where: Where = None, times: int = 2
) -> int:
    """Blink with a component, twice."""
    session = Session.of(context)
    if part == "nothing":
        raise ZeroDivisionError("nothing blinks")
    if session.json:
        session.document({"schema": "pico.blink/v1", "part": part, "how": how, "backend": session.backend})
    session.say(f"{part} blinks {how} in {session.folder}")
    return 0
'''


@pytest.fixture
def blink(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder beside that of the commands, with one more in it."""
    folder = tmp_path / "more"
    folder.mkdir()
    (folder / "blink_twice.py").write_text(BLINK)
    monkeypatch.setattr(pico_cli.commands, "__path__", [*pico_cli.commands.__path__, str(folder)])
    monkeypatch.delitem(sys.modules, "pico_cli.commands.blink_twice", raising=False)
    return folder


def test_a_command_of_one_file_is_in_the_help_and_has_its_own(blink: Path, pico: Pico) -> None:
    section = help_text().split("The main job:\n")[1].split("\n\n")[0].splitlines()
    assert section[2:4] == ["  blink-twice Blink with a component, twice.", section[3]] and "  plan " in section[3]
    answer = pico("blink-twice", "--help")
    assert answer.code == 0 and "Usage: pico blink-twice [OPTIONS]" in answer.out
    assert {"--how", "--told-where", "-C", "--json", "--debug", "--backend"} <= set(answer.out.replace(",", "").split())
    assert "did you mean `blink-twice`" in pico("blnk-twice").err


def test_a_command_of_one_file_takes_the_shared_options_before_and_after_its_name(blink: Path, pico: Pico) -> None:
    given = ["-C", "/", "--json", "--debug", "--backend", "hardware"]
    wanted = {"schema": "pico.blink/v1", "part": "p1", "how": "fast", "backend": "hardware"}
    for words in ([*given, "blink-twice", "p1"], ["blink-twice", *given, "p1"], ["blink-twice", "p1", *given]):
        answer = pico(*words)
        assert (answer.code, answer.data) == (0, wanted), words
    assert pico("-C", "/", "blink-twice", "p1").out == "p1 blinks fast in /\n"
    assert "Traceback" in pico("--debug", "blink-twice", "nothing").err
    assert "Traceback" not in pico("blink-twice", "nothing").err


def test_a_command_of_one_file_is_completed(blink: Path, shel: Path) -> None:
    assert candidates(["bl"]) == ["blame", "blink-twice"]
    assert candidates(["blink-twice", "--"]) == [
        "--backend",
        "--bench",
        "--debug",
        "--emulate",
        "--help",
        "--how",
        "--json",
        "--told-where",
    ]
    assert candidates(["blink-twice", "--how", ""]) == ["fast", "slowly"]
    assert candidates(["blink-twice", "--how", "fast", "p"]) == ["p1", "p2"]


def test_a_command_of_one_file_is_there_once_it_lies_in_the_folder(tmp_path: Path) -> None:
    """In a copy of the command, as a process of its own: nothing else has to know of it."""
    shutil.copytree(ROOT / "cli", tmp_path / "pico_cli", ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "pico_cli" / "commands" / "blink_twice.py").write_text(BLINK)
    program = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); from pico_cli.main import main; sys.exit(main())"

    def said(*words: str, **environment: str) -> str:
        run = [sys.executable, "-c", program, *words]
        return subprocess.run(run, capture_output=True, text=True, check=True, env=os.environ | environment).stdout

    assert "blink-twice Blink with a component, twice." in said("--help")
    assert said("bli", _PICO_COMPLETE="1") == "blink-twice\n"
    assert said("blink-twice", "p1", "-C", "/") == "p1 blinks fast in /\n"


@pytest.fixture
def catalog(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A catalog folder with one file more: the type that the page about types writes."""
    folder = tmp_path / "catalog"
    shutil.copytree(catalog_dir(), folder)
    page = (ROOT / "docs" / "how-to" / "component-type.md").read_text()
    (folder / "pinhole_25.yaml").write_text(page.split("```yaml\n")[1].split("```")[0])
    monkeypatch.setattr("pico.resources._folder", lambda name: tmp_path / name if name == "catalog" else ROOT / name)
    return folder


def test_a_type_of_one_file_is_listed_checked_planned_and_moved(
    catalog: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    lab = tmp_path / "lab"
    shutil.copytree(labs_dir() / "minimal", lab)
    monkeypatch.chdir(lab)
    edit(lab / "lab.yaml", "  lens:\n", "  hole: {type: pinhole_25, marker: 2, home: storage/a1}\n  lens:\n")
    edit(lab / "state" / "table.yaml", "  lens: ", "  hole: {pose: {x: 560, y: 340, yaw: 90}}\n  lens: ")
    assert "pinhole_25" in pico("catalog", "list").out
    assert pico("validate").code == 0
    plan = pico("plan", "--json").data
    assert [op["primitive"] for op in plan["operations"] if op["component"] == "hole"] == ["move"]
    assert pico("apply", "--auto-approve").code == 0
    assert pico("get", "hole", "--json").data["values"]["pose"]["value"]["yaw"] == pytest.approx(90, abs=0.5)
    assert pico("plan", "--detailed-exitcode").code == 0


def test_a_type_without_its_file_is_not_known(tmp_path: Path, pico: Pico) -> None:
    shutil.copytree(labs_dir() / "minimal", tmp_path / "lab")
    edit(
        tmp_path / "lab" / "lab.yaml", "  lens:\n", "  hole: {type: pinhole_25, marker: 2, home: storage/a1}\n  lens:\n"
    )
    answer = pico("-C", str(tmp_path / "lab"), "validate")
    assert answer.code == 1 and "pinhole_25" in answer.err
    lens = (
        (catalog_dir() / "linear_polarizer.yaml").read_text().replace("name: linear_polarizer", "name: pinhole_25", 1)
    )
    for old, new, told in (
        ("    unit: deg", "\tunit: deg", "a tab in the indentation"),
        ("    unit: deg", "    unit: dge", "did you mean `deg`?"),
        (", set, ", ", ", "warning[unset]: `angle` of pinhole_25 can be set"),
    ):
        (tmp_path / "lab" / "pinhole_25.yaml").write_text(lens.replace(old, new, 1))
        answer = pico("-C", str(tmp_path / "lab"), "validate")
        assert told in answer.err.split("error[unknown-type]")[0], answer.err


BODIES = re.compile(r"  bodies:.*?\n(?=  grasp)", re.DOTALL)


@pytest.mark.parametrize(("change", "told"), [
    (lambda text: BODIES.sub("", text), "its footprint, which is as high as all of it, stands 15 mm inside"),
    (lambda text: text.replace("size: [30, 30, 40]", "size: [40, 40, 40]"), "grip stands 5 mm inside"),
    (lambda text: text.replace("[30, 30, 40]", "[30, 50, 40]").replace("[0, 90]", "[90]"), "grip stands 10 mm"),
])  # fmt: skip
def test_a_type_that_no_gripper_can_hold_is_told_at_its_own_line(
    tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch, change: Callable[[str], str], told: str
) -> None:
    lab = tmp_path / "lab"
    shutil.copytree(labs_dir() / "minimal", lab)
    monkeypatch.chdir(lab)
    edit(lab / "lab.yaml", "  lens:\n", "  hole: {type: pinhole_25, marker: 2, home: storage/a1}\n  lens:\n")
    page = (ROOT / "docs" / "how-to" / "component-type.md").read_text().split("```yaml\n")[1].split("```")[0]
    (lab / "pinhole_25.yaml").write_text(page)
    assert pico("validate").code == 0
    (lab / "pinhole_25.yaml").write_text(change(page))
    answer = pico("validate")
    said = " ".join(answer.err.split())
    assert answer.code == 1 and "error[grip]: pinhole_25 can't be gripped" in said and told in said
    line = 1 + change(page).splitlines().index(next(x for x in change(page).splitlines() if x.startswith("  grasp:")))
    assert f"--> pinhole_25.yaml:{line}:" in said


def test_a_slot_that_no_arm_reaches_is_told(tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    lab = tmp_path / "lab"
    shutil.copytree(labs_dir() / "minimal", lab)
    monkeypatch.chdir(lab)
    edit(lab / "lab.yaml", "slots:\n", "slots:\n  storage/z9: {x: 1150, y: 50}\n")
    answer = pico("validate")
    assert answer.code == 0 and "warning[slot-reach]: no arm reaches storage/z9" in " ".join(answer.err.split())
    assert answer.err.count("slot-reach") == 1
    stands, table = "x: 660\n      y: 420", lab / "state" / "table.yaml"
    for place in ("x: 1100\n      y: 100", "x: 500\n      y: 720"):  # too far, and at the foot of the arm
        edit(table, stands, place)
        assert "warning[reach]: no arm reaches lens" in " ".join(pico("validate").err.split())
        stands = place


def test_a_labs_own_type_is_shown_before_any_part_uses_it(tmp_path: Path, pico: Pico) -> None:
    lab = tmp_path / "lab"
    shutil.copytree(labs_dir() / "minimal", lab)
    page = (ROOT / "docs" / "how-to" / "component-type.md").read_text().split("```yaml\n")[1].split("```")[0]
    (lab / "pinhole_25.yaml").write_text(page)
    assert "Pinhole 25 um on a post" in pico("-C", str(lab), "catalog", "show", "pinhole_25").out
    assert "pinhole_25" in pico("-C", str(lab), "catalog", "list").out
