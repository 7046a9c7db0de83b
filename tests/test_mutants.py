"""The tests bite: mutants are made as they should be, and what was made by hand is killed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "benchmarks"))

from mutants_by_hand import BY_HAND  # noqa: E402
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
        assert len(list((ROOT / "tests").rglob(one.tests))) == 1, one.tests


@pytest.mark.slow
def test_those_made_by_hand_are_killed() -> None:
    command = [sys.executable, str(ROOT / "benchmarks" / "mutants.py"), "--by-hand"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("killed") == len(BY_HAND) and "survived" not in done.stdout
