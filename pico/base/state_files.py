"""The registry of all that PICO keeps below `.pico` and in Git's own folder: one entry for each kind of file.

`docs/reference/state-files.md` is printed from it, `pico doctor` checks by it, and a test walks a lab in use and finds
no file that is not here. Who reads or writes a file takes its entry, and with it path, format and error text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from pico.base.formats import Format
from pico.base.state_file import ASIDE, StateFile

BENCH = "benches/BENCH/"

# of a bench: what must never be read as empty

HOLDER = StateFile(
    BENCH + "holder.json", "process", "who holds the lock of the bench, and for what",
    "the process that takes the bench",
    "who is named in messages; the lock itself is the kernel's", "`rm {path}`; the lock counts without it",
)  # fmt: skip
STOP = StateFile(
    BENCH + "stop.json", "process", "the request to stop, for the holder of one lease", "`pico stop`",
    "", "press Ctrl-C in the terminal of the run, or call `pico stop` again",
)  # fmt: skip
DOSE = StateFile(
    BENCH + "dose.json", "safety", "how much light each sample has had, and gets",
    "the edge, while samples are on the bench",
    "the doses of the samples between operations: the rest is counted again from the journal",
    ASIDE + "; the journal is then counted again: lower `dose_budget` in lab.yaml by the light between operations",
    Format("pico.dose"),
)  # fmt: skip
UNATTENDED = StateFile(
    BENCH + "unattended.json", "safety", "the terms of the last unattended run, and how it left the bench",
    "`pico run --unattended`", "how a run that was killed has to leave the bench",
    "shut lasers and lamps and look at the bench; then " + ASIDE, Format("pico.unattended"),
)  # fmt: skip
ARMED = StateFile(
    BENCH + "armed/LASER.json", "safety", "the arming of a laser: by whom, until when, up to which class",
    "`pico laser arm`", "the arming: the laser stays shut",
    "`pico laser disarm {stem}`, or `rm {path}`; then arm it again", Format("pico.arming"),
)  # fmt: skip
GUARD = StateFile(
    BENCH + "guard.json", "memory", "which process guards which lasers, and what ended their light last",
    "the process that has the links of the bench", "why light was ended last, and whether a guard was killed", "",
    Format("pico.guard"),
)  # fmt: skip
TABLE_LOCK = StateFile(
    BENCH + "table-lock.json", "safety", "which person at the table locked the bench, since when and why",
    "`pico lease lock`", "the lock: remote and unattended work is let in again",
    "look whether somebody works at the table; then `rm {path}`, and `pico lease lock` locks it anew",
    Format("pico.table-lock"),
)  # fmt: skip
LOCK = StateFile(
    BENCH + "lock", "safety", "the kernel's lock of the bench, and the last token that was given out",
    "the process that takes the bench",
    "the token: the next one is taken from the clock, above all that were given", "", text="text",
)  # fmt: skip
UNATTENDED_LOCK = StateFile(
    BENCH + "unattended.lock", "process",
    "the kernel's lock of the process that holds a run to its terms, and these terms until the run is over",
    "`pico run --unattended`", "", "", text="JSON, or empty",
)  # fmt: skip

# of a bench: what happened there

JOURNAL = StateFile(
    BENCH + "journal.sqlite", "record", "every run and operation of the bench, before and after it happened",
    "the edge", "runs that no commit has, what a hand holds on a real bench, and which axes are known",
    "`pico doctor --journal` makes a new one of what is intact and of what commits hold", code="journal",
    text="SQLite, version 5",
)  # fmt: skip
OWN_LAB = StateFile(
    BENCH + "lab.json", "record", "the Lab that the bench adopted, with its component types", "`pico bench update`",
    "what the bench was adopted as; it has to be adopted anew",
    "`pico bench update` shows what the working tree describes, and lets the bench adopt that",
    Format("pico.bench-lab"), code="bench-lab", keeps_newer=True,
)  # fmt: skip
MORNINGS = StateFile(
    BENCH + "mornings.json", "record", "the mornings that count as good, for later ones to be compared with",
    "`pico morning`", "the references: the next morning is the first", ASIDE + "; the next morning is then the first",
    Format("pico.mornings"), code="morning",
)  # fmt: skip
RECIPE_LOG = StateFile(
    BENCH + "recipes/RUN.jsonl", "record", "what a run of a recipe has done, line by line", "`pico run`",
    "`pico run --resume` of that run; what it did is in the journal",
    ASIDE + ", and begin the recipe anew: what it did is in the runs of the bench", code="recipe-log",
    text="JSON lines, pico.recipe_run/v1",
)  # fmt: skip
RECIPE_LINES = StateFile(
    BENCH + "recipes/RUN.lines", "process", "how many lines the log of a run has, to notice one that lost its end",
    "`pico run`", "", "", text="text",
)  # fmt: skip
RECIPE_OUTPUT = StateFile(
    BENCH + "recipes/RUN.out", "record", "what a detached run of a recipe said", "`pico run --detach`",
    "what it said", "", text="text",
)  # fmt: skip
RECIPE_PROCESS = StateFile(
    BENCH + "recipes/RUN.pid", "process", "the process of a detached run of a recipe", "`pico run --detach`", "", "",
    text="text",
)  # fmt: skip
POINTS = StateFile(
    BENCH + "points/KEY.jsonl", "process", "what a search has tried so far, for one that is killed", "`pico optimize`",
    "", "", text="JSON lines",
)  # fmt: skip
CALLED = StateFile(
    BENCH + "called.json", "process", "the command that was approved last, until it ends",
    "every command that moves the bench", "", "",
)  # fmt: skip
CHANGE_COUNT = StateFile(
    BENCH + "changes", "process", "how many changes the journal has had, to notice one that lost its end", "the edge",
    "", "", text="text",
)  # fmt: skip
RUN_MARK = StateFile(
    BENCH + "run", "process", "the run that has begun and not ended", "the edge", "", "", text="text",
)  # fmt: skip

# of a bench: what the next look finds again

SEEN = StateFile(
    BENCH + "seen.json", "memory", "where parts were last, for those that something hides", "every look",
    "where hidden parts stand, until a camera sees them", "", Format("pico.seen"),
)  # fmt: skip
HANDS = StateFile(
    BENCH + "hands.json", "memory", "which part each hand took, and where in the hand it is", "every pick",
    "how a part lies in the hand; the journal knows which part it is", "", Format("pico.hands"),
)  # fmt: skip
SETTINGS = StateFile(
    BENCH + "settings.json", "record", "set-points that devices do not keep themselves, such as exposures",
    "`pico set`, `pico apply` on a bench with devices", "these set-points: they count as at power-up, or unknown",
    ASIDE + "; then set the values again with `pico apply`",
)  # fmt: skip
DEVICES = StateFile(
    BENCH + "devices.json", "record", "the same for the emulated devices", "the emulated bench",
    "these set-points", ASIDE + "; then set the values again with `pico apply`",
)  # fmt: skip

CALIBRATING = StateFile(
    BENCH + "calibrating.json", "memory", "what a calibration under way has found: corners of the board, lenses",
    "`pico calibrate` on a bench with devices", "the pictures of the board: they are taken again", "",
    Format("pico.calibrating"),
)  # fmt: skip
CALIBRATION_PICTURES = StateFile(
    BENCH + "calibrating/**", "memory", "a picture of each step of a calibration, to look at",
    "`pico calibrate` on a bench with devices", "these pictures", "", text="PNG",
)  # fmt: skip

# of the simulated and the emulated bench

WORLD = StateFile(
    BENCH + "world.json", "record", "the simulated table itself", "the simulator",
    "where the simulated parts stand", "`pico sim reset` starts the simulated table over, with every part at home",
    Format("pico.world"), code="world-file",
)  # fmt: skip
FAULTS = StateFile(
    BENCH + "faults.json", "record", "the faults that the simulator injects", "`pico sim faults`",
    "which faults were asked for", "`pico sim faults off` writes it anew", code="faults-file",
)  # fmt: skip

# of a bench of a coordinator

ENROLMENT = StateFile(
    BENCH + "enrolment.json", "safety", "the coordinator that alone grants the bench, and the key of the edge",
    "`pico edge enrol`", "the enrolment: the bench has to enrol once more", "`pico edge enrol` writes it anew",
    code="enrolment",
)  # fmt: skip
GATE = StateFile(
    BENCH + "gate.sqlite", "safety", "the highest token that the edge let through, and what became of each command",
    "`pico edge`", "which commands were carried out: the next lease begins anew",
    ASIDE + "; the next lease begins it anew", code="gate", text="SQLite, version 1",
)  # fmt: skip
EDGE = StateFile(
    BENCH + "edge.json", "process", "the socket of the process that serves the bench",
    "`pico edge`, `pico gui`", "", "",
)  # fmt: skip
SESSION = StateFile(
    "benches/HOST/LAB/BENCH/session", "memory", "by what a coordinator knows this checkout",
    "the first command to a bench of a coordinator", "the lease that this checkout has there, if any", "", text="text",
)  # fmt: skip
RUNS_BEGUN = StateFile(
    "benches/HOST/LAB/BENCH/runs", "memory", "the runs that this checkout began there, for its next commit",
    "every run at a coordinator", "which of the runs there `pico commit` takes along", "", text="text",
)  # fmt: skip
DETACHED = StateFile(
    "benches/HOST/LAB/BENCH/detached", "memory", "the recipes that this checkout left to the coordinator",
    "`pico run --detach`", "which they are: `pico runs list` shows their runs", "", text="text",
)  # fmt: skip

# of a bench that was moved or set aside

REPLACED = StateFile(
    BENCH + "replaced/**", "record", "what a worktree had of a bench before `pico git attach` brought another one",
    "`pico git attach`", "that older state, which nothing reads", "", text="folder",
)  # fmt: skip
INCOMING = StateFile(
    BENCH + "incoming/**", "process", "a bench on its way here", "`pico git attach`", "", "", text="folder",
)  # fmt: skip
DAMAGED = StateFile(
    "**.damaged**", "record", "a file that was damaged and set aside", "`pico doctor --journal`, a person",
    "the damaged file, which nothing reads", "", text="as it was",
)  # fmt: skip

# of the lab

IGNORE = StateFile(
    ".gitignore", "memory", "keeps Git away from the folder", "PICO, with the folder", "", "", text="text",
)  # fmt: skip
CHOSEN = StateFile(
    "chosen.json", "record", "the bench that commands mean if they name none", "`pico bench use`",
    "the choice: commands mean the default again", "`pico bench use sim` writes it anew",
    Format("pico.chosen-bench"), code="chosen-bench",
)  # fmt: skip
AUDIT = StateFile(
    "audit.json", "cache", "verdicts of the beam audit, by digest of lab and state", "`pico plan`", "", "",
)  # fmt: skip
CLAIMS = StateFile(
    "claims.json", "cache", "claims that tolerances do not support, by digest of lab and state", "`pico plan`", "", "",
)  # fmt: skip
LAYOUT = StateFile(
    "benches/layout.json", "record", "what was done when one folder was split into one for each bench",
    "the first command of a newer PICO", "which runs belong to no bench",
    ASIDE + ", if no `.pico/journal.sqlite` lies beside `benches`", Format("pico.benches-layout"), code="old-layout",
)  # fmt: skip
UNSORTED = StateFile(
    "unsorted/**", "record", "runs of an earlier PICO whose bench is unclear", "the first command of a newer PICO",
    "these runs", "", text="folder",
)  # fmt: skip
EARLIER = StateFile(
    "earlier-N/**", "record", "what an earlier PICO wrote after the benches had folders of their own",
    "an earlier PICO",
    "its runs", "", text="folder",
)  # fmt: skip
SPLITTING = StateFile(
    "splitting/**", "process", "folders for the benches while they are made",
    "the first command of a newer PICO", "", "",
    text="folder",
)  # fmt: skip
SPLIT_LOCK = StateFile(
    "split.lock", "process", "the lock of who makes these folders", "the first command of a newer PICO", "", "",
    text="empty",
)  # fmt: skip
DATA = StateFile(
    "cas/**", "record", "pictures and arrays of runs by their SHA-256, for a lab outside Git", "every measurement",
    "large data of runs that is in no remote", "`pico data fsck` names what is damaged, `pico pull` brings it back",
    text="folder",
)  # fmt: skip
PAGE = StateFile(
    "gui/**", "record", "the books of `pico gui`: leases, people, runs of its desk", "`pico gui`",
    "who logged in, and what desks said", ASIDE + "; `pico gui` makes them anew", text="folder",
)  # fmt: skip

# in Git's own folder, which all worktrees share

RECORD = StateFile(
    ".git/pico/bench.json", "safety", "which worktree has which bench", "the first command that moves a bench",
    "which worktree it is: the first one that moves the bench takes it",
    ASIDE + "; then `pico git attach` in the worktree that has the bench", code="folder",
)  # fmt: skip
RECORD_LOCK = StateFile(
    ".git/pico/bench.lock", "process", "the lock of who changes that", "the first command that moves a bench", "", "",
    code="folder", text="empty",
)  # fmt: skip
SEALS = StateFile(
    ".git/pico/labs.json", "safety", "the SHA-256 of the Lab that each bench adopted", "`pico bench update`",
    "by what a bench knows that its Lab is the one that it adopted",
    ASIDE + "; then `pico bench update` adopts the Lab anew", code="bench-lab",
)  # fmt: skip
ARMED_SEAL = StateFile(
    ".git/pico/armed/DIGEST", "safety", "the SHA-256 of an arming", "`pico laser arm`",
    "the arming: the laser stays shut", "`rm {path}`; then arm the laser again", text="text",
)  # fmt: skip
REMOTES = StateFile(
    ".git/pico/[LAB-]/remotes.json", "record", "the coordinators that the checkout knows by name", "`pico remote add`",
    "their names and addresses", ASIDE + "; then `pico remote add NAME URL`", code="remote",
)  # fmt: skip
PAGE_LOCK = StateFile(
    ".git/pico/[LAB-]/gui.lock", "process", "the lock of `pico gui`", "`pico gui`", "", "", code="remote", text="empty",
)  # fmt: skip

GIT_CACHES = StateFile(
    ".git/pico/CACHE.sqlite", "cache", "what `pico blame`, `pico log` and `pico runs` read of commits before",
    "these commands", "", "", text="SQLite",
)  # fmt: skip
GIT_DATA = StateFile(
    ".git/pico/cas/**", "record", "pictures and arrays of runs by their SHA-256", "every measurement",
    "large data of runs that is in no remote", "`pico data fsck` names what is damaged, `pico pull` brings it back",
    text="folder",
)  # fmt: skip
GIT_LOCK = StateFile(
    ".git/pico/write.lock", "process", "the lock of who commits", "`pico commit`, `pico checkout`", "", "",
    code="folder", text="text",
)  # fmt: skip
GIT_MESSAGE = StateFile(
    ".git/pico/COMMIT_EDITMSG", "process", "a message while it is edited", "`pico commit -e`", "", "", text="text",
)  # fmt: skip

ALL = (
    DAMAGED, HOLDER, STOP, DOSE, UNATTENDED, ARMED, GUARD, TABLE_LOCK, LOCK, UNATTENDED_LOCK, JOURNAL, OWN_LAB,
    MORNINGS,
    RECIPE_LOG, RECIPE_LINES, RECIPE_OUTPUT, CHANGE_COUNT,
    RECIPE_PROCESS, POINTS, CALLED, RUN_MARK, SEEN, HANDS, SETTINGS, DEVICES, CALIBRATING,
    CALIBRATION_PICTURES, WORLD, FAULTS, ENROLMENT, GATE, EDGE,
    SESSION, RUNS_BEGUN, DETACHED, REPLACED, INCOMING, IGNORE, CHOSEN, AUDIT, CLAIMS, LAYOUT, UNSORTED,
    EARLIER, SPLITTING, SPLIT_LOCK, DATA, PAGE, RECORD, RECORD_LOCK, SEALS, ARMED_SEAL, REMOTES, PAGE_LOCK,
    GIT_CACHES, GIT_DATA, GIT_LOCK, GIT_MESSAGE,
)  # fmt: skip


def entry_of(path: str) -> StateFile | None:
    """Return the entry of a file by its path below `.pico`, or below the folder above Git's own (`.git/pico/...`); None
    for a file that PICO does not keep."""
    plain = re.sub(r"-(wal|shm|journal)$", "", path)  # what SQLite has beside a database
    return next((file for file in ALL if _pattern(file.pattern).fullmatch(plain)), None)


@cache
def _pattern(pattern: str) -> re.Pattern[str]:
    text = re.escape(pattern).replace(r"\*\*", ".*").replace(r"earlier\-N", r"earlier-[0-9]+")
    text = re.sub(r"\\\[[A-Z]+\\?-\\\]/", r"(?:[^/]+-/)?", text)
    text = text.replace("benches/BENCH/", "benches/[^/]+(?:/[^/]+/[^/]+)?/")  # of this machine, or HOST/LAB/BENCH
    return re.compile(re.sub(r"\b[A-Z]{3,}\b", "[^/]+", text))


def files_below(root: Path) -> Iterator[tuple[Path, str, StateFile | None]]:
    """Yield each file below `.pico` of the lab in `root`: its path, its path below that folder, and its entry. So is
    whatever else lies in the place of a file: a folder, a named pipe, a link."""
    yield from _files(root / ".pico", "")


def files_in_git(common: Path) -> Iterator[tuple[Path, str, StateFile | None]]:
    """Yield each file of PICO in Git's own folder `common` as `files_below` does."""
    yield from _files(common / "pico", ".git/pico/")


def _files(top: Path, before: str) -> Iterator[tuple[Path, str, StateFile | None]]:
    for path in sorted(top.glob("*")):
        name = before + path.name
        entry = entry_of(name)
        is_place_of_file = entry is not None and "**" not in entry.pattern
        if not path.is_dir() or path.is_symlink() or is_place_of_file:
            yield path, name, entry
        else:
            yield from _files(path, f"{name}/")
