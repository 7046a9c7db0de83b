"""Which commits are meant: `e1`, `A..B`, `A...B`, `^A`, as git reads them, with an answer to what can't be meant."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from pico.diagnostics import PicoError, error
from pico.history.git.shallow import cut_off
from pico.history.repository.repository import Repository

_SIGN = re.compile(r"\.{2,}")
_OF_GIT = re.compile(r"(.+)(\^!|\^@|\^-\d*)")


@dataclass(frozen=True, slots=True)
class Range:
    """`A..B`: what B has and A has not; `A...B`: what one of them has and the other has not. Empty stands for HEAD."""

    a: str
    sign: Literal["..", "..."]
    b: str


def read_range(word: str) -> Range | None:
    """Return the range that a word is, None for a single revision; raises PicoError for what is neither."""
    # `HEAD@{2..weeks}` is nobody's range: dots inside braces belong to a date or a message.
    signs = list(_SIGN.finditer(re.sub(r"\{[^}]*\}", lambda m: "_" * len(m[0]), word)))
    if not signs:
        return None
    if len(signs) > 1 or len(signs[0][0]) > 3 or word.startswith("^"):
        hint = "`A..B`: from A to B; `A...B`: from where they parted"
        raise PicoError(error("range", f"`{word}` is no range of commits", hint=hint))
    start, end = signs[0].span()
    return Range(word[:start], "..." if end - start == 3 else "..", word[end:])


def for_rev_list(repository: Repository, words: tuple[str, ...]) -> list[str]:
    """Return the commits and ranges that words name as `git rev-list` takes them; HEAD for none.

    Raises PicoError for what there is not, naming it.
    """
    found: list[str] = []
    for word in words:
        span = read_range(word)
        if span:
            a, b = (repository.resolve(name or "HEAD").id for name in (span.a, span.b))
            found.append(f"{a}{span.sign}{b}")
        elif match := _OF_GIT.fullmatch(word):
            found.append(repository.resolve(match[1]).id + match[2])
        else:
            sign, name = ("^", word[1:]) if word.startswith("^") else ("", word)
            found.append(sign + repository.resolve(name).id)
    return found if any(not name.startswith("^") for name in found) else [*found, "HEAD"]


def ends_of(repository: Repository, a: str | None, b: str | None) -> tuple[str | None, str | None]:
    """Return the two revisions that a diff is of: (HEAD for None, the working tree for None).

    `a` may be a range; `A...B` begins where A and B parted. Raises PicoError.
    """
    span = read_range(a) if a else None
    if b and (span or read_range(b)):
        raise PicoError(error("range", "a range stands alone", hint=f"`pico diff {a if span else b}`"))
    if span is None:
        return a, b
    first, last = span.a or "HEAD", span.b or "HEAD"
    return (merge_base(repository, first, last), last) if span.sign == "..." else (first, last)


def merge_base(repository: Repository, a: str, b: str) -> str:
    """Return the commit in which two revisions parted; raises PicoError where they have no history in common."""
    found = repository.handle.merge_base(repository.resolve(a).id, repository.resolve(b).id)
    if found is None:
        if repository.handle.is_shallow:
            raise PicoError(
                cut_off(repository.handle, f"does not reach back to a commit that {a} and {b} have in common")
            )
        raise PicoError(error("range", f"{a} and {b} have no commit in common", hint=f"`pico diff {a} {b}`"))
    return str(found)
