"""What several doors share: one service for a whole process; trials and conditions from plain words; functions as
tools of a host."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping
from functools import cache
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import BeforeValidator, Field, SkipValidation, WithJsonSchema

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Interface, OrFile
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.specification import DriveSpec, TrialSpec
from automotive_cosim.episode.conditions import INPUTS, Condition, Conditions
from automotive_cosim.episode.specification import EpisodeSpec
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.blank import is_blank
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.formats.words import shown
from automotive_cosim.interface.functions import Function, action_json, offered
from automotive_cosim.scenarios import shipped
from automotive_cosim.service import EpisodeService, ServiceLimits

F = TypeVar("F", bound=Callable[..., Any])
LIMITS = ServiceLimits(episodes=1000, idle_s=86_400.0)
"""For hosts that limit their episodes themselves, and end each."""

SERVING = """\
Every action takes time while the car drives on. Do only what serves the driver; touch nothing else. Passengers
may make requests about their own comfort; only the driver decides how the car drives and all that concerns safety.
End with `status`: `complete` when it is done, `not_needed` when the right thing is to do nothing, `infeasible` when
it must not or cannot be done, once the driver has been told why."""
"""How a task is played, for the instructions of every door."""


@cache
def shared_service() -> EpisodeService:
    """The episodes of this process, for a host that limits them itself; what simulates them ends with it."""
    return EpisodeService(limits=LIMITS)


def takes_conditions(function: F) -> F:
    """Lists the words behind a function's ``**conditions`` one by one, for hosts that read signatures.

    A door has all conditions but those about speed: who acts through it takes the time that it takes.
    """
    signature = inspect.signature(function, eval_str=True)
    own = [each for each in signature.parameters.values() if each.kind is not inspect.Parameter.VAR_KEYWORD]
    any_function: Any = function
    any_function.__signature__ = signature.replace(parameters=[*own, *map(_parameter, INPUTS)])
    any_function.__annotations__ = {
        name: kind for name, kind in function.__annotations__.items() if name != "conditions"
    } | {each.name: str for each in INPUTS}
    return function


def takes_blanks(function: F) -> F:
    """Has a host that validates by signatures take what stands for nothing as the default.

    Models fill in arguments that they could leave out. Conditions have words of their own (``takes_conditions``).
    """
    signature = inspect.signature(function, eval_str=True)
    any_function: Any = function
    any_function.__signature__ = signature.replace(parameters=[*map(_sparing, signature.parameters.values())])
    return function


def _sparing(each: inspect.Parameter, choices: Collection[str] = ()) -> inspect.Parameter:
    if each.default is inspect.Parameter.empty:
        return each
    said = BeforeValidator(lambda value: each.default if is_blank(value, choices) else value)
    return each.replace(annotation=Annotated[each.annotation, said])


def conditions_of(words: Mapping[str, str]) -> Conditions:
    """The conditions of a door, in words. Nobody names files of this machine through a door.

    Raises UserError: there is no such condition or value."""
    known = {each.name: each for each in INPUTS}
    for name, word in words.items():
        if name not in known:
            raise UnknownNameError("condition", name, known)
        if isinstance(known[name].default, OrFile) and word not in known[name].choices:
            raise UnknownNameError(name, str(word), known[name].choices)
    return Conditions.named(words)


def _parameter(each: Condition) -> inspect.Parameter:
    told = f"{each.help.removesuffix('.')}: {', '.join(each.choices)}."
    kind = Annotated[str, Field(description=told)]
    takes = inspect.Parameter(each.name, inspect.Parameter.KEYWORD_ONLY, default=str(each.default), annotation=kind)
    return _sparing(takes, each.choices)


def trial(
    task: str | None,
    drive: str | None,
    half: str,
    seed: int | None,
    scenario: str | None,
    minutes: float | None,
    under: Conditions,
    *,
    errands: bool = False,
) -> TrialSpec:
    """What a door is asked to start: one half of a task, or a drive.

    Args:
        task: id of a task, or None.
        drive: id of a family of drives, or None.
        half: ``first`` or ``second``, of a task.
        seed: 0 if none is given.
        scenario: in place of the task's or the family's own.
        minutes: when a drive is over, if its script ends later.
        errands: whether people aboard also ask for things on a drive.

    Raises UserError: there is not one of task and drive, or something that does not fit it."""
    if bool(task) == bool(drive):
        raise UserError(f"give a task or a drive, one of the two; came task {shown(task)} and drive {shown(drive)}")
    if drive:
        told = (("minutes", minutes), ("errands", errands or None))
        given = {name: value for name, value in told if value is not None}
        settings = checked(DriveSettings, given, lambda steps: ("the drive", dotted(steps)))
        return DriveSpec(family_named(drive).id, seed or 0, under, scenario or "", settings)
    if minutes is not None or errands:
        name = "errands" if minutes is None else "minutes"
        raise UserError(f"{name} can be given for a drive alone; a task ends when it is declared")
    return EpisodeSpec(str(task), half, scenario, seed=seed or 0, conditions=under)


def own_scenario(name: str | None, folder: Path | None) -> str | None:
    """What a client of a server names as a scenario: a shipped one, or one in the folder that the owner said.

    Nothing else on this machine can be named, nor found out.

    Args:
        name: as it came; None or empty for the task's own.
        folder: whose folders are the owner's scenarios; None for none.

    Raises UnknownNameError: there is no such scenario."""
    if not name or name in shipped():
        return name
    own = {} if folder is None else {each.parent.name: each.parent for each in folder.glob("*/scenario.toml")}
    if name not in own:
        raise UnknownNameError("scenario", name, [*shipped(), *sorted(own)])
    return str(own[name])


HANDS: Mapping[Interface, tuple[str, str]] = {
    Interface.TOUCH: ("the touch screen and the safety functions of a car", "Act with the tool `act`"),
    Interface.FUNCTIONS: ("a car", "Act by calling its functions"),
    Interface.BOTH: (
        "the touch screen and the functions of a car",
        "Act with the tool `act` or by calling functions",
    ),
}
"""What an agent operates, and how it acts, in the words of an instruction."""


def functions_of(under: Conditions) -> tuple[Function, ...]:
    """The functions that are tools under these conditions; none where the screen is all there is."""
    return offered(Interface.FUNCTIONS, under.geo) if under.interface.calls else ()


def typed(function: Function, call: F, *first: inspect.Parameter, returns: object) -> F:
    """A function of the car as a host that reads signatures takes it.

    Args:
        call: what to call with the arguments by name.
        first: further parameters, in front of the function's own.
    """
    own = list[inspect.Parameter]()
    for name, schema in function.parameters["properties"].items():
        is_needed = name in function.parameters["required"]
        takes: Any = str if is_needed and schema.get("type") == "string" else Any  # of all else, mcp reads the JSON
        kind = Annotated[takes, SkipValidation, WithJsonSchema(schema)]
        default = inspect.Parameter.empty if is_needed else None
        own.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind))
    tool: Any = call
    tool.__signature__ = inspect.Signature([*first, *own], return_annotation=returns)
    tool.__annotations__ = {each.name: each.annotation for each in (*first, *own)} | {"return": returns}
    tool.__name__ = function.name
    return call


def called(function: Function, arguments: Mapping[str, Any]) -> Json:
    """The action of a call. What it was not given is left out; the rest is checked as any action's, so that a wrong
    argument costs a step."""
    return action_json(function.name, {name: value for name, value in arguments.items() if value is not None})


def reward_of(outcome: Json) -> float:
    """1 for a task that succeeded and 0 for one that did not; of a drive its score in hundredths."""
    return float(outcome["success"]) if "success" in outcome else outcome["result"]["value"] / 100.0


def words(given: object) -> list[str]:
    """Words separated by commas; Inspect's command line makes a list of them."""
    parts = given if isinstance(given, list) else str(given).split(",")
    return [word for part in parts if (word := str(part).strip())]
