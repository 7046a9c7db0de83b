"""The version of this PICO, whether it satisfies what a lab requires, and the command that installs another one."""

from __future__ import annotations

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
