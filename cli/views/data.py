"""The large data of runs: what is where, what was copied, what is wrong, what can go."""

from __future__ import annotations

from typing import Any

from pico.history.data.needs import Need
from pico.history.data.pointers import Pointed
from pico.history.data.transfer import Holdings, Moved
from pico.history.data.upkeep import Garbage, StoreCheck
from pico.model.record import as_json

from .style import columns, count, listed, paint

Found = Holdings | Moved | StoreCheck | Garbage | Pointed
_SHOWN = 20
"""Objects that are named one by one."""


def text(found: Found, *, done: str = "", freed: int | None = None) -> str:
    """Return what was found or done, as a few lines."""
    if isinstance(found, Holdings):
        return _holdings(found)
    if isinstance(found, Moved):
        return _moved(found, done)
    if isinstance(found, Pointed):
        return _pointed(found)
    return _checked(found) if isinstance(found, StoreCheck) else _garbage(found, freed)


def data(found: Found, *, done: str = "", freed: int | None = None) -> dict[str, Any]:
    """Return schema `pico.data/v1`; `kind` says of what: `status`, `sent`, `fetched`, `fsck`, `gc` or `pointers`."""
    content: dict[str, Any]
    if isinstance(found, Holdings):
        lists = {k: [as_json(n) for n in getattr(found, k)] for k in ("unsent", "absent", "lost")}
        needs = [as_json(n) for n in found.needs.values()]
        content = {"kind": "status", "place": found.place, "needs": needs, **lists, "spare": dict(found.spare)}
    elif isinstance(found, Moved):
        content = {"kind": done, **as_json(found)}
    elif isinstance(found, Pointed):
        content = {"kind": "pointers", **as_json(found)}
    elif isinstance(found, StoreCheck):
        damaged = [_known(name, found) for name in found.damaged]
        missing = [as_json(n) for n in found.missing]
        content = {"kind": "fsck", "objects": found.objects, "size": found.size, "damaged": damaged, "missing": missing}
    else:
        content = {"kind": "gc", "removable": dict(found.removable), "young": found.young, "freed": freed}
    return {"schema": "pico.data/v1", **content}


def size(number: float) -> str:
    """Return bytes as people write them: `512 B`, `4.2 MB`."""
    for unit in ("B", "kB", "MB", "GB"):
        if number < 1000:
            break
        number, unit = number / 1000, {"B": "kB", "kB": "MB", "MB": "GB", "GB": "TB"}[unit]
    return f"{number:.0f} {unit}" if unit == "B" else f"{number:.3g} {unit}"


def objects(needs: tuple[Need, ...]) -> str:
    """Return `3 objects (4.2 MB)`."""
    return f"{count(len(needs), 'object')} ({size(sum(n.size for n in needs))})"


def _holdings(found: Holdings) -> str:
    needed = tuple(found.needs.values())
    if not needed and not found.spare:
        return "No run in any commit needs large data."
    spare = sum(size for _, size in found.spare)
    here = tuple(n for n in needed if n.sha256 in found.here)
    rows = [_row("needed", needed, f"by {count(len({r for n in needed for r in n.runs}), 'run')}")]
    rows += [_row("here", here, "")]
    if found.there is not None:
        rows += [_row("there", tuple(n for n in needed if n.sha256 in found.there), str(found.place))]
    if found.unsent:
        rows += [_row("only here", found.unsent, _unsent(found))]
    fetched = tuple(n for n in found.absent if n not in found.lost)
    if fetched:
        rows += [_row("not here", fetched, "`pico data pull` brings them")]
    if found.lost:
        rows += [_row("missing", found.lost, "not there either" if found.place else "nobody said where copies are")]
    if found.spare:
        last = "no run of any ref needs them; `pico data gc` removes old ones"
        rows += [("not needed", count(len(found.spare), "object"), size(spare), last)]
    return "\n".join([*columns(rows), *_named("missing", found.lost)])


def _row(word: str, needs: tuple[Need, ...], last: str) -> tuple[str, str, str, str]:
    return word, count(len(needs), "object"), size(sum(n.size for n in needs)), last


def _unsent(found: Holdings) -> str:
    return "`pico data push` sends them" if found.place else "`git config pico.data.remote FOLDER` says where to"


def _moved(found: Moved, done: str) -> str:
    total = size(sum(n.size for n in found.objects))
    where = f"to {found.place}" if done == "sent" else f"from {found.place}"
    if found.objects:
        first = f"{done.capitalize()} {count(len(found.objects), 'object')}, {total}, {where}."
    else:
        first = f"Nothing to be {done} {where}: all that can be is there."
        if done == "fetched":
            first = f"Nothing to be fetched {where}: all that can be is here."
    block = [first]
    if found.lost:
        block.append(f"{count(len(found.lost), 'object')} that runs need neither here nor there:")
    return "\n".join([*block, *_named("missing", found.lost)])


def _checked(found: StoreCheck) -> str:
    block = [f"{count(found.objects, 'object')} read, {size(found.size)}."]
    for name in found.damaged:
        need = found.needs.get(name)
        whose = f"{need.name} of {listed(need.runs)}" if need else "no run of any ref needs it"
        block.append(f"{paint('red', 'damaged')} {name}  {whose}")
    block += _named("missing", found.missing)
    if found.well:
        block.append("All is well: every object is intact, every one that is needed is here.")
    else:
        block.append("`pico data pull` brings intact copies from where they are kept.")
    return "\n".join(block)


def _named(word: str, needs: tuple[Need, ...]) -> list[str]:
    lines = [f"{paint('red', word)} {n.sha256}  {n.name} of {listed(n.runs)}" for n in needs[:_SHOWN]]
    return [*lines, f"and {len(needs) - _SHOWN} more"] if len(needs) > _SHOWN else lines


def _garbage(found: Garbage, freed: int | None) -> str:
    young = f"; {count(found.young, 'object')} more that nothing needs, but young" if found.young else ""
    if not found.removable:
        return f"Nothing to remove{young}."
    if freed is not None:
        return f"Removed {count(len(found.removable), 'object')}, {size(freed)} freed{young}."
    return f"{count(len(found.removable), 'object')} that nothing here needs, {size(found.size)}{young}."


def _pointed(found: Pointed) -> str:
    if not found.files:
        return "No pointer to write: no run here has data that is not pointed at."
    paths = ".gitattributes runs" if found.attributes else "runs"
    block = [*found.files[:_SHOWN], *([f"and {len(found.files) - _SHOWN} more"] if len(found.files) > _SHOWN else [])]
    block.append(f"{count(len(found.files), 'pointer')} written, for {size(found.size)}.")
    block.append(
        f'Commit them: `git add {paths} && git commit -m "data by LFS"`; `git push` with git-lfs sends the data.'
    )
    return "\n".join(block)


def _known(name: str, found: StoreCheck) -> dict[str, Any]:
    need = found.needs.get(name)
    known: dict[str, Any] = as_json(need) if need else {"sha256": name, "runs": []}
    return known
