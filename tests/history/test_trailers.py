"""Trailers: one block at the end of a message, as git reads it; what was copied from another commit gives way."""

from __future__ import annotations

import subprocess

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from pico.diagnostics import PicoError
from pico.history.messages.trailers import meta, require_meta, trailers, values, with_trailers, without_trailers

OURS = [("Pico-State", "sha256:1"), ("Pico-Evidence", "physics")]


def of_git(message: str) -> list[str]:
    """Return the trailers that git reads, continued ones on one line."""
    done = subprocess.run(
        ["git", "interpret-trailers", "--parse", "--no-divider"],
        input=message.encode(), capture_output=True, check=True,
    )  # fmt: skip
    return done.stdout.decode().splitlines()


def test_they_stand_in_one_block_at_the_end() -> None:
    assert with_trailers("why", OURS) == "why\n\nPico-State: sha256:1\nPico-Evidence: physics\n"
    said = "why\n\nbecause: of that, and more\nof it\n\nSigned-off-by: A <a@b>\nReviewed-by: B"
    assert with_trailers(said, OURS) == f"{said}\nPico-State: sha256:1\nPico-Evidence: physics\n"


def test_a_subject_that_looks_like_one_is_none() -> None:
    assert with_trailers("fix: the lens", OURS[:1]) == "fix: the lens\n\nPico-State: sha256:1\n"
    assert trailers("fix: the lens") == ()


def test_what_was_copied_from_another_commit_gives_way() -> None:
    copied = "why\n\nPico-State: sha256:old\n  goes on\nPico-Meta: t=1\nPico-Run: r0\nSigned-off-by: A <a@b>"
    made = with_trailers(copied, [*OURS, ("Pico-Run", "r1"), ("Pico-Run", "r2"), ("Pico-Meta", "t=1")])
    assert made.splitlines()[2:] == [
        "Pico-Meta: t=1", "Signed-off-by: A <a@b>", "Pico-State: sha256:1", "Pico-Evidence: physics", "Pico-Run: r1",
        "Pico-Run: r2",
    ]  # fmt: skip
    assert values(made, "pico-run") == ("r1", "r2")
    assert without_trailers(made) == "why\n\nSigned-off-by: A <a@b>"


def test_meta_is_read_back_and_nonsense_is_refused() -> None:
    given_ = {"temperature": "21.3 degC", "a.b-c_1": "x=y"}
    require_meta(given_)
    assert meta(with_trailers("why", [("Pico-Meta", f"{k}={v}") for k, v in given_.items()])) == given_
    with pytest.raises(PicoError) as caught:
        require_meta({"T": "1", "ok": "two\nlines", "1a": "x", "empty": " "})
    assert len(caught.value.diagnostics) == 4


LINE = st.sampled_from(
    [
        "", "words", "two words: three", "Key: value", "Other-Key : value", "  goes on", "Signed-off-by: A <a@b>",
        "(cherry picked from commit 0123)", "no-colon", "http://a.b/c", "-: x", "K:",
    ]
)  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(st.lists(LINE, max_size=7))
@example(["", "Key: value", "(cherry picked from commit 0123)", "  goes on"])
def test_git_reads_what_is_written_and_the_users_words_stay(lines: list[str]) -> None:
    message = "subject\n" + "\n".join(lines)
    made = with_trailers(message, OURS)
    assert of_git(made) == [f"{key}: {value}" for key, value in trailers(made)]
    assert of_git(made)[-2:] == [f"{key}: {value}" for key, value in OURS]
    ours = [f"{key}: {value}" for key, value in OURS]
    assert [x for x in made.splitlines() if x and x not in ours] == [x for x in message.splitlines() if x]
