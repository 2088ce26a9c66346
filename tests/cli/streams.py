"""Runs commands with each standard output that there can be, in forks of one process; prints how each ended.

    python -m tests.cli.streams < commands.json

Reads a list of pairs: an output and a command's words. Prints a list of ends: output, words, exit code, errors.
"""

import io
import json
import os
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable
from typing import IO

import automotive_cosim.agents
import automotive_cosim.drives.families
import automotive_cosim.publish.verify
import automotive_cosim.report.evaluation
import automotive_cosim.run.rerun
import automotive_cosim.serve.server
import automotive_cosim.tasks  # noqa: F401, all before the forks
from automotive_cosim.cli.main import main


def _closed() -> None:
    os.close(1)
    sys.stdout = None


def _opened(number: int, encoding: str = "utf-8", errors: str = "strict") -> None:
    os.dup2(number, 1)
    sys.stdout = io.TextIOWrapper(io.FileIO(1, "w", closefd=False), encoding=encoding, errors=errors)


def _full() -> None:
    _opened(os.open("/dev/full", os.O_WRONLY))


def _without_reader() -> None:
    read, write = os.pipe()
    os.close(read)
    _opened(write)


def _ascii() -> None:
    _opened(os.open(os.devnull, os.O_WRONLY), "ascii", "surrogateescape")


MOST_S = 20
"""A command that takes longer is ended: code -14."""
OUTPUTS: dict[str, Callable[[], None]] = {
    "closed": _closed,
    "full": _full,
    "without a reader": _without_reader,
    "ascii": _ascii,
}


def _child(words: list[str], output: str, told: IO[bytes]) -> None:
    os.dup2(told.fileno(), 2)
    sys.stderr = io.TextIOWrapper(io.FileIO(2, "w", closefd=False), write_through=True)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    OUTPUTS[output]()
    sys.argv = ["automotive-cosim", *words]
    signal.alarm(MOST_S)
    code = 1
    try:
        main()
    except SystemExit as end:
        code = int(end.code or 0)
    except BaseException:
        traceback.print_exc()
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError as error:  # as the interpreter says when it ends
        print(f"Traceback: not flushed: {error}", file=sys.stderr)
    sys.stderr.flush()
    os._exit(code)


def _end(words: list[str], output: str) -> tuple[int, str]:
    with tempfile.TemporaryFile() as told:
        child = os.fork()
        if child == 0:
            _child(words, output, told)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        told.seek(0)
        return code, told.read().decode("utf-8", "replace")


if __name__ == "__main__":
    asked = json.loads(sys.stdin.read())
    print(json.dumps([[output, words, *_end(words, output)] for output, words in asked]))
