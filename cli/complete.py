"""What Tab offers: from tables and straight from the files, for completion must not wait for a parser."""

from __future__ import annotations

import re
import stat
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path

from .summary import COMMANDS, MOVERS

SHARED = ("-C", "--json", "--debug", "--backend", "--help")
VALUES = (
    "--meta",
    "--at", "-C", "--backend", "--lock-timeout", "--out", "--fidelity", "--view", "--format", "--speed", "--example",
    "--expect", "--measure-seconds", "--suspicion", "-m", "--message", "--mainline", "--interval", "--looks", "--grace",
    "--run", "--pictures",
    "--component", "--merge", "--report", "--junit", "--pictures",
    "--since", "--until", "--author", "--grep",
    "-n", "--number", "--explain", "--target", "--record", "--size", "--paper", "--done", "--not-done",
    "--exclude", "--prefer", "--picture", "--types", "--after", "--distance", "--dx", "--dy", "--dz", "--dyaw",
)  # fmt: skip
_CHOICE = ("--target", "--exclude", "--prefer")
_APPLY = ("--auto-approve", "--exact", "--fidelity", *_CHOICE)
_ONE = ("--dry-run", "--fidelity")
OPTIONS: dict[str, tuple[str, ...]] = {
    "init": ("--example",),
    "status": ("--all",),
    "plan": ("--out", "--detailed-exitcode", "--exact", "--fidelity", "--explain", "--picture", *_CHOICE),
    "apply": (*_APPLY, "--record", "--refresh", "--stop-on-error"),
    "stop": ("--now",),
    "resume": ("--auto-approve", "--fidelity", "--stop-on-error"),
    "undo": ("--auto-approve", "--fidelity"),
    "recover": ("--done", "--not-done", "--auto-approve", "--fidelity"),
    "checkout": ("--auto-approve", "--files-only", "--fidelity"),
    "explain": ("--fidelity",),
    "graph": ("--format", "--out", "--fidelity"),
    "fmt": ("--check",),
    "parts": ("--free",),
    "capture": ("--dry-run",),
    "commit": ("-m", "--message", "-e", "--edit", "--capture", "--planned", "--meta"),
    "log": (
        "--graph",
        "--oneline",
        "--all",
        "-n",
        "--number",
        "--since",
        "--until",
        "--author",
        "--grep",
        "--first-parent",
        "--merges",
        "--no-merges",
    ),
    "drift": ("--detailed-exitcode",),
    "runs list": ("--all", "--component"),
    "blame": ("--at", "--history", "--all"),
    "watch": ("--interval", "--looks", "--heal"),
    "do": ("--speed", *_ONE),
    "move": ("--speed", *_ONE),
    "rotate": ("--speed", *_ONE),
    "place": ("--after", "--distance", "--speed", *_ONE),
    "stow": ("--speed", *_ONE),
    "set": _ONE,
    "home": _ONE,
    "diff": ("--picture", "--stat", "--exit-code"),
    "push": ("--no-data",),
    "publish": ("--out", "--run", "--pictures"),
    "merge": ("-m", "--message"),
    "check": ("--merge", "--report", "--markdown", "--junit", "--pictures", "--fidelity"),
    "revert": ("-m", "--message", "--mainline", "--no-commit"),
    "cherry-pick": ("--mainline", "--no-commit"),
    "stash": ("-m", "--message"),
    "render": ("--out", "--view", "--manifest", "--plan", "--size"),
    "ruler": ("--picture",),
    "scan": ("--picture",),
    "find": ("--picture",),
    "import": ("--types", "--dry-run"),
    "bisect start": ("--expect", "--measure-seconds", "--trust", "--suspicion", "--auto-approve", "--fidelity"),
    "bisect run": ("--expect", "--measure-seconds", "--trust", "--suspicion", "--auto-approve", "--fidelity"),
    "bisect continue": ("--expect", "--auto-approve", "--fidelity"),
    "bisect good": ("--auto-approve", "--fidelity"),
    "bisect bad": ("--auto-approve", "--fidelity"),
    "bisect skip": ("--auto-approve", "--fidelity"),
    "bisect-step": ("--expect", "--fidelity"),
    "calibrate": (),
    "markers": ("--out", "--paper"),
    "data gc": ("--grace", "--dry-run", "--auto-approve"),
    "sim reset": (),
    "sim bump": ("--dx", "--dy", "--dz", "--dyaw"),
    "sim nudge": ("--dx", "--dy", "--dyaw"),
    "sim remove": (),
    "sim person": (),
    "sim view": (),
    "sim power-cycle": (),
    "sim faults": (),
}
OPTIONS |= {name: (*OPTIONS.get(name, ()), "--lock-timeout") for name in MOVERS}
GROUPS = {
    "bisect": ("start", "run", "continue", "good", "bad", "skip", "status", "log", "reset"),
    "sim": ("reset", "person", "nudge", "bump", "remove", "view", "power-cycle", "faults"),
    "catalog": ("list", "show"),
    "git": ("install", "uninstall", "attach"),
    "runs": ("list", "show", "compare"),
    "data": ("status", "push", "pull", "fsck", "gc", "pointers"),
}
FIXED = {
    "--backend": ("sim", "hardware"),
    "--fidelity": ("kinematic", "physics"),
    "--view": ("perspective", "top"),
    "--prefer": ("fewest-moves", "shortest-time"),
    "--format": ("dot", "mermaid"),
    "--pictures": ("all", "none"),
    "--paper": ("a4", "letter"),
    "--example": ("minimal", "shel", "crowded", "two_arms"),
}
COMPONENTS = ("--component", "--after", "--explain", "--target", "--exclude")
_COMPONENT = (
    "ruler", "find", "do", "move", "rotate", "place", "stow", "set", "get", "home", "note", "sim nudge", "sim remove",
)  # fmt: skip
_REVISION = (
    "plan", "apply", "checkout", "explain", "graph", "log", "diff", "merge", "revert", "cherry-pick", "show", "render",
    "verify", "publish", "runs list", "bisect start", "bisect run", "bisect good", "bisect bad", "bisect skip",
)  # fmt: skip
_SAFE = re.compile(r"[^\s\\'\"`$&|;<>()*?!#{}\[\]\x00-\x1f\x7f-\x9f]+")
"""What a shell takes as it stands: bash puts what is offered into the command line as it is."""
_LARGEST = 2 * 1024 * 1024
_NAME = re.compile(r"  ([a-z][a-z0-9_]*):\s*(?:\{.*)?(?:#.*)?")


