"""What earlier versions called some commands and options: each is answered with its present name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from automotive_cosim.errors import UserError

COMMANDS: Final = {
    "bundle": "publish bundle",
    "context": "show context",
    "functions": "show functions",
    "leaderboard": "publish leaderboard",
    "memory": "show memory",
    "memory show": "show memory",
    "playback": "replay --play",
    "regrade": "publish regrade",
    "schema": "show schema",
    "screens": "show screens",
    "signals": "show signals",
    "signals list": "show signals",
    "signals export": "show signals --vss",
    "study report": "report",
    "validate": "tasks validate",
    "verify": "publish verify",
}
"""Former commands; of two that fit, the longer one counts."""
DRIVES = "modes no longer exist; drives have replaced monitoring: `drive FAMILY`, and `eval --drives all`"
OPTIONS: Final = {
    ("drive", "--list"): "`drive --list` is now `show drives`",
    ("eval", "--mode"): DRIVES,
    ("eval", "--modes"): DRIVES,
    ("run", "--mode"): DRIVES,
    ("run", "--modes"): DRIVES,
    ("scenarios equilibrate", "--draws"): "`--draws 10` is now `--seeds 1-10`",
    ("tasks validate", "--first-seed"): "`--seeds 3 --first-seed 4` is now `--seeds 4-6`",
}
"""Former options of commands."""


def refuse_former(arguments: Sequence[str]) -> None:
    """Answers a former name.

    Args:
        arguments: what follows the program's name on the command line.

    Raises:
        UserError: a command or option has another name now; the error says which.
    """
    first = next((at for at, word in enumerate(arguments) if not word.startswith("-")), len(arguments))
    command, given = arguments[first : first + 2], [word.partition("=")[0] for word in arguments[first:]]
    for known in (" ".join(command), " ".join(command[:1])):
        if known in COMMANDS:
            raise UserError(f"`{known}` is now `{COMMANDS[known]}`")
        for option in given:
            if (known, option) in OPTIONS:
                raise UserError(OPTIONS[known, option])
