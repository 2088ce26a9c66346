"""Every error the package raises on purpose, as one tree.

CosimError                 anything a caller may want to catch at once
├── UserError              the user can fix it; the command line prints one line and exits with 2
│   ├── UnknownNameError        no scenario, task, agent, … of that name ("did you mean")
│   ├── ScenarioError      a scenario's files are missing, invalid or contradictory
│   ├── ActionError        an action is malformed (wrong type, missing or extra fields)
│   ├── SignalError        a vehicle signal was given a value it cannot have
│   └── SetupError         the installation lacks something (SUMO's version, system libraries, an extra)
├── InfrastructureError    neither the agent's fault nor the user's: counted apart, never as a failure
│   ├── TrafficError       the simulation refused a call, died, hung or lost the ego without a reason
│   │   └── NoRoomError    the ego waited for a gap in the traffic to depart into, and none came
│   ├── ModelError         a model could not be reached, or did not answer
│   ├── BudgetSpentError   the evaluation may ask its models nothing more: the episode is left for another run
│   └── TriggerNotReachedError  the drive up to the hand-over ended before the task's trigger held
├── OutOfBudgetError       the agent has spent its tokens or its time: the episode is judged as it is
└── AgentError             the agent's side crashed, ended or did not answer: the episode is a failure
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[1]
"""The folder with the package: of an editable installation the checkout, which has its constraints."""

CLOSE = 3
"""At most so many names that contain an unknown one are offered for it."""
SURE = 0.6
"""A name as similar as this goes before those."""
NO_FORK = "simulations are copied by fork, which needs Linux: on Windows use WSL, on macOS a container"
"""What a ``SetupError`` says on other systems."""
FEW = 5
"""Up to this number, all are named rather than one that is only a little similar."""
LISTED = 45
"""An unknown name is answered with the known ones up to this number."""
SHOWN = 80
"""Characters of an unknown name that are repeated."""


class CosimError(Exception):
    """Root of the tree above."""


class UserError(CosimError):
    """An error that the user can fix: what came, what was expected and what to do, one line for each problem."""

    def __str__(self) -> str:
        return "\n".join(map(str, self.args))


class UnknownNameError(UserError):
    """A name that is not in a catalogue.

    Args:
        kind: what was looked for, e.g. ``"scenario"``.
        name: the name that was given.
        known: the names that exist.
        hint: how to list them, e.g. ``"automotive-cosim scenarios list"``.
        whole: whether all of up to ``LISTED`` are named although one is close."""

    def __init__(self, kind: str, name: str, known: Iterable[str], hint: str = "", *, whole: bool = False) -> None:
        choices = sorted(known)
        came = name if len(name) <= SHOWN else name[:SHOWN] + "…"
        close = (
            [each for each in choices if each.casefold() == came.casefold()][:CLOSE]
            or get_close_matches(came, choices, n=1, cutoff=SURE)
            or [each for each in choices if len(came) > 2 and came in each][:CLOSE]
            or (get_close_matches(came, choices, n=1, cutoff=0.5) if len(choices) > FEW else [])
        )
        if close:
            *others, last = (f"'{each}'" for each in close)
            fix = f": did you mean {', '.join(others)}{' or ' * bool(others)}{last}?"
            fix += f" There are: {', '.join(choices)}." if whole and len(choices) <= LISTED else ""
        elif hint and len(choices) > LISTED:
            fix = f" among the {len(choices)}."
        else:
            more = f" and {len(choices) - LISTED} more" if len(choices) > LISTED else ""
            fix = f"; choose from: {', '.join(choices[:LISTED])}{more}." if choices else "; there are none."
        super().__init__(f"no {kind} named {came!r}{fix}" + (f" List them with `{hint}`." if hint else ""))
        self.kind = kind
        self.name = name


class ScenarioError(UserError):
    """A scenario that cannot be run as it is."""


class ActionError(UserError):
    """An action that is not well formed."""


class SignalError(UserError):
    """A value that a vehicle signal cannot have."""


class SetupError(UserError):
    """Something that the installation lacks, with the command that installs it."""


class InfrastructureError(CosimError):
    """The episode says nothing about the agent; it is reported apart and can be run again."""


class TrafficError(InfrastructureError):
    """The traffic simulation failed."""


class NoRoomError(TrafficError):
    """The ego could not depart: its road is full."""


class ModelError(InfrastructureError):
    """A model that could not be reached or did not answer."""


class BudgetSpentError(InfrastructureError):
    """An evaluation that may ask its models nothing more; the episode says nothing about its agent."""


class TriggerNotReachedError(InfrastructureError):
    """The situation that a task waits for did not arise within its time limit."""


class OutOfBudgetError(CosimError):
    """An agent that has spent its budget; this is its own failure."""


class AgentError(CosimError):
    """An agent that can act no more, e.g. because its process has ended; this is its own failure."""


def install_hint(extra: str = "") -> str:
    """The command that installs an extra: from the checkout that this runs from, else from an index.

    Args:
        extra: its name in ``pyproject.toml``; empty for the package alone."""
    if (CHECKOUT / "constraints.txt").is_file():
        return "pip install -c constraints.txt -e " + (f"'.[{extra}]'" if extra else ".")
    return "pip install " + (f"'automotive-cosim[{extra}]'" if extra else "automotive-cosim")
