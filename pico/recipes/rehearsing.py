"""Recipes of a lab tried in the simulator, as CI does: each in a clone of the repository with a bench of its own."""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field, replace
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from pico.backends.devices import SIMULATOR
from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.git.command import run as git
from pico.history.repository.repository import Repository

if TYPE_CHECKING:
    from pico.recipes.running import Outcome

ASIDE = (".git", ".pico", "runs")
"""What of a lab's folder does not go along as a file."""


@dataclass(frozen=True)
class Rehearsed:
    """How a recipe went in the simulator: `done`, `failed` or `interrupted`, at which step; `skipped` and why, for one
    that was only checked; wall time [s]."""

    name: str
    outcome: str
    at: str = ""
    why: str = ""
    seconds: float = 0.0
    returns: Mapping[str, Any] = field(default_factory=dict)
    diagnostics: tuple[Diagnostic, ...] = ()

    @classmethod
    def of(cls, name: str, out: Outcome, seconds: float) -> Self:
        """Return how a run of a recipe went."""
        return cls(name, out.outcome, out.at, "", seconds, dict(out.returns), out.diagnostics)

    @property
    def passed(self) -> bool:
        """Whether it came to its end, or is right as far as it can be checked."""
        return self.outcome in ("done", "skipped")

    @property
    def skipped(self) -> bool:
        """Whether it was checked and not run."""
        return self.outcome == "skipped"


def rehearse_all(
    root: Path, names: Iterable[str], *, fidelity: str = "kinematic", jobs: int = 2,
    heard: Callable[[Rehearsed], None] = lambda _: None,
) -> tuple[Rehearsed, ...]:  # fmt: skip
    """Try recipes by name or path, `jobs` at a time in processes of their own, and return how each went, in order;
    `heard` is told of each as it ends. The lab and its bench are not touched."""
    wanted, found = list(names), dict[str, Rehearsed]()
    with ProcessPoolExecutor(max_workers=max(1, min(jobs, len(wanted) or 1)), mp_context=get_context("spawn")) as pool:
        tried = {pool.submit(rehearse, str(root), name, fidelity): name for name in wanted}
        for one in as_completed(tried):
            found[tried[one]] = _ended(one, tried[one])
            heard(found[tried[one]])
    return tuple(found[name] for name in wanted)


def _ended(one: Any, name: str) -> Rehearsed:
    try:
        found: Rehearsed = one.result()
    except Exception as exc:  # a process that was killed takes its pool along
        return Rehearsed(name, "failed", diagnostics=(error("process", f"{name} ended without a word: {exc}"),))
    return found


def rehearse(root: str, name: str, fidelity: str) -> Rehearsed:
    """Try one recipe of the lab in `root`, in a clone that is gone afterwards. One whose parameters have no values by
    default is a function of other recipes: it is read and checked, and not run."""
    from pico.bench.bench import Bench
    from pico.recipes.recipes import Recipes

    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="pico-test-") as folder:
        try:
            lab = clone(Path(root), Path(folder) / "lab")
            with Bench.open(lab, fidelity=fidelity, bench=SIMULATOR) as bench:
                recipes = Recipes(bench)
                recipe = recipes.read(name)
                if wants := [p.name for p in recipe.parameters.values() if p.default is None]:
                    return Rehearsed(name, "skipped", why=_function(wants), seconds=time.monotonic() - began)
                out = recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})))
        except PicoError as exc:
            found = Rehearsed(name, "failed", seconds=time.monotonic() - began, diagnostics=tuple(exc.diagnostics))
        else:
            found = Rehearsed.of(name, out, time.monotonic() - began)
        return replace(
            found, diagnostics=tuple(_in_lab(d, Path(folder) / "lab", Path(root)) for d in found.diagnostics)
        )


def _in_lab(found: Diagnostic, clone: Path, root: Path) -> Diagnostic:
    """Return a diagnostic of a clone with the file of the lab that it is about: the clone is gone when it is read."""
    repository = Repository.discover(root)
    here = repository.root if repository else root
    if found.source is None or not Path(found.source.path).is_relative_to(clone):
        return found
    return replace(found, source=replace(found.source, path=str(here / Path(found.source.path).relative_to(clone))))


def _function(wants: Sequence[str]) -> str:
    """Return why a recipe with such parameters is not run."""
    names = " and ".join([", ".join(wants[:-1]), wants[-1]] if len(wants) > 1 else wants)
    return f"a function: {names} {'has' if len(wants) == 1 else 'have'} no default"


def clone(root: Path, to: Path) -> Path:
    """Make a repository with all branches and tags of the one that a lab is in, those of its remotes included, an
    identity to commit as, and the lab's files as they are now; return the lab's folder in it. Raises PicoError."""
    repository = Repository.discover(root)
    if repository is None:
        shutil.copytree(root, to, ignore=lambda _, found: set(found) & set(ASIDE))
        return to
    source, doing = str(repository.root), "make a clone to try recipes in"
    to.mkdir(parents=True)
    git(to, ["init", "-q"], doing=doing, extra=_OWN)
    for key, value in _IDENTITY.items():
        git(to, ["config", key, value], doing=doing, extra=_OWN)
    refs = [f"+refs/{kind}/*:refs/{kind}/*" for kind in ("heads", "tags", "remotes")]
    git(to, ["fetch", "-q", "--no-auto-gc", "--update-head-ok", source, *refs], doing=doing, extra=_OWN)
    for name in git(repository.root, ["remote"], doing=doing).split():  # by them git knows whose branches those are
        git(to, ["remote", "add", name, source], doing=doing, extra=_OWN)
    head = repository.head()
    if head.commit:
        git(to, ["fetch", "-q", "--no-auto-gc", source, head.commit], doing=doing, extra=_OWN)
        git(to, ["checkout", "-q", "-f", head.branch or head.commit], doing=doing, extra=_OWN)
    lab = to / repository.relative(root)
    shutil.copytree(root, lab, ignore=lambda _, found: set(found) & set(ASIDE), dirs_exist_ok=True)
    return lab


_OWN = {"GIT_CONFIG_GLOBAL": "/dev/null", "GIT_ALLOW_PROTOCOL": "file"}
_IDENTITY = {"user.name": "PICO", "user.email": "pico@localhost"}
"""As whom recipes commit there: a runner of continuous integration has no identity of its own."""
