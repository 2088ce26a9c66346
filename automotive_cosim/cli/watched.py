"""Runs a command in a child, so that the end that the code of somebody else's agent brings about is told.

An agent of one's own lives in the process of ``run``, where it can be debugged. There ``os._exit`` ends everything
without a word, with whatever code it is given, and so does a crash in a library.
"""

from __future__ import annotations

import mmap
import os
import signal
import sys
from collections.abc import Callable

from automotive_cosim.agents.cleanup import end_with_parent, how_it_ended

PASSED_ON = (signal.SIGINT, signal.SIGTERM)
CURSOR = "\x1b[?25h"
"""Shows a terminal's cursor, which a live view may have hidden."""
FROM_TERMINAL = 0x80
"""``si_code`` of a signal that the kernel sent: Ctrl-C reaches the whole group without this process."""
LOST = 2
"""The exit code if it ended without one of its own."""


def watched(work: Callable[[], int]) -> int:
    """The exit code of ``work``, which runs in a child; the parent only waits.

    In the child, this returns when the work is done, and the program ends as it would have."""
    sys.stdout.flush()
    has_ended = mmap.mmap(-1, 1)  # which both see
    waits_for = {*PASSED_ON, signal.SIGCHLD}
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, waits_for)
    child = os.fork()
    if not child:
        end_with_parent()
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        try:
            return work()
        finally:
            has_ended[0] = 1
    while not (ended := os.waitpid(child, os.WNOHANG))[0]:
        told = signal.sigwaitinfo(waits_for)
        if told.si_signo in PASSED_ON and told.si_code != FROM_TERMINAL:
            os.kill(child, told.si_signo)
    signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    code = os.waitstatus_to_exitcode(ended[1])
    if has_ended[0]:
        return code if code >= 0 else 128 - code
    if sys.stdout.isatty():
        os.write(1, CURSOR.encode())
    print(f"error: the agent's code ended the run: {how_it_ended(code)}; what is recorded stays", file=sys.stderr)
    return LOST
