"""What a merge would leave of a lab, without writing anything."""

from __future__ import annotations

from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.history.git.shallow import cut_off
from pico.history.git.unread import read_tree
from pico.history.merge.commits import label_of, refusals
from pico.history.merge.markers import Labels
from pico.history.merge.trees import Union, opened, unite_commits
from pico.history.repository.repository import Repository


def merged_files(repository: Repository, folder: Path, revision: str) -> dict[str, bytes]:
    """Return the manifests of the lab in `folder`, by path in it, as a merge of `revision` into HEAD would leave them.

    Raises PicoError where both sides changed a value, or have no commit in common.
    """
    ours, theirs = repository.resolve("HEAD"), repository.resolve(revision)
    handle = opened(repository.root)
    base = handle.merge_base(ours.id, theirs.id)
    if base is None and handle.is_shallow:
        raise PicoError(cut_off(handle, f"does not reach back to a commit that {revision} and HEAD have in common"))
    if base is None:
        raise PicoError(error("unrelated", f"{revision} and HEAD have no commit in common"))
    if str(base) in (ours.id, theirs.id):
        ahead = theirs.id if str(base) == ours.id else ours.id
        return repository.files(ahead, folder)
    labels = Labels(label_of(ours), str(base)[:7], label_of(theirs, revision))
    union: Union = unite_commits(handle, ours.id, theirs.id, labels)
    if union.conflicts or union.files:
        raise PicoError(refusals(union, labels, revision, (ours, theirs)))
    return read_tree(repository, handle[union.tree], repository.relative(folder), f"{labels.ours}+{labels.theirs}")
