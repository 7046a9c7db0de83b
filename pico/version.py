"""The version of this PICO, whether it satisfies what a lab requires, and the command that installs another one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from packaging.version import Version

__version__ = "0.1.0"

PACKAGE = "pico-lab"
NEWER = "newer-pico"
"""The code of what is said of a file of a newer PICO, which no command of this one replaces."""


def satisfies(requirement: str) -> bool:
    """Return whether this PICO satisfies a version specifier such as `>=0.2` (PEP 440; pre-releases count).

    Raises ValueError for text that is not one or more comparisons with a version.
    """
    from packaging.specifiers import SpecifierSet

    specifiers = SpecifierSet(requirement)
    if not len(specifiers):
        raise ValueError("empty specifier")
    return specifiers.contains(__version__, prereleases=True)


def needed(requirement: str) -> Literal["newer", "older", "other", "never"]:
    """Return which PICO satisfies a version specifier that this one does not: only newer ones, only older ones, both,
    or none.

    Asked are the versions that the specifier names and those right beside them, between which its answer is the same.
    """
    from packaging.specifiers import SpecifierSet
    from packaging.version import InvalidVersion, Version

    wanted, this = SpecifierSet(requirement), Version(__version__)
    found = set()
    for one in wanted:
        try:
            named = Version(one.version.removesuffix(".*"))
        except InvalidVersion:  # `===` compares text, which may be no version
            return "other"
        epoch, release = f"{named.epoch}!" if named.epoch else "", ".".join(map(str, named.release))
        later = (*named.release[:-1], named.release[-1] + 1)
        beside = [release, f"{release}.dev0", f"{release}.post0", f"{release}.0.1", ".".join(map(str, later))]
        beside += ["0.0.1", "9999"]
        found |= {named, *(Version(f"{epoch}{word}") for word in beside), *_before(named)}
    fitting = [one for one in found if wanted.contains(one, prereleases=True)]
    newer, older = any(one > this for one in fitting), any(one < this for one in fitting)
    return "other" if newer and older else "newer" if newer else "older" if older else "never"


def _before(named: Version) -> list[Version]:
    """Return versions below another one, down to none: of 0.2.0 they are 0.1.9999 and so on."""
    from packaging.version import Version

    epoch = f"{named.epoch}!" if named.epoch else ""
    return [
        Version(epoch + ".".join(map(str, (*named.release[:n], part - 1, 9999))))
        for n, part in enumerate(named.release) if part
    ]  # fmt: skip


def downgrade_command(requirement: str) -> str:
    """Return the shell command that installs an older PICO, which satisfies `requirement`; from a clone, the one that
    lists its releases."""
    import shlex
    from pathlib import Path

    source, _ = _installation()
    if source and (Path(source) / ".git").exists():
        return f"git -C {shlex.quote(source)} tag --list --sort=-version:refname"
    return upgrade_command(requirement).replace(" --upgrade", "")


def upgrade_command(requirement: str = "") -> str:
    """Return the shell command that installs a PICO that satisfies `requirement`, the newest one without any.

    It upgrades the installation that is running, in the way in which that was made: from a clone, by uv or by pip.
    """
    import shlex
    import sys
    from pathlib import Path

    python = shlex.quote(sys.executable)
    source, installer = _installation()
    if source and (Path(source) / ".git").exists():
        clone = shlex.quote(source)
        return f"git -C {clone} pull && {python} -m pip install -e {clone}"
    pip = f"uv pip install --python {python}" if installer == "uv" else f"{python} -m pip install"
    return f"{pip} --upgrade {shlex.quote(PACKAGE + requirement.replace(' ', ''))}"


def upgrade_hint() -> str:
    """Return the hint for a file or message of a newer PICO."""
    return f"upgrade PICO: `{upgrade_command()}`"


def _installation() -> tuple[str, str]:
    """Return the folder that PICO was installed from, empty for an index, and the program that installed it."""
    import json
    from importlib.metadata import PackageNotFoundError, distribution
    from urllib.parse import unquote, urlsplit

    try:
        found = distribution(PACKAGE)
        origin = urlsplit(json.loads(found.read_text("direct_url.json") or "{}").get("url", ""))
        return unquote(origin.path) if origin.scheme == "file" else "", (found.read_text("INSTALLER") or "").strip()
    except (PackageNotFoundError, OSError, ValueError):
        return "", ""
