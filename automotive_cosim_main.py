"""The console script ``automotive-cosim``: Ctrl-C while the command line still loads ends it in silence.

It stands beside the package because importing anything in the package imports gymnasium first, which takes a while.
"""

from __future__ import annotations

import os
import signal
import sys


def main() -> None:
    """Loads the command line, gives Ctrl-C back to it, and runs it."""
    if sys.getfilesystemencoding() == "ascii" and os.name == "posix":  # names of files would not be text
        os.environ["PYTHONUTF8"] = "1"
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
    heard = signal.getsignal(signal.SIGINT)
    if heard is signal.default_int_handler:  # where it is ignored from the start it stays ignored
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from automotive_cosim.cli.main import main as run

    if heard is signal.default_int_handler:
        signal.signal(signal.SIGINT, heard)
    run()


if __name__ == "__main__":
    main()
