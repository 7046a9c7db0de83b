"""The tests bite: mutants are made as they should be, and what was made by hand is killed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "benchmarks"))

from mutants_by_hand import BY_HAND, SAFETY_BY_HAND  # noqa: E402
from mutants_safety import SAFETY, accepted, belongs, chosen, key_of  # noqa: E402
from mutating import is_python, mutants, planted  # noqa: E402

MODULE = '''\
"""A module: 1 < 2."""

LEAST: int = 3


def nearest(a: float, b: float = 2.0) -> float:
    """Return a, or 2 where not b."""
    if a <= b and not b:
        raise ValueError(f"{a + 1} is nothing")
    return far(a, b) - LEAST
'''


def test_a_mutant_is_one_change_of_what_the_program_does() -> None:
    found = {(m.line, m.right, m.wrong, m.function, m.name) for m in mutants("m.py", MODULE)}
    assert found == {
        (3, "3", "4", "", "LEAST"),
        (6, "2.0", "4.0", "", "nearest"),
        (8, " and ", " or ", "nearest", ""),
        (8, " <= ", " < ", "nearest", ""),
        (8, " <= ", " > ", "nearest", ""),
        (8, "not b", "(b)", "nearest", ""),
        (8, "a <= b and not b", "True", "nearest", ""),
        (8, "a <= b and not b", "False", "nearest", ""),
        (9, 'raise ValueError(f"{a + 1} is nothing")', "pass", "nearest", ""),
        (10, "far(a, b) - LEAST", "None", "nearest", ""),
        (10, " - ", " + ", "nearest", ""),
        (10, "a, b", "b, a", "nearest", ""),
    }
    for mutant in mutants("m.py", MODULE):
        text = mutant.apply(MODULE)
        assert is_python(text) and text != MODULE
        assert text.replace(mutant.wrong, mutant.right, 1) == MODULE or mutant.wrong in MODULE


def test_what_was_made_by_hand_has_its_place() -> None:
    texts = {file: file.read_text() for file in (ROOT / "pico").rglob("*.py")}
    for one in BY_HAND:
        (file,) = [file for file, text in texts.items() if one.right in text]
        mutant = planted(str(file), texts[file], one.right, one.wrong)
        assert texts[file].count(one.right) == 1 and is_python(mutant.apply(texts[file])), one.means
        name, _, test = one.tests.partition("::")
        (tests,) = (ROOT / "tests").rglob(name)
        assert not test or f"\ndef {test}(" in tests.read_text(), one.tests
        if one in SAFETY_BY_HAND:
            package = Path(one.file).parts[1]
            assert file == ROOT / one.file and one.danger and test and tests.is_relative_to(ROOT / "tests" / package)


def test_the_safety_group_has_its_modules_tests_and_functions() -> None:
    for file, module in SAFETY.items():
        assert all((ROOT / folder).is_dir() for folder in (*module.own, *module.others)), file
        functions = {m.function for m in mutants(file, (ROOT / file).read_text()) if belongs(m)}
        assert functions and functions >= set(module.functions), file
    assert chosen(["guard/rates", "policy/dose"]) == ["pico/policy/dose.py", "pico/server/guard/rates.py"]
    assert chosen([]) == list(SAFETY)
    with pytest.raises(SystemExit, match="no module of the safety group contains `nothing`"):
        chosen(["nothing"])


def test_each_accepted_mutant_can_still_be_planted_and_says_why_it_is_accepted() -> None:
    """An entry whose line was edited goes, or is written anew: `mutants.py --safety` shows what it hides."""
    for file in {one.module for one in accepted().values()}:
        text = (ROOT / file).read_text()
        there = {key_of(m, text) for m in mutants(file, text) if belongs(m)}
        gone = [key for key in accepted() if key[0] == file and key not in there]
        assert not gone, gone
    assert all(len(one.reason) > 20 for one in accepted().values())


@pytest.mark.slow
def test_the_safety_group_is_judged_by_the_quick_tests_of_its_own_packages() -> None:
    words = ["--safety", "--own", "--module", "guard/rates", "teleop/deadman"]
    done = subprocess.run(
        [sys.executable, str(ROOT / "benchmarks" / "mutants.py"), *words], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "pico/server/guard/rates.py" in done.stdout and "CPU seconds in all" in done.stdout


@pytest.mark.slow
def test_those_made_by_hand_are_killed() -> None:
    command = [sys.executable, str(ROOT / "benchmarks" / "mutants.py"), "--by-hand"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("killed") == len(BY_HAND) and "survived" not in done.stdout
