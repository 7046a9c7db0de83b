"""`pico blame` on the example laboratory, whose history is known, and on commits that carry runs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico, edit


def lines(out: str) -> dict[str, list[str]]:
    """Return the words of each line by its first."""
    return {words[0]: words[1:] for line in out.splitlines() if (words := line.split()) and "." in words[0]}


def test_the_example_is_blamed_as_its_history_was_written(shel: Path, pico: Pico) -> None:
    answer = pico("blame", "--at", "e3")
    assert answer.code == 0
    assert answer.err == ""
    found = {leaf["component"] + "." + leaf["tunable"]: leaf["last"]["name"] for leaf in tagged(pico, "e3")}
    assert found == dict.fromkeys(lines(answer.out), "C1") | {
        "p1.pose": "C2", "p2.pose": "E3-2", "p1.angle": "E3-2", "lx_100.pose": "E2-1", "ly_200.pose": "E3-1",
    }  # fmt: skip
    assert lines(answer.out)["p1.angle"][:2] == ["1", "deg"]
    assert "tilt of p2" in answer.out
    assert "19 tunables of 9 components at e3." in answer.out
    assert all(len(line) <= 100 for line in answer.out.splitlines())


def tagged(pico: Pico, revision: str) -> Any:
    answer = pico("blame", "--json", "--at", revision)
    assert answer.data["schema"] == "pico.blame/v1"
    return answer.data["leaves"]


def test_the_history_of_one_leaf_is_newest_first_with_before_and_after(shel: Path, pico: Pico) -> None:
    out = pico("blame", "p2.pose", "--at", "e3", "--history").out.splitlines()
    assert out[0] == "p2.pose (520, 420, 30°)"
    assert [line.split("  ")[1] for line in out[1:4]] == ["turned +30°", "placed at (520, 420, 0°)", "in storage/b2"]
    turns = pico("blame", "p2.pose", "--at", "e3", "--all", "--json").data["leaves"][0]["history"]
    assert [t["name"] for t in turns] == ["E3-2", "C3", "C1"]
    assert turns[0]["before"] == turns[1]["after"] == {"x": 520, "y": 420, "yaw": 0}


def test_a_run_a_hand_a_plan_and_an_edit_are_told_apart(shel: Path, pico: Pico) -> None:
    edit(shel / "state" / "table.yaml", "slot: storage/a1", "pose: {x: 420, y: 420, yaw: 0}")
    assert pico("apply", "--auto-approve").code == 0
    assert pico("sim", "nudge", "p2", "--dx", "5").code == 0
    assert pico("commit", "-m", "lens in, p2 pushed", "--capture").code == 0
    edit(shel / "state" / "table.yaml", "x: 290", "x: 290.01")
    assert pico("commit", "-m", "p1 as the drawing has it").code == 0
    edit(shel / "state" / "table.yaml", "angle: 22.75", "angle: 30")
    assert pico("commit", "-m", "for tomorrow", "--planned").code == 0
    edit(shel / "state" / "table.yaml", "exposure: 10", "exposure: 20 ms")
    answer = pico("blame", "--json")
    how = {f"{leaf['component']}.{leaf['tunable']}": leaf["last"]["how"] for leaf in answer.data["leaves"]}
    assert (how["lx_100.pose"]["kind"], how["lx_100.pose"]["cause"]) == ("run", "apply")
    assert how["lx_100.pose"]["evidence"] == "kinematic"
    kinds = {name: said["kind"] for name, said in how.items()}
    assert [kinds[n] for n in ("p2.pose", "hwp.angle", "cam.exposure", "p1.pose", "p1.angle")] == [
        "hand", "planned", "edit", "edited", "commit",
    ]  # fmt: skip
    out = pico("blame").out
    assert "by hand" in " ".join(lines(out)["p2.pose"])
    assert "edited, planned" in " ".join(lines(out)["hwp.angle"])
    assert lines(out)["cam.exposure"] == ["20", "ms", "not", "committed"]
    assert "with edits that are not committed" in out
    run = how["lx_100.pose"]["run"]
    assert f"apply {run[-6:]}" in pico("blame", "lx_100").out
    assert f"`pico runs show {run}`" in pico("blame", "lx_100").out


def test_notes_on_a_part_stand_below(shel: Path, pico: Pico) -> None:
    (shel / "notes").mkdir()
    (shel / "notes" / "p2.md").write_text("- 2026-11-21 A Physicist: scratched at the rim\n")
    assert "p2: scratched at the rim  (A Physicist, 2026-11-21)" in pico("blame", "p2").out
    assert "scratched" not in pico("blame", "p1").out
    assert "scratched" not in pico("blame", "p2", "--at", "HEAD").out
    assert pico("blame", "p2", "--json").data["notes"]["p2"][0]["text"] == "scratched at the rim"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["ly_15"], "did you mean `ly_150`?"), (["p1.angel"], "did you mean `angle`?"),
        (["--at", "e9"], "no revision `e9`"), (["p1.angle", "p3"], "known: `cam`"), (["-C", "/"], "no lab"),
    ],
)  # fmt: skip
def test_mistakes_are_told(shel: Path, pico: Pico, words: list[str], said: str) -> None:
    answer = pico("blame", *words)
    assert answer.code == 1
    assert said in answer.err
    assert pico("blame", *words, "--json").data["diagnostics"]


def test_a_manifest_that_can_not_be_read_is_no_obstacle(shel: Path, pico: Pico) -> None:
    before = pico("blame").out
    edit(shel / "state" / "table.yaml", "  cam:", "<<<<<<< ours\n  cam:")
    answer = pico("blame")
    assert (answer.code, answer.out) == (0, before)
    assert "state/table.yaml can't be read at the working tree" in answer.err


def test_it_loads_neither_numbers_nor_physics(shel: Path) -> None:
    heavy = ("numpy", "mujoco", "cv2", "scipy", "networkx", "pint", "ruamel", "rich", "asyncio")
    code = "import sys; from pico_cli.main import main; main(['blame']); "
    code += "print([m for m in sys.argv[1].split(',') if m in sys.modules], file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code, ",".join(heavy)], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"
