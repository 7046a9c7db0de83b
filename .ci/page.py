"""Build the page for browsers of `ui/`, check that what is committed was built of it, or test it in a browser.

    python .ci/page.py build    types of the interface, then pico/server/static/
    python .ci/page.py check    the same elsewhere, and compared; its own tests
    python .ci/page.py test     in Chromium, against a coordinator with a bench in the twin
    python .ci/page.py pictures those of the documentation, docs/images/page-*.png, of an example that is made for them

Node 20 or newer and npm are needed to build and to check; without them a check says so and passes, for whoever only
uses the page needs neither.
"""

from __future__ import annotations

import filecmp
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
UI, BUILT, TYPES = ROOT / "ui", ROOT / "pico/server/static", ROOT / "ui/src/api/schema.d.ts"
OLDEST = (20, 19)


def node_lacks() -> str:
    """Return what is missing to build the page; empty where nothing is."""
    if not (node := shutil.which("node")) or not shutil.which("npm"):
        return "Node and npm are not here"
    said = subprocess.run([node, "--version"], text=True, capture_output=True, check=True).stdout.strip()
    found = tuple(int(part) for part in said.lstrip("v").split(".")[:2])
    return "" if found >= OLDEST else f"Node {said} is older than {'.'.join(map(str, OLDEST))}"


def run(*words: str | Path, **more: str) -> None:
    """Run a program in `ui/`; stop with what it said where it fails."""
    environment = {**os.environ, "npm_config_update_notifier": "false", **more}
    done = subprocess.run(
        [str(w) for w in words], cwd=UI, env=environment, text=True, capture_output=True, check=False
    )  # fmt: skip
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))} ended with {done.returncode}\n{done.stdout}{done.stderr}")


def installed() -> None:
    """Install what the lock file names, where that is not there."""
    lock, stamp = UI / "package-lock.json", UI / "node_modules/.lock"
    said = hashlib.sha256(lock.read_bytes()).hexdigest()
    if not stamp.exists() or stamp.read_text() != said:
        run("npm", "ci", "--no-audit", "--no-fund")
        stamp.write_text(said)


def types(out: Path) -> None:
    """Write the types of the coordinator's interface, with the digest of what they were made of."""
    from pico.server.app import create_app
    from pico.server.page.described import described, digest
    from pico.server.store.books import books_in

    with tempfile.TemporaryDirectory() as name:
        books = books_in(Path(name))
        said = described(create_app(books))
        books.close()
        source = Path(name) / "openapi.json"
        source.write_text(json.dumps(said))
        run("npx", "--no-install", "openapi-typescript", source, "--output", out)
    out.write_text(f"// of the interface {digest(said)}\n{out.read_text()}")


def build() -> None:
    """Make the types and the page anew."""
    installed()
    types(TYPES)
    run("npx", "--no-install", "vite", "build")
    size = sum(path.stat().st_size for path in BUILT.rglob("*") if path.is_file())
    print(f"The page is in {BUILT.relative_to(ROOT)}: {size / 1e6:.2f} MB.")


def check() -> None:
    """Compare what is committed with what `ui/` gives, and run the page's own tests."""
    installed()
    with tempfile.TemporaryDirectory() as name:
        fresh = Path(name) / "schema.d.ts"
        types(fresh)
        if fresh.read_text() != TYPES.read_text():
            sys.exit(f"{TYPES.relative_to(ROOT)} is not of the interface as it is: `make ui`")
        run("npx", "--no-install", "svelte-check", "--fail-on-warnings")
        run("npx", "--no-install", "vitest", "run")
        run("npx", "--no-install", "vite", "build", "--outDir", Path(name) / "static")
        if differing := differences(BUILT, Path(name) / "static"):
            sys.exit("not what ui/ gives, `make ui` builds it anew:\n  " + "\n  ".join(differing))
    print("The page is what ui/ gives, and its tests pass.")


def differences(one: Path, other: Path) -> list[str]:
    """Return the files by which two folders differ."""
    names = {p.relative_to(f).as_posix() for f in (one, other) for p in f.rglob("*") if p.is_file()}
    _, wrong, missing = filecmp.cmpfiles(one, other, sorted(names), shallow=False)
    return sorted([*wrong, *missing])


def browser() -> None:
    """Install what drives a browser, and the browser where that can be; stop where it can't."""
    if not shutil.which("chromium"):
        if os.geteuid() == 0 and shutil.which("apt-get"):
            subprocess.run(["apt-get", "install", "-y", "-qq", "--no-install-recommends", "chromium"], check=False)
        if not shutil.which("chromium"):
            sys.exit("Chromium is not here, and can't be installed: `apt-get install chromium` as root")
    installed()


def test() -> None:
    """Run the tests that need a browser."""
    browser()
    sys.exit(subprocess.run([sys.executable, "-m", "pytest", "-n", "0", ROOT / "tests/page"], check=False).returncode)


def pictures() -> None:
    """Make the pictures of the documentation anew, small ones."""
    from PIL import Image

    browser()
    with tempfile.TemporaryDirectory() as name:
        folder, pico = Path(name), [sys.executable, "-m", "pico_cli"]
        own = {"XDG_CONFIG_HOME": str(folder / "config"), "XDG_STATE_HOME": str(folder / "state")}
        environment = os.environ | own
        for words in (["init", "--example", "shel", folder / "lab"], ["-C", folder / "lab", "apply", "e1", "-y"]):
            subprocess.run([*pico, *words], env=environment, check=True, capture_output=True)
        serving = subprocess.Popen(
            [*pico, "-C", folder / "lab", "--json", "gui", "--no-open"], env=environment, text=True,
            stdout=subprocess.PIPE, start_new_session=True,
        )  # fmt: skip
        try:
            assert serving.stdout is not None
            address = json.loads(serving.stdout.readline())["address"]
            run("node", "test/browser/pictures.mjs", address, ROOT / "docs/images", "--documented")
        finally:
            serving.send_signal(signal.SIGTERM)
            serving.wait(60)
    for path in (ROOT / "docs/images").glob("page-*.png"):
        Image.open(path).convert("RGB").quantize(256).save(path, optimize=True)
    print("The pictures are in docs/images.")


if __name__ == "__main__":
    wanted = sys.argv[1] if len(sys.argv) == 2 else ""
    if wanted not in ("build", "check", "test", "pictures"):
        sys.exit(__doc__)
    if lacking := node_lacks():
        print(f"{lacking}: the page can't be built, its built output is not compared.")
        sys.exit(0 if wanted == "check" else 1)
    {"build": build, "check": check, "test": test, "pictures": pictures}[wanted]()
