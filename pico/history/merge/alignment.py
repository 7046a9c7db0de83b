"""Three trees of manifests made alike before they are merged file by file: a component is its name, not its file.

What one side moved to another file and the other side changed is moved in the other versions too, with its comments;
a file that one side renamed is renamed in them. Then the merge of each file sees all that was done to a component.
Where the sides disagree on whether or where a component is, that is a conflict.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from pico.history.merge.leaves import OUT, Conflict
from pico.history.merge.parts import ComponentLines, Parts, bare, put, read, without

Files = dict[str, bytes]
Versions = tuple[bytes | None, bytes | None, bytes | None]
"""A file in base, ours and theirs, None where it is not there."""
Key = tuple[str, str]
"""The folder of a lab, and the name of one of its components."""


@dataclass
class Alike:
    """The three versions made alike, of files that had these `paths`. `conflicts`: by file, components of which the
    sides disagree where they are; `present`: those that the merged files must have, in one file each; `unclear`: those
    of which that can't be said; `emptied`: files that one side took away and that it holds without components here,
    because the other side changed them."""

    base: Files
    ours: Files
    theirs: Files
    labs: Collection[str]
    paths: Collection[str]
    unclear: Collection[Key] = ()
    conflicts: list[tuple[str, Conflict]] = field(default_factory=list)
    present: set[Key] = field(default_factory=set)
    emptied: set[str] = field(default_factory=set)

    def versions(self) -> dict[str, Versions]:
        """Return each file in base, ours and theirs."""
        paths = self.base.keys() | self.ours.keys() | self.theirs.keys()
        return {path: (self.base.get(path), self.ours.get(path), self.theirs.get(path)) for path in paths}


def made_alike(base: Files, ours: Files, theirs: Files, labs: Collection[str]) -> Alike:
    """Return three versions of files (those that differ between them) made alike; `labs`: the folders of labs."""
    versions = [dict(base), dict(ours), dict(theirs)]
    _rename(versions)
    sight = _Sight(versions, labs)
    made = Alike({}, {}, {}, labs, base.keys() | ours.keys() | theirs.keys(), sight.unclear)
    moves = _Moves(sight)
    for key in sorted(set().union(*sight.homes) - sight.unclear):
        homes = [places.get(key) for places in sight.homes]
        conflict = disagreement(key[1], *homes)
        if conflict:
            made.conflicts.append(conflict)
        else:
            moves.follow(key, homes)
        if None not in homes[1:] or homes[0] is None:
            made.present.add(key)
    made.base, made.ours, made.theirs = (moves.made(i) for i in range(3))
    made.emptied = set(_empty(made))
    return made


def settled(made: Alike, united: Files) -> tuple[Files, list[str]]:
    """Return the merged files without those that nobody wants any more, and which can't be as they came out: where a
    component is lost, is there twice, or came back, or one side took away what the other changed."""
    gone = {path for path in made.emptied if not _names(united[path])}
    wrong = [path for path in gone if _emptied(united[path]) != _emptied(made.base[path])]
    kept = {path: data for path, data in united.items() if path not in gone}
    found = list(homes(kept, made.labs))
    count = Counter(key for key, _ in found)
    wrong += [path for key, path in found if key not in made.unclear and count[key] != (key in made.present)]
    where = {key: path for files in (made.ours, made.theirs) for key, path in homes(files, made.labs)}
    wrong += [where[key] for key in made.present if not count[key]]
    return kept, sorted(set(wrong))


def disagreement(name: str, base: str | None, ours: str | None, theirs: str | None) -> tuple[str, Conflict] | None:
    """Return the conflict, with its file, of a component that both sides put into different files, or that one took out
    and the other moved; each argument is the file that has it, None where none does."""
    if ours == theirs or base in (ours, theirs) or (base is None and None in (ours, theirs)):
        return None
    put = "moved to" if base else "put into"
    mine, other = (f"{put} {path}" if path else OUT for path in (ours, theirs))
    files = tuple(sorted({path for path in (ours, theirs) if path}))
    was = f"in {base}" if base else "absent"
    return files[0], Conflict(("0", "components", name), was, mine, other, (name,), files)


def homes(files: Mapping[str, bytes], labs: Collection[str]) -> Iterator[tuple[Key, str]]:
    """Yield each component with the file that has it; one that several files have more than once."""
    for path, data in sorted(files.items()):
        found = read(data)
        yield from (((lab_of(path, labs), name), path) for name in (found.names if found else ()))


def lab_of(path: str, labs: Collection[str]) -> str:
    """Return the nearest folder above a file that is a lab's; the top where none is."""
    above = [str(folder) for folder in PurePosixPath(path).parents]
    return next((folder for folder in above if folder in labs), ".")


