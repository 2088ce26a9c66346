"""The console script ``automotive-cosim``: Ctrl-C while the command line still loads ends it in silence.

It stands beside the package because importing anything in the package imports gymnasium first, which takes a while.
"""

from __future__ import annotations

import signal


def main() -> None:
    """Loads the command line, gives Ctrl-C back to it, and runs it."""
    heard = signal.getsignal(signal.SIGINT)
    if heard is signal.default_int_handler:  # where it is ignored from the start it stays ignored
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from automotive_cosim.cli.main import main as run

    if heard is signal.default_int_handler:
        signal.signal(signal.SIGINT, heard)
    run()
