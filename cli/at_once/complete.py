"""What Tab offers: what the files of commands and labs say, read as text, for completion must not wait for a parser."""

from __future__ import annotations

import re
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..commands import files

if TYPE_CHECKING:
    from .declared import Declared

SHARED = {
    "-C": "DIR",
    "--json": "",
    "--debug": "",
    "--backend": "sim|hardware",
    "--emulate": "",
    "--bench": "LAB/BENCH",
    "--help": "",
}
_SAFE = re.compile(r"[^\s\\'\"`$&|;<>()*?!#{}\[\]\x00-\x1f\x7f-\x9f]+")
"""What a shell takes as it stands: bash puts what is offered into the command line as it is."""
_LARGEST = 2 * 1024 * 1024
_NAME = re.compile(r"  ([a-z][a-z0-9_]*):\s*(?:\{.*)?(?:#.*)?")


def candidates(words: Sequence[str]) -> list[str]:
    """Return what the last of `words` (those after `pico`; it may be empty) can become."""
    *before, last = words or [""]
    folder = Path(before[before.index("-C") + 1]) if "-C" in before[:-1] else Path()
    return sorted({c for c in _offered(before, last, folder) if c.startswith(last) and _SAFE.fullmatch(c)})


def _offered(before: Sequence[str], last: str, folder: Path) -> Iterable[str]:
    options = {**SHARED, "--lock-timeout": "SECONDS"}
    command, *below = [*plain(before, options), ""]
    taken = _taken(command)
    own, metavars = taken.get("") or taken.get(below[0] if below else "") or ({}, [])
    options |= own
    given = plain(before, options)[1 if "" in taken else 2 :]
    metavars = [*metavars, *(m for m in metavars[-1:] for _ in given if m.endswith("..."))]
    if before and options.get(before[-1]):
        return _meant(options[before[-1]], folder)
    if "--" in before:
        return _inventory(folder)
    if last.startswith("-"):
        return (*own, *SHARED, *(() if command else ("--version",)))
    if "" not in taken and not (below and below[0]):
        return taken if command else files()
    return (c for metavar in metavars[len(given) :][:1] for c in _meant(metavar, folder))


def _taken(command: str) -> dict[str, Declared]:
    """Return what a command takes, nothing for what is none; see `declared`."""
    if command not in files():
        return {}
    from .declared import declared

    return declared(files()[command])


def plain(before: Sequence[str], options: Mapping[str, str]) -> list[str]:
    """Return the words that are neither options nor their values."""
    return [w for i, w in enumerate(before) if not w.startswith("-") and not (i and options.get(before[i - 1]))]


def _meant(metavar: str, folder: Path) -> Iterator[str]:
    """Yield what a metavar stands for: each of `a|b|FILE` that is written in small letters, or what its words mean."""
    yield from (word for word in metavar.strip("[].").split("|") if word.islower())
    for word in set(re.findall("[A-Z]+", metavar)) & _MEANING.keys():
        yield from _MEANING[word](folder)


def _revisions(folder: Path) -> Sequence[str]:
    import subprocess

    command = ["git", "-C", str(folder), "for-each-ref", "--format=%(refname:short)", "refs/heads", "refs/tags"]
    try:
        return subprocess.run(
            command, capture_output=True, text=True, check=False, timeout=1, encoding="utf-8", errors="replace"
        ).stdout.split()
    except (OSError, subprocess.SubprocessError):
        return ()


def _inventory(folder: Path) -> Iterator[str]:
    """Yield the keys under `inventory:` of the lab's files, as their indentation shows them."""
    here = folder.resolve()
    root = next((p for p in (here, *here.parents) if (p / "lab.yaml").is_file()), here)
    for path in root.glob("*.yaml"):
        if not _readable(path):
            continue
        inside = False
        for line in path.read_text(errors="replace", encoding="utf-8").splitlines():
            if line[:1] not in (" ", "#", ""):
                inside = line.startswith("inventory:")
            elif inside and (match := _NAME.fullmatch(line)):
                yield match[1]


def _readable(path: Path) -> bool:
    """Return whether a file is one that PICO reads: no link, no pipe that would never end, not too large."""
    try:
        found = path.lstat()
    except OSError:
        return False
    return stat.S_ISREG(found.st_mode) and found.st_size <= _LARGEST


_MEANING: dict[str, Callable[[Path], Iterable[str]]] = {
    **dict.fromkeys(("REV", "BAD", "GOOD"), _revisions),
    **dict.fromkeys(("COMPONENT", "PART", "OTHER"), _inventory),
    "PLANFILE": lambda folder: (p.name for p in folder.glob("*.plan")),
    "PRIMITIVE": lambda _: ("move", "stow", "set", "home"),
}
"""What the words of metavars stand for."""

SCRIPTS = {
    "bash": """_pico() {
  local IFS=$'\\n'
  COMPREPLY=( $(_PICO_COMPLETE=1 pico "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null) )
}
complete -o default -F _pico pico""",
    "zsh": """#compdef pico
_pico() {
  local -a found
  found=("${(@f)$(_PICO_COMPLETE=1 pico "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  [[ -n "$found" ]] && compadd -- $found || _files
}
compdef _pico pico""",
    "fish": """function __pico
  _PICO_COMPLETE=1 pico (commandline -opc)[2..-1] (commandline -ct | string collect --allow-empty) 2>/dev/null
end
complete -c pico -a '(__pico)'""",
}
HOW = {
    "bash": "echo 'eval \"$(pico completion bash)\"' >> ~/.bashrc",
    "zsh": "echo 'eval \"$(pico completion zsh)\"' >> ~/.zshrc   # after compinit",
    "fish": "pico completion fish > ~/.config/fish/completions/pico.fish",
}
