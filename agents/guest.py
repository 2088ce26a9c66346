"""Agents of your own: a class with ``reset(goal)`` and ``act(observation)``, named ``package.module:Class``.

``name``, ``model`` and ``channels`` may be given as attributes; without them the agent has the name of its class
and gets every channel. ``act`` may return an ``Action``, a JSON object or its text. A class with ``step`` instead
of ``act`` is treated as an AndroidWorld agent (``androidworld.py``).
"""

from __future__ import annotations

import ast
import importlib
import inspect
import sys
import traceback
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any, TextIO

from automotive_cosim.agents.androidworld import AndroidWorldAgent
from automotive_cosim.agents.base import Agent
from automotive_cosim.cockpit.actions import check, parse
from automotive_cosim.contracts import Action, Observation
from automotive_cosim.errors import ActionError, OutOfBudgetError, UserError
from automotive_cosim.interface.observe import ALL, Channel

FORM = "package.module:Class"
FAULTS = (Exception, SystemExit)
"""Exceptions that a guest's code may raise; even its ``sys.exit`` must not end this program."""


def aside() -> redirect_stdout[TextIO]:
    """While it lasts, what a guest's code prints goes to standard error: standard output is a command's answer."""
    return redirect_stdout(sys.stderr)


class Guest:
    """A guest agent behind this project's protocol. An error of its own costs it the step and is reported."""

    def __init__(self, agent: Any) -> None:
        """Takes an object that has ``reset`` and ``act``. Raises UserError: its ``channels`` are invalid."""
        self._agent = agent
        self.name = str(getattr(agent, "name", type(agent).__name__))
        self.model = str(getattr(agent, "model", "none"))
        try:
            self.channels = frozenset(Channel(name) for name in getattr(agent, "channels", ALL))
        except (TypeError, ValueError) as error:
            raise UserError(f"agent {self.name!r}: {error}; channels are {', '.join(Channel)}") from error

    def reset(self, goal: str) -> None:
        """Passes the goal on. Raises UserError: the agent raised."""
        try:
            with aside():
                self._agent.reset(goal)
        except FAULTS as error:
            raise UserError(f"agent {self.name!r} raised {told(error)} in reset") from error

    def act(self, observation: Observation) -> Action:
        """Passes the observation on and returns the agent's action.

        Raises:
            ActionError: the agent raised, or returned no action. Only this program's own model client reports a
                model's error, so a ``ModelError`` is a fault like any other.
            OutOfBudgetError: it gives up."""
        try:
            with aside():
                returned = self._agent.act(observation)
        except (ActionError, OutOfBudgetError) as error:
            raise type(error)(_plain(str(error))) from error
        except FAULTS as error:
            raise ActionError(f"agent {self.name!r} raised {told(error)}") from error
        if isinstance(returned, Action):
            return check(returned)
        if isinstance(returned, dict | str):
            return parse(returned)
        raise ActionError(f"agent {self.name!r} returned {type(returned).__name__}; act has to return an Action")


def load(spec: str) -> Agent:
    """An agent of the class ``package.module:Class``, which may be in the working folder.

    Raises UserError: the module or class does not exist, cannot be instantiated, or lacks something."""
    made = own_class(spec, "agent")
    if callable(getattr(made, "step", None)) and not hasattr(made, "act"):
        return AndroidWorldAgent(made)
    missing = [method for method in ("reset(goal)", "act(observation)") if not _has(made, method)]
    if missing:
        raise UserError(f"agent {spec!r} lacks {' and '.join(missing)}; an agent is a class with both")
    for method, given in (("reset", 1), ("act", 1)):
        _check_call(spec, getattr(made, method), method, given)
    return Guest(_made(spec, made))


def classes_in(module_name: str) -> tuple[str, ...]:
    """The agents in a module of the working folder, as ``package.module:Class``, for who forgot the class.

    It is read and not imported. Nothing if there is no such file, or it is not Python."""
    module_name = module_name.removesuffix(".py")
    try:
        code = ast.parse(Path(*module_name.split(".")).with_suffix(".py").read_bytes())
    except (OSError, SyntaxError, ValueError):
        return ()
    return tuple(
        f"{module_name}:{each.name}"
        for each in code.body
        if isinstance(each, ast.ClassDef)
        and any(isinstance(made, ast.FunctionDef) and made.name in {"act", "step"} for made in each.body)
    )


def own_class(spec: str, what: str) -> type:
    """The class ``package.module:Class``, which may be in the working folder.

    Args:
        what: it should be, for errors.

    Raises UserError: there is no such module or class."""
    module_name, _, class_name = spec.partition(":")
    if not module_name or not class_name:
        raise UserError(f"{what} {spec!r} does not have the form {FORM}")
    here = str(Path.cwd())
    if here not in sys.path:
        sys.path.insert(0, here)
    if "/" in module_name:
        file = module_name.rpartition("/")[2].removesuffix(".py")
        raise UserError(f"{what} {spec!r}: run the command in the folder of its file and give {file}:{class_name}")
    if module_name.endswith(".py"):
        raise UserError(f"{what} {spec!r}: omit the .py, as in {module_name.removesuffix('.py')}:{class_name}")
    try:
        with aside():
            module = importlib.import_module(module_name)
    except ImportError as error:
        raise UserError(f"{what} {spec!r}: cannot import {module_name}: {error}") from error
    except FAULTS as error:
        raise UserError(f"{what} {spec!r}: importing {module_name} raised {told(error)}") from error
    try:
        made = getattr(module, class_name)
    except AttributeError:
        classes = sorted(name for name, value in vars(module).items() if inspect.isclass(value))
        raise UserError(
            f"{what} {spec!r}: {module_name} has no {class_name}; it has {', '.join(classes) or 'no class'}"
        ) from None
    if not inspect.isclass(made):
        raise UserError(f"{what} {spec!r} is {type(made).__name__}; {FORM} has to name a class")
    return made


def _has(made: type, method: str) -> bool:
    return callable(getattr(made, method.partition("(")[0], None))


def _check_call(spec: str, method: Callable[..., Any], name: str, given: int) -> None:
    try:
        inspect.signature(method).bind(None, *[None] * given)
    except TypeError as error:
        argument = "goal" if name == "reset" else "observation"
        raise UserError(f"agent {spec!r}: {name} cannot be called as {name}({argument}): {error}") from error
    except ValueError:  # no signature is available, e.g. of a class written in C
        return


def _made(spec: str, made: type) -> Any:
    try:
        with aside():
            return made()
    except FAULTS as error:
        raise UserError(
            f"agent {spec!r}: {made.__name__}() raised {told(error)}; it is called without arguments"
        ) from error


def told(error: BaseException) -> str:
    """What a guest's code raised, in a line, with the last place in its own file on the way there."""
    said = f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"
    _, *beyond = traceback.extract_tb(error.__traceback__)  # the first is this program's call of it
    theirs = [each for each in beyond if "importlib" not in each.filename]
    own = [each for each in theirs if each.filename == theirs[0].filename]
    return _plain(said + (f" ({Path(own[-1].filename).name} line {own[-1].lineno})" if own else ""))


def _plain(text: str) -> str:
    """The text without half surrogate pairs, which no file can hold."""
    return text.encode("utf-8", "replace").decode()
