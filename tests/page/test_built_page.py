"""The page that is committed was built of what lies in `ui/`, for the interface that there is. Needs no Node."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

import pytest

from pico.server.app import create_app
from pico.server.page.described import described, digest
from pico.server.page.serving import POLICY
from pico.server.store.books import books_in

ROOT = Path(__file__).resolve().parent.parent.parent
UI, BUILT = ROOT / "ui", ROOT / "pico/server/static"
AGAIN = "`make ui` builds it anew"


def sources() -> str:
    """Return the digest of what the page is built of, as `ui/sources.js` makes it."""
    (listed,) = re.findall(r"BUILT_OF = \[(.*?)\]", (UI / "sources.js").read_text())
    found = []
    for name in re.findall(r'"([^"]+)"', listed):
        place = UI / name
        found += [p for p in place.rglob("*") if p.is_file()] if place.is_dir() else [place]
    digest = hashlib.sha256()
    for name in sorted(path.relative_to(UI).as_posix() for path in found):
        digest.update(f"{name}\0{(UI / name).read_text()}\0".encode())
    return digest.hexdigest()


def test_the_page_was_built_of_the_sources_beside_it() -> None:
    assert (BUILT / "sources.txt").read_text().strip() == sources(), AGAIN


def test_its_types_are_those_of_the_interface(tmp_path: Path) -> None:
    books = books_in(tmp_path)
    try:
        said = described(create_app(books))
    finally:
        books.close()
    first = (UI / "src/api/schema.d.ts").read_text().partition("\n")[0]
    assert first == f"// of the interface {digest(said)}", AGAIN


def test_it_is_small_and_asks_for_nothing_elsewhere() -> None:
    assert sum(path.stat().st_size for path in BUILT.rglob("*") if path.is_file()) <= 1_500_000
    page = (BUILT / "index.html").read_text()
    assert not re.findall(r'(?:src|href)="(?!/)', page)
    assert not re.search(r"<script(?![^>]*src=)|<style|style=", page), "the policy lets nothing in the page itself run"
    assert "unsafe" not in POLICY and "default-src 'none'" in POLICY
    css = "".join(path.read_text() for path in BUILT.rglob("*.css"))
    assert not re.search(r"url\(|@import", css)


def test_the_licence_of_each_library_in_it_lies_beside_it() -> None:
    told = (BUILT / "licences.txt").read_text()
    for name in ("three", "svelte"):
        assert re.search(rf"^{name}\n-+\n", told, re.M)
    assert told.count("Permission is hereby granted") >= 3


def test_the_lock_file_holds_no_addresses() -> None:
    text = (UI / "package-lock.json").read_text()
    assert "omit-lockfile-registry-resolved=true" in (UI / ".npmrc").read_text().split()
    locked = json.loads(text)["packages"]
    assert len(locked) > 20 and all("integrity" in one for name, one in locked.items() if name)
    assert '"resolved"' not in text and "registry" not in text and ".tgz" not in text


@pytest.mark.parametrize("library", ["svelte", "three", "uplot", "typescript", "vite"])
def test_versions_are_said_exactly(library: str) -> None:
    assert re.fullmatch(r"[\d.]+", json.loads((UI / "package.json").read_text())["devDependencies"][library])
