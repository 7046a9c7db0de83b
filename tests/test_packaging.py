"""The wheel holds every package of the tree."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def test_every_package_is_listed() -> None:
    config = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    listed = {p for p in config["packages"] if not p.startswith("pico._data")}
    found = set()
    for name, folder in (("pico", "pico"), ("pico_cli", "cli")):
        for init in (ROOT / folder).rglob("__init__.py"):
            found.add(".".join([name, *init.parent.relative_to(ROOT / folder).parts]))
    assert listed == found


def test_every_python_file_is_in_a_package() -> None:
    for folder in ("pico", "cli"):
        for path in (ROOT / folder).rglob("*.py"):
            assert (path.parent / "__init__.py").exists(), f"{path.relative_to(ROOT)} is in no package"


def test_test_modules_have_names_of_their_own() -> None:
    names = [path.name for path in (ROOT / "tests").rglob("*.py") if path.name != "conftest.py"]
    assert sorted(names) == sorted(set(names)), "pytest imports test modules by their bare names"


def test_pico_is_imported_from_the_folder_above_a_clone_of_that_name(tmp_path: Path) -> None:
    """As `make` installs it: the folder `pico`, which is no package, comes first on the path."""
    assert "python .ci/path.py" in (ROOT / "Makefile").read_text()
    packages = tmp_path / "packages"
    packages.mkdir()
    subprocess.run([sys.executable, ROOT / ".ci" / "path.py", packages], check=True)
    (tmp_path / "work" / "pico").mkdir(parents=True)
    code = f"import site; site.addsitedir({str(packages)!r}); import pico, pico_cli.main; print(pico.open.__name__)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path / "work", check=False, capture_output=True, text=True
    )
    assert (done.stdout, done.returncode) == ("open\n", 0), done.stderr
