"""How git comes to call PICO: `.gitattributes`, which travels with the repository, and local configuration.

A repository can't configure what runs on somebody's machine, so that part is set by the first `pico` command in it that
writes something; who only looks leaves git as it is.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.history.git import command as git
from pico.history.git.diff_wrapper import diff_command, text_command
from pico.history.git.merge_fallback import merge_lines
from pico.history.git.places import places, small

CLEAN, CONFLICT, FAILED = 40, 41, 42
"""What the driver ends with; nothing else ends with these by accident."""

LINE = "*.yaml merge=pico diff=pico"
GITATTRIBUTES = f"""\
# manifests merge value by value, and a diff says what moved; without PICO, git merges and shows their lines
{LINE}
# what runs recorded is shown by `pico show` and `pico runs`, not line by line
runs/** -diff linguist-generated
# lines that two branches append both stay
notes/*.md merge=union
"""
_BESIDE = (
    ("notes", b"merge=union", "notes/*.md merge=union", "lines of notes that two branches append both stay"),
    ("runs", b"-diff", "runs/** -diff linguist-generated", "what runs recorded is not shown line by line"),
)
_NAME = "PICO: manifests merge value by value"
_SECTION = re.compile(rb'^\[merge "pico"\]\s*$', re.MULTILINE)
_PYTHON = re.compile(rb'^\s*driver = "?(.+?) -P -m pico\.history\.merge\.driver ', re.MULTILINE)
_OFF = re.compile(rb"^\[pico\][ \t]*\n(?:[ \t]+.*\n)*?[ \t]*mergedriver = false[ \t]*$", re.MULTILINE)
_COMPONENT_LINE = "^ {0,2}([A-Za-z][A-Za-z0-9_/]*):"
"""What names a hunk: the last key above it at the depth of components, as written or as `diff.pico.textconv` has it."""


@dataclass(frozen=True, slots=True)
class Wiring:
    """How a repository stands: whether its attributes name the drivers of merge and diff, whether git knows one, as
    PICO sets it and of a PICO that is there, and whether somebody asked for it not to be set."""

    attributed: bool
    shown: bool
    known: bool
    current: bool
    refused: bool


def command() -> str:
    """Return the shell command that git runs: PICO's driver, or where that fails in any way, a merge of lines.

    %A is replaced only by a finished result, so that a driver that is missing or killed loses nothing.
    """
    return f"{shlex.quote(sys.executable).replace('%', '%%')} {_rest()}"


def _rest() -> str:
    return (
        "-P -m pico.history.merge.driver %A %A.pico %O %B %L %P %S %X %Y; s=$?; "
        f"test $s -eq {CLEAN} && mv -f %A.pico %A && exit 0; "
        f"test $s -eq {CONFLICT} && mv -f %A.pico %A && exit 1; "
        f"rm -f %A.pico; {merge_lines()}"
    )


def wiring(folder: Path) -> Wiring | None:
    """Return how the repository around `folder` is wired, read from its files alone; None outside of one."""
    found = places(folder)
    if found is None:
        return None
    config = small(found.common / "config")
    below = [p for p in (folder.resolve(), *folder.resolve().parents) if p.is_relative_to(found.top)]
    return Wiring(
        attributed=any(_names(b"merge=pico", p / ".gitattributes") for p in below),
        shown=any(_names(b"diff=pico", p / ".gitattributes") for p in below),
        known=bool(_SECTION.search(config)),
        current=all(_escaped(piece).encode() in config for piece in _pieces()) and _python_exists(config),
        refused=bool(_OFF.search(config)),
    )


def wire(folder: Path) -> bool:
    """Tell git about the drivers where the attributes name one and git does not know it; return whether that was so.

    Nothing happens where somebody asked for that, and where the configuration can't be written.
    """
    found = wiring(folder)
    if found is None or not (found.attributed or found.shown) or found.current or found.refused:
        return False
    try:
        install(folder)
    except PicoError:
        return False
    return not found.known


def install(folder: Path) -> None:
    """Set the drivers in the repository's own configuration; raises PicoError."""
    python = shlex.quote(sys.executable)
    wanted = {
        "merge.pico.name": _NAME, "merge.pico.driver": command(), "merge.pico.recursive": "binary",
        "diff.pico.command": diff_command(python), "diff.pico.textconv": text_command(),
        "diff.pico.xfuncname": _COMPONENT_LINE,
    }  # fmt: skip
    for key, value in wanted.items():
        git.run(folder, ["config", "--local", key, value], doing="set its drivers of merge and diff")
    _unset(folder, "--unset", "pico.mergedriver")


def uninstall(folder: Path) -> None:
    """Take the drivers out of the repository's own configuration and remember not to set them again.

    Raises PicoError.
    """
    _unset(folder, "--remove-section", "merge.pico")
    _unset(folder, "--remove-section", "diff.pico")
    git.run(folder, ["config", "--local", "pico.mergedriver", "false"], doing="remember that")


def checkup(folder: Path) -> tuple[Diagnostic, ...]:
    """Return what is wrong with the wiring of the repository around `folder`; nothing where all is well."""
    found = wiring(folder)
    if found is None:
        return (warning("git-none", f"{folder} is in no Git repository", hint="`git init` makes one"),)
    wrong = []
    if not found.attributed:
        hint = f"`echo '{LINE}' >> .gitattributes`, and commit that"
        wrong.append(warning("git-attributes", "no .gitattributes says that manifests merge by PICO", hint=hint))
    elif not found.shown:
        hint = "`echo '*.yaml diff=pico' >> .gitattributes`, and commit that: `git diff` then says what moved"
        wrong.append(warning("git-attributes", "no .gitattributes says that PICO shows what differs", hint=hint))
    wrong += _beside(folder)
    if found.refused:
        hint = "`pico git install` sets it again"
        wrong.append(warning("git-driver", "git does not know the merge driver: it was taken out here", hint=hint))
    elif not found.current:
        what = "knows PICO's drivers as another PICO set them" if found.known else "does not know PICO's drivers"
        hint = "`pico git install` sets them, the next command that writes sets them, too"
        wrong.append(warning("git-driver", f"git {what}", hint=hint))
    elif not _runs():
        hint = "`pico git install` with the PICO that is to be used; until then git merges lines"
        wrong.append(error("git-driver", "the merge driver does not start", hint=hint))
    return tuple(wrong)


def _beside(folder: Path) -> list[Diagnostic]:
    """Return what is missing in the attributes of what lies beside the manifests, where there is such a thing."""
    found = places(folder)
    own = folder.resolve()
    below = [p for p in (own, *own.parents) if found and p.is_relative_to(found.top)]
    wrong = []
    for inside, attribute, line, why in _BESIDE:
        if (own / inside).is_dir() and not any(_names(attribute, p / ".gitattributes") for p in below):
            hint = f"`echo '{line}' >> .gitattributes`, and commit that"
            wrong.append(warning("git-attributes", f"no .gitattributes says that {why}", hint=hint))
    return wrong


def _runs() -> bool:
    """Whether the driver starts: without files to merge it ends in its own way."""
    asked = [sys.executable, "-P", "-m", "pico.history.merge.driver"]
    try:
        return b"pico:" in subprocess.run(asked, capture_output=True, check=False, timeout=60).stderr
    except (OSError, subprocess.SubprocessError):
        return False


def _unset(folder: Path, how: str, name: str) -> None:
    """Take out what may not be there."""
    at = places(folder)
    if at and name.rpartition(".")[2].encode() not in small(at.common / "config").lower():
        return
    try:
        git.run(
            folder, ["config", "--local", how, name], doing="change its configuration", ends=(0, 5)
        )  # 5: no such key
    except PicoError:
        if name == "merge.pico" and (found := wiring(folder)) and found.known:
            raise


def _names(attribute: bytes, path: Path) -> bool:
    return any(attribute in line.split(b"#")[0].split() for line in small(path).splitlines())


def _python_exists(config: bytes) -> bool:
    found = _PYTHON.search(config)
    try:
        return found is not None and Path(shlex.split(found[1].decode())[0].replace("%%", "%")).is_file()
    except (ValueError, IndexError, UnicodeDecodeError):
        return False


def _pieces() -> list[str]:
    """Return the values of the configuration, apart from the interpreter that they name."""
    return [_rest(), text_command(), *diff_command("\n\n\n").split("\n\n\n")]


def _escaped(value: str) -> str:
    """Return a value as git writes it into a configuration file."""
    return value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
