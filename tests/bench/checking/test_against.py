"""What a change is compared with."""

from __future__ import annotations

from pathlib import Path

import pytest
from changing import Lab

from pico.diagnostics import PicoError
from pico.history.repository.comparison_base import comparison_base
from pico.history.repository.repository import Repository


def base(lab: Lab, revision: str | None = None, *, edited: bool = False, **environment: str) -> tuple[str | None, str]:
    repository = Repository.discover(lab.root)
    assert repository is not None
    found = comparison_base(repository, revision, environment, edited=edited)
    return found.commit, found.name


def test_a_branch_is_compared_with_where_it_left_the_default_branch(lab: Lab) -> None:
    main = lab.git("rev-parse", "main")
    lab.edit("x: 290", "x: 300")
    lab.commit()
    assert base(lab) == (main, "main")
    lab.git("checkout", "-q", "main")
    lab.edit("x: 520", "x: 530")
    ahead = lab.commit()
    lab.git("checkout", "-q", "change")
    assert base(lab) == (main, "where it left main")
    assert base(lab, "main") == base(lab)
    assert base(lab, ahead) == (main, f"where it left {ahead}")


def test_the_default_branch_is_compared_with_the_commit_before_or_with_head_where_it_was_edited(lab: Lab) -> None:
    lab.git("checkout", "-q", "main")
    assert base(lab) == (lab.git("rev-parse", "HEAD^"), "the commit before")
    assert base(lab, edited=True) == (lab.git("rev-parse", "HEAD"), "main")


def test_the_first_commit_and_no_commit_are_compared_with_nothing(lab: Lab, tmp_path: Path) -> None:
    lab.git("checkout", "-q", "--orphan", "fresh")
    lab.git("branch", "-D", "main")
    assert base(lab) == (None, "nothing: no commit yet")
    lab.commit()
    assert base(lab) == (None, "nothing: the first commit")


@pytest.mark.parametrize(
    ("environment", "name"),
    [
        ({"GITHUB_BASE_REF": "develop"}, "develop"),
        ({"GITHUB_BASE_REF": ""}, "main"),
        ({"CI_MERGE_REQUEST_TARGET_BRANCH_NAME": "develop"}, "develop"),
        ({"CI_DEFAULT_BRANCH": "develop"}, "main"),
    ],
)
def test_continuous_integration_says_what_is_merged_into(lab: Lab, environment: dict[str, str], name: str) -> None:
    lab.git("branch", "develop", "main~1")
    lab.edit("x: 290", "x: 300")
    lab.commit()
    assert base(lab, **environment) == (lab.git("rev-parse", name), name)


def test_the_branches_of_origin_come_first_and_its_head_names_the_default(lab: Lab) -> None:
    lab.git("clone", "-q", ".", "../clone")
    clone = Lab(lab.root.parent / "clone")
    clone.git("remote", "set-head", "origin", "e1")
    clone.git("checkout", "-q", "-B", "change", "origin/main")
    clone.edit("x: 290", "x: 300")
    clone.commit()
    assert base(clone)[1] == "where it left origin/e1"
    assert base(clone, GITHUB_BASE_REF="main") == (lab.git("rev-parse", "main"), "origin/main")


def test_where_gitlab_fetched_no_branch_its_commits_count(lab: Lab) -> None:
    began, target = lab.git("rev-parse", "main~2"), lab.git("rev-parse", "main~1")
    told = {"CI_MERGE_REQUEST_TARGET_BRANCH_NAME": "elsewhere", "CI_MERGE_REQUEST_DIFF_BASE_SHA": began}
    assert base(lab, **told) == (began, "elsewhere")
    assert base(lab, **told, CI_MERGE_REQUEST_TARGET_BRANCH_SHA=target) == (target, "elsewhere")


@pytest.mark.parametrize("environment", [{}, {"GITHUB_BASE_REF": "main"}])
def test_a_clone_that_does_not_reach_back_is_refused_and_not_taken_for_new(
    lab: Lab, environment: dict[str, str]
) -> None:
    lab.edit("x: 290", "x: 300")
    lab.commit()
    lab.git("clone", "-q", "--depth", "1", "-b", "change", lab.root.as_uri(), "../shallow")
    with pytest.raises(PicoError) as caught:
        base(Lab(lab.root.parent / "shallow"), **environment)
    assert "fetch-depth: 0" in caught.value.diagnostics[0].hint


def test_a_revision_that_there_is_not_is_named(lab: Lab) -> None:
    with pytest.raises(PicoError, match="nowhere"):
        base(lab, "nowhere")
