"""What a checkout holds, sent to the repository of its lab at a coordinator, and what was made there, fetched."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from pico.edge.network.remotes import Far
from pico.edge.network.tokens import certificate_of, token_of
from pico.history.git.command import run

DOING = "hand the lab over to its coordinator"


def snapshot(root: Path) -> str:
    """Return a commit of what the checkout of the lab in `root` holds, edits among them: the one checked out where
    there are none. The checkout, its index and its branches stay as they are. Raises PicoError."""
    head = run(root, ["rev-parse", "--verify", "HEAD^{commit}"], doing=DOING).strip()
    with tempfile.TemporaryDirectory(prefix="pico-sent-") as scratch:
        own = {"GIT_INDEX_FILE": f"{scratch}/index"}
        run(root, ["read-tree", head], doing=DOING, extra=own)
        run(root, ["add", "--all", ":/"], doing=DOING, extra=own)
        tree = run(root, ["write-tree"], doing=DOING, extra=own).strip()
    if tree == run(root, ["rev-parse", f"{head}^{{tree}}"], doing=DOING).strip():
        return head
    return run(root, ["commit-tree", tree, "-p", head, "-m", "as the checkout held it"], doing=DOING).strip()


def send(root: Path, far: Far, commit: str) -> None:
    """Push a commit into the repository of the lab at a coordinator, beside its branches; raises PicoError."""
    with _known(far) as own:
        words = ["push", "--quiet", "--no-verify", _url(far), f"{commit}:refs/pico/sent/{commit}"]
        run(root, words, doing=DOING, extra=own)


def fetch(root: Path, far: Far, branch: str, name: str, since: str) -> str | None:
    """Fetch a branch of the repository at a coordinator as the branch `name`; return its commit, None where it holds
    nothing after `since`. Raises PicoError."""
    doing = f"fetch {branch} from its coordinator"
    with _known(far) as own:
        run(root, ["fetch", "--quiet", "--no-tags", _url(far), f"refs/heads/{branch}"], doing=doing, extra=own)
    found = run(root, ["rev-parse", "FETCH_HEAD"], doing=doing).strip()
    if found == since:
        return None
    run(root, ["update-ref", f"refs/heads/{name}", found], doing=doing)
    return found


def _url(far: Far) -> str:
    return f"{far.remote.url}/api/git/{far.lab}"


@contextmanager
def _known(far: Far) -> Iterator[Mapping[str, str]]:
    """Yield an environment in which git is known to a coordinator, and knows it; no word of that is an argument, which
    others could read."""
    values = {
        "http.extraHeader": f"Authorization: Bearer {token_of(far.remote.url) or ''}", "credential.helper": "",
        "http.followRedirects": "false",
    }  # fmt: skip
    with tempfile.NamedTemporaryFile("w", suffix=".pem") as certificate:
        if own := far.remote.certificate or certificate_of(far.remote.url):
            certificate.write(own)
            certificate.flush()
            values["http.sslCAInfo"] = certificate.name
        pairs = {f"GIT_CONFIG_{what}_{n}": text for n, pair in enumerate(values.items())
                 for what, text in zip(("KEY", "VALUE"), pair, strict=True)}  # fmt: skip
        yield {"GIT_CONFIG_COUNT": str(len(values)), **pairs, "GIT_ALLOW_PROTOCOL": "http:https",
               "GIT_TERMINAL_PROMPT": "0"}  # fmt: skip
