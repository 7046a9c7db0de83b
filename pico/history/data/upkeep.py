"""Looking after the objects here: are all whole, and which can go."""

from __future__ import annotations

from pico.content.store import Store
from pico.history.data.needs import Need, Needs
from pico.history.data.transfer import Shared
from pico.model.record import record


@record
class StoreCheck:
    """What a look at every object found: how many there are with how many bytes, which are damaged (and were set
    aside), which are needed and not here."""

    objects: int
    size: int
    damaged: tuple[str, ...]
    missing: tuple[Need, ...]
    needs: Needs

    @property
    def well(self) -> bool:
        """Whether every object is intact and every needed one here."""
        return not self.damaged and not self.missing


@record
class Garbage:
    """Objects that nothing here needs, with their bytes: those old enough to be removed, and how many are not yet."""

    removable: tuple[tuple[str, int], ...]
    young: int

    @property
    def size(self) -> int:
        """Bytes that can be freed."""
        return sum(size for _, size in self.removable)


def check(store: Store, needs: Needs, shared: Shared) -> StoreCheck:
    """Read every object again and set aside what is damaged; raises PicoError where the store can't be read."""
    sizes = {name: store.size(name) for name in store.all()}
    total, through, damaged = max(sum(sizes.values()), 1), 0, []
    for name, size in sizes.items():
        if not store.is_intact(name):
            damaged.append(name)
        through += size
        shared(through / total)
    missing = tuple(n for n in needs.values() if n.sha256 not in sizes)
    return StoreCheck(
        objects=len(sizes), size=sum(sizes.values()), damaged=tuple(damaged), missing=missing, needs=needs
    )


def garbage(store: Store, kept: Needs, grace: float) -> Garbage:
    """Return what is not in `kept`; what was put less than `grace` seconds ago is young. Raises PicoError."""
    loose = [name for name in store.all() if name not in kept]
    old = tuple((name, store.size(name)) for name in loose if store.age(name) >= grace)
    return Garbage(removable=old, young=len(loose) - len(old))


def remove(store: Store, found: Garbage, kept: Needs, grace: float) -> int:
    """Remove what was `found` and is not in `kept` by now, and what killed writers left; return the bytes freed."""
    names = [name for name, _ in found.removable if name not in kept]
    return sum(store.remove(name, older=grace) for name in names) + store.sweep(kept)
