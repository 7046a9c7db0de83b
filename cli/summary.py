"""The top-level help, answered before anything heavy is imported; a test compares it with the real commands."""

from __future__ import annotations

GROUPS: dict[str, dict[str, str]] = {
    "The main job": {
        "init": "Make a new lab, or an example with its history.",
        "status": "Show what is committed, desired and live, side by side.",
        "plan": "Show what would move to make the bench equal to the manifest or a revision.",
        "apply": "Move what the plan says.",
        "stop": "Stop the run that goes on, from any terminal.",
        "resume": "Take up the last run again, which was interrupted, failed or killed.",
        "undo": "Take everything that the last run moved or set back to where it was before.",
        "recover": "Set down what hands still hold, and settle what only you can know.",
        "checkout": "Go to a revision: files and bench.",
        "explain": "Say why a plan moves what it moves, why in this order, and why not less.",
        "graph": "Show a plan as a graph: what waits for what, and the critical path.",
    },
    "Manifests": {
        "validate": "Check the manifests.",
        "fmt": "Bring manifests into the normal form; comments stay.",
        "capture": "Write what stands on the bench into the manifest.",
        "catalog": "List the component types, or show one.",
        "parts": "List the parts of this bench and where they are.",
    },
    "History": {
        "commit": "Capture the bench and commit.",
        "note": "Note something on a part, or list what was noted on it.",
        "log": "List commits with what each changed on the table.",
        "diff": "Show what differs between two states, as motions.",
        "show": "Show a revision or a saved plan.",
        "blame": "Say for each tunable which commit changed it last, and how.",
        "bisect": "Find which configuration broke an expectation, by trials on the bench.",
        "bisect-step": "Bring the bench to the commit that git bisects and judge it, for `git bisect run`.",
        "verify": "Check that the bench is as the manifest says, and that its expectations hold. Moves nothing.",
        "runs": "List the runs that commits carry, show one, or compare two.",
        "drift": "Show where the bench has left the last commit. Moves nothing.",
        "merge": "Merge another branch, value by value, and check that the result can stand on the table.",
        "check": "Check a change as a pull request: valid, buildable, as expected in the simulator, allowed.",
        "revert": "Take back what a commit changed on the table, in the manifests only.",
        "cherry-pick": "Change on this branch what commits of another one changed on the table, in the manifests only.",
        "push": "Send the large data of runs to where it is kept, then the commits with `git push`.",
        "pull": "Get commits with `git pull`, then the large data of their runs. Moves nothing.",
        "stash": "Shelve the edits of the manifests, or bring them back. The bench is not shelved: nothing moves.",
        "publish": "Write a revision with its runs, measurements, plan and pictures as an RO-Crate, to publish.",
        "watch": "Look at the bench again and again, and tell what leaves the last commit and what comes back.",
    },
    "One operation at a time": {
        "do": "Run one primitive of a component, through the same checks as a plan.",
        "move": "Move a component to a pose or a slot.",
        "rotate": "Turn a component about the vertical.",
        "place": "Place a component a distance after another along the beam.",
        "stow": "Put a component back into its home slot.",
        "set": "Set a tunable.",
        "get": "Read the tunables of a component.",
        "home": "Home the axis of a tunable.",
    },
    "The simulator, and the rest": {
        "sim": "Act on the simulated world: reset it, nudge or remove a component, bump a camera, view it.",
        "render": "Draw the bench: a picture as PNG, or a drawing with its parts list as SVG.",
        "ruler": "Measure between two things on the bench.",
        "scan": "Look at the table through the cameras: where every part is, how surely, and what can't be told.",
        "find": "Show where a part is, as the cameras see it now.",
        "import": "Take what stands on the table and is not in the inventory into it, as the cameras see it.",
        "calibrate": "Find out where the cameras are and how their lenses draw.",
        "markers": "Write the markers of the lab as a PDF, to print and stick on.",
        "data": "Bring the large data of runs to where it is kept, and from there; look after it.",
        "git": "Let git merge manifests by PICO, or not; attach a worktree.",
        "doctor": "Check that git, its merge driver and the manifests are as PICO needs them.",
        "completion": "Print the completion script of a shell; its first line says how to install it.",
        "version": "Show the versions of PICO and what it stands on.",
    },
}

COMMANDS: dict[str, str] = {name: line for group in GROUPS.values() for name, line in group.items()}

MOVERS = (
    "apply", "resume", "undo", "recover", "checkout", "do", "move", "rotate", "place", "stow", "set", "home",
    "bisect start", "bisect run", "bisect continue", "bisect good", "bisect bad", "bisect skip", "bisect-step",
)  # fmt: skip
"""Commands that take the bench: these wait for it with --lock-timeout."""

OPTIONS = {
    "-C DIR": "Work as if started in DIR.",
    "--json": "Answer with JSON.",
    "--debug": "Show the traceback of an internal error.",
    "--backend NAME": "What executes operations: sim (default) or hardware.",
    "--version": "Show the version.",
    "--help": "Show this, or the help of a command.",
}


def help_text() -> str:
    """Return what `pico --help` prints."""
    lines = ["Usage: pico [OPTIONS] COMMAND [ARGS]...", "", "Version control for the optical table.", ""]
    for title, commands in GROUPS.items():
        lines += [f"{title}:", *(f"  {name:<11} {line}" for name, line in commands.items()), ""]
    lines += ["Options, before or after the command:"]
    lines += [f"  {option:<15} {line}" for option, line in OPTIONS.items()]
    return "\n".join(
        [*lines, "", "Start with `pico init --example shel bench`. Help of a command: `pico COMMAND --help`."]
    )