class _Sight:
    """What three versions hold: by version the parts of each file and the file of each component. `unclear`: components
    that are twice in one version, or in a file that can't be read in another."""

    def __init__(self, versions: list[Files], labs: Collection[str]) -> None:
        self.versions = versions
        self.parts: list[dict[str, Parts | None]] = [{p: read(d) for p, d in v.items()} for v in versions]
        broken = {path for parts in self.parts for path, found in parts.items() if found is None}
        found = [[*homes(version, labs)] for version in versions]
        counted = [Counter(key for key, _ in pairs) for pairs in found]
        self.unclear = {key for count in counted for key, times in count.items() if times > 1}
        self.unclear |= {key for pairs in found for key, path in pairs if path in broken}
        self.homes = [dict(pairs) for pairs in found]

    def part(self, version: int, path: str, name: str) -> ComponentLines | None:
        """Return a component as a file of a version has it, None where it can't be taken out of there."""
        found = self.parts[version].get(path)
        return found.lines.get(name) if found and found.lines else None


class _Moves:
    """Collects, by version and file, the components that are to be taken out and put in."""

    def __init__(self, sight: _Sight) -> None:
        self.sight = sight
        self.out: list[dict[str, list[str]]] = [{}, {}, {}]
        self.into: list[dict[str, dict[str, ComponentLines]]] = [{}, {}, {}]

    def follow(self, key: Key, homes: list[str | None]) -> None:
        """Move a component, in the versions that have it elsewhere, to the file into which one side or both moved it;
        not where nothing else was done to it."""
        was, mine, other = homes
        name = key[1]
        target = other if mine == was else mine
        if was is None or mine is None or other is None or target is None or was == mine == other:
            return
        parts = [self.sight.part(i, home, name) for i, home in enumerate((was, mine, other))]
        stayed = (parts[1], parts[2]) if mine == other else (parts[0], parts[1] if mine == was else parts[2])
        if None in parts or _same(*stayed):
            return
        after = min(part.after for part, home in zip(parts[1:], homes[1:], strict=True) if part and home == target)
        elsewhere = [i for i in range(3) if homes[i] != target]
        if all(self._skeleton(i, target) for i in elsewhere):
            for i in elsewhere:
                home, part = homes[i], parts[i]
                assert home is not None and part is not None
                self.out[i].setdefault(home, []).append(name)
                self.into[i].setdefault(target, {})[name] = ComponentLines(part.lines, after)

    def made(self, version: int) -> Files:
        """Return the files of a version with what was collected done to them."""
        files = dict(self.sight.versions[version])
        for path, names in self.out[version].items():
            files[path] = without(files[path], names)
        for path, parts in self.into[version].items():
            files[path] = put(files.get(path) or self._skeleton(version, path), parts)
        return files

    def _skeleton(self, version: int, path: str) -> bytes:
        """Return a file of a version as components can be put into it: one with nothing in it where this version does
        not have it; nothing where that can't be."""
        there = next(i for i in (version, 0, 1, 2) if path in self.sight.versions[i])
        found, data = self.sight.parts[there].get(path), self.sight.versions[there][path]
        if found is None or found.lines is None:
            return b""
        return data if there == version else bare(data)


def _same(a: ComponentLines | None, b: ComponentLines | None) -> bool:
    """Whether two versions of a component say the same in the same way, save blank lines."""
    return a is not None and b is not None and [x for x in a.lines if x] == [x for x in b.lines if x]


def _rename(versions: list[Files]) -> None:
    """Give each file that one side alone renamed its new name in the other versions."""
    base = dict(versions[0])
    for side, other in ((1, 2), (2, 1)):
        mine, theirs = versions[side], versions[other]
        new = {path for path in mine if path not in base and path not in theirs}
        found = {old: _renamed(old, base, mine, new) for old in base if old not in mine and old in theirs}
        for old, name in found.items():
            if name and list(found.values()).count(name) == 1:
                for version in (versions[0], theirs):
                    version[name] = version.pop(old)


def _renamed(old: str, base: Files, mine: Files, new: Collection[str]) -> str | None:
    """Return the new file that has most of the components of one that is gone."""
    names = set(_names(base[old]))
    held = {path: len(names & set(_names(mine[path]))) for path in new}
    best = max(sorted(held), key=lambda path: held[path], default=None)
    return best if best and 2 * held[best] > len(names) else None


def _names(data: bytes) -> tuple[str, ...]:
    found = read(data)
    return found.names if found else ()


def _emptied(data: bytes) -> bytes:
    return without(data, _names(data))


def _empty(made: Alike) -> Iterator[str]:
    """Give a file back, without components, to the side that took it away, where the other side changed it."""
    for path, was in made.base.items():
        for mine, other in ((made.ours, made.theirs), (made.theirs, made.ours)):
            found = read(was)
            if path not in mine and other.get(path, was) != was and found and found.lines is not None:
                mine[path] = _emptied(was)
                yield path