def candidates(words: Sequence[str]) -> list[str]:
    """Return what the last of `words` (those after `pico`; it may be empty) can become."""
    *before, last = words or [""]
    folder = Path(before[before.index("-C") + 1]) if "-C" in before[:-1] else Path()
    return sorted({c for c in _offered(before, last, folder) if c.startswith(last) and _SAFE.fullmatch(c)})


def _offered(before: Sequence[str], last: str, folder: Path) -> Sequence[str]:
    if before and before[-1] in VALUES:
        return list(_inventory(folder)) if before[-1] in COMPONENTS else FIXED.get(before[-1], ())
    plain = [w for i, w in enumerate(before) if not w.startswith("-") and (i == 0 or before[i - 1] not in VALUES)]
    if not plain:
        return (*SHARED, "--version") if last.startswith("-") else tuple(COMMANDS)
    command, *given = plain
    if command in GROUPS:
        if not given:
            return GROUPS[command]
        command, given = f"{command} {given[0]}", given[1:]
    if "--" in before:
        return list(_inventory(folder))
    if last.startswith("-"):
        return (*OPTIONS.get(command, ()), *SHARED)
    return list(_arguments(command, given, folder))


def _arguments(command: str, given: Sequence[str], folder: Path) -> Iterator[str]:
    if (command in _COMPONENT and not given) or command in ("blame", "capture", "commit"):
        yield from _inventory(folder)
    elif command == "do" and len(given) == 1:
        yield from ("move", "stow", "set", "home")
    elif command in _REVISION and len(given) < (2 if command in ("diff", "bisect start", "bisect run") else 1):
        yield from _revisions(folder)
        if command in ("apply", "explain", "graph", "show"):
            yield from (p.name for p in folder.glob("*.plan"))
    elif command == "explain" and len(given) == 1:
        yield from _inventory(folder)
    elif command == "stash" and not given:
        yield from ("push", "pop", "list", "drop")
    elif command == "completion":
        yield from ("bash", "zsh", "fish")


def _revisions(folder: Path) -> Sequence[str]:
    command = ["git", "-C", str(folder), "for-each-ref", "--format=%(refname:short)", "refs/heads", "refs/tags"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=1).stdout.split()
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
        for line in path.read_text(errors="replace").splitlines():
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
