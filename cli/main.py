"""Entry point of `pico`: answers what needs nothing at once, leaves the rest to `app`."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from .garbage import wait_for_loading


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code (design: `pico.diagnostics.ExitCode`)."""
    if argv is None:
        _speak_utf8()
    words = list(sys.argv[1:] if argv is None else argv)
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # matrices here are small: threads would only wait for another
    if argv is None:
        wait_for_loading()
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by who started it
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_WRONLY), "w", encoding="utf-8"))
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal that can't show ✓ shows ? instead of failing
    at_once = _at_once(words)
    if at_once is None:
        try:
            from .terminal.ending import ended_by_signals

            with ended_by_signals():
                from .app import run

                return run(words)
        except KeyboardInterrupt:  # while it loaded, or while it said that it was interrupted
            return 130
    try:
        print(at_once, flush=True)
    except OSError as exc:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(exc, BrokenPipeError):  # into a file, on a disk that is full
            print(f"pico: standard output: {(exc.strerror or str(exc)).lower()}", file=sys.stderr)
            return 1
    return 0


def _speak_utf8() -> None:
    """Start over in Python's UTF-8 mode if the locale has ASCII alone: manifests, notes and the paths that git names
    are UTF-8, and so is what was typed."""
    if sys.getfilesystemencoding() != "ascii" or sys.flags.utf8_mode:
        return
    os.environ["PYTHONUTF8"] = "1"  # also for whatever this starts
    os.execv(sys.executable, [sys.executable, "-X", "utf8", *sys.orig_argv[1:]])


def _at_once(words: list[str]) -> str | None:
    """Return the answer to `--version`, to the top-level `--help` and to Tab, or None where a command must run."""
    if "_PICO_COMPLETE" in os.environ:
        from .at_once.complete import candidates

        return "\n".join(candidates(words))
    if words in ([], ["--help"], ["-h"], ["help"], ["help", "all"]):
        from .at_once.help import help_text

        return help_text(every=words[1:] == ["all"])
    if words in (["--version"], ["-V"]):
        from pico.version import __version__

        return f"pico {__version__}"
    return None


if __name__ == "__main__":
    sys.exit(main())
