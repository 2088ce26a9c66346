"""The console script ``automotive-cosim``: Ctrl-C while the command line still loads ends it in silence.

It stands beside the package because the command line takes a while to import.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
from contextlib import suppress

LOADING = {
    "run": "tasks and agents", "eval": "tasks and agents", "search": "drives",
    "study": "scenarios and agents", "bench": "scenarios", "measures": "drives", "report": "results",
    "compare": "results", "export": "results", "replay": "results", "scenarios calibrate": "counts",
    "scenarios check": "scenarios", "scenarios equilibrate": "scenarios", "scenarios import": "the importer",
    "scenarios render": "scenarios",
}  # fmt: skip
"""What the commands load that would begin with seconds of silence otherwise: more on a busy machine, and the first
of a log. Told before anything else is imported."""

GARBAGE = 10_000
"""Objects after which Python looks for garbage, instead of 700: imports make a hundred thousand that are none."""


def _tell_what_loads(words: list[str]) -> None:
    """Prints one line on standard error, where there is one."""
    given = [word for word in words if word != "--debug"]
    loads = LOADING.get(" ".join(given[:1])) or LOADING.get(" ".join(given[:2]))
    if loads and sys.stderr and not {"-h", "--help"} & set(words):
        with suppress(OSError, ValueError):
            print(f"loading {loads}", file=sys.stderr, flush=True)


def main() -> None:
    """Loads the command line, gives Ctrl-C back to it, and runs it."""
    if sys.getfilesystemencoding() == "ascii" and os.name == "posix":  # names of files would not be text
        os.environ["PYTHONUTF8"] = "1"
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
    if os.name == "nt":
        from automotive_cosim.errors import NO_FORK

        sys.exit(f"error: {NO_FORK}")
    gc.set_threshold(GARBAGE)
    heard = signal.getsignal(signal.SIGINT)
    if heard is signal.default_int_handler:  # where it is ignored from the start it stays ignored
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    _tell_what_loads(sys.argv[1:])
    from automotive_cosim.cli.main import main as run

    if heard is signal.default_int_handler:
        signal.signal(signal.SIGINT, heard)
    run()


if __name__ == "__main__":
    main()
