"""Where the packaged catalog, example labs and JSON Schemas are: in an installed wheel, or in the repository."""

from __future__ import annotations

from pathlib import Path

_HERE = Path(__file__).resolve().parent


def _folder(name: str) -> Path:
    packaged = _HERE / "_data" / name
    return packaged if packaged.is_dir() else _HERE.parent / name


def catalog_dir() -> Path:
    """Return the folder of the packaged component types, one file a type."""
    return _folder("catalog")


def labs_dir() -> Path:
    """Return the folder of the example laboratories, one folder a lab."""
    return _folder("labs")


def schemas_dir() -> Path:
    """Return the folder of the generated JSON Schemas."""
    return _folder("schemas")


def page_dir() -> Path:
    """Return the folder of the built page that the coordinator serves."""
    return _HERE / "server" / "static"
