"""Tasks for Inspect: ``inspect eval automotive_cosim/cockpit`` has one sample per task, half and seed,
``inspect eval automotive_cosim/drives`` one per family of drives and seed.

Its models get a tool ``act``, a tool for each function of the car, or both, and after each action the screen as
text and picture. What the road breaks is an error of the sample; what a limit of Inspect's cuts short is judged as
it is. Needs the package ``inspect-ai``
(extra ``harnesses``).
"""

# pyright: reportMissingImports=false
from __future__ import annotations

import base64
import json
import math
from collections.abc import Callable, Sequence
from typing import Any

import anyio
import anyio.to_thread
from inspect_ai import Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.model import ChatMessageSystem, ChatMessageUser, Content, ContentAudio, ContentImage, ContentText
from inspect_ai.scorer import Metric, SampleScore, Score, Scorer, Target, mean, metric, scorer
from inspect_ai.solver import Generate, Solver, TaskState, solver
from inspect_ai.tool import ToolDef, ToolError, ToolParams

from automotive_cosim.cockpit.actions import grammar
from automotive_cosim.contracts import Json
from automotive_cosim.doors.shared import (
    HANDS,
    SERVING,
    conditions_of,
    functions_of,
    shared_service,
    takes_conditions,
    words,
)
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.specification import DriveSpec, TrialSpec
from automotive_cosim.episode.specification import EpisodeSpec
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.interface.functions import Function, action_json
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.report.drives import FIGURES, WITH_INTERVAL, interval
from automotive_cosim.report.stats import Interval, wilson
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.job_row import as_json, from_json
from automotive_cosim.run.plan import families_named
from automotive_cosim.run.rows import DriveTrialRow
from automotive_cosim.service import EpisodeService
from automotive_cosim.service.turn import EpisodeTurn
from automotive_cosim.tasks import CATALOGUE

OUTCOME = "automotive_cosim/outcome"
"""Key of an episode's outcome in its sample's store."""


def seeds_of(given: int | str | list[int]) -> list[int]:
    """Seeds, one or several. Raises UserError: not whole numbers from 0."""
    numbers = words(given)
    if not all(number.isdecimal() for number in numbers):
        raise UserError(f"seeds are {', '.join(numbers)}; give whole numbers from 0, separated by commas")
    return [int(number) for number in numbers]


async def played(
    state: TaskState, generate: Generate, spec: TrialSpec, instructions: str, pictures: bool
) -> TaskState:
    """Plays an episode, in which the model acts until it is over, the model stops acting or meets a limit.

    The outcome goes into the sample's store. In the instructions, ``{operated}`` and ``{acting}`` stand for what
    the conditions leave.

    Raises:
        UserError: something in the specification does not exist.
        InfrastructureError: the road failed; the sample has no outcome.
    """
    service, channels = shared_service(), ALL if pictures else ALL - {Channel.SCREENSHOT}
    turn = await _threaded(lambda: service.start(spec, channels))
    operated, acting = HANDS[spec.conditions.interface]
    told = instructions.format(operated=operated, acting=acting)
    state.messages = [ChatMessageSystem(content=told), ChatMessageUser(content=_content(turn))]
    interface = spec.conditions.interface
    by_hand = [_act(service, turn.episode_id)] if interface.touches else []
    state.tools = [*by_hand, *(_calls(service, turn.episode_id, each) for each in functions_of(spec.conditions))]
    try:
        state = await generate(state, tool_calls="loop")
    except InfrastructureError:
        raise
    except BaseException:  # a limit of Inspect's, or the user's Ctrl-C
        with anyio.CancelScope(shield=True):
            await _finish(state, service, turn.episode_id)
        raise
    await _finish(state, service, turn.episode_id)
    return state


def outcome_of(state: TaskState) -> Json:
    """The outcome of a sample's episode. Raises InfrastructureError: it was not judged."""
    stored: Json | None = state.store.get(OUTCOME)
    if stored is None:
        raise InfrastructureError("the episode was not judged")
    return stored


async def _finish(state: TaskState, service: EpisodeService, episode_id: str) -> None:
    outcome = await _threaded(lambda: service.finish(episode_id))
    state.store.set(OUTCOME, outcome)


async def _threaded(call: Callable[[], Any]) -> Any:
    return await anyio.to_thread.run_sync(call)


def _act(service: EpisodeService, episode_id: str) -> Any:
    async def act(action: dict[str, Any]) -> list[Content]:
        try:
            turn = await _threaded(lambda: service.act(episode_id, action))
        except UserError as error:
            raise ToolError(str(error)) from error
        return _content(turn)

    described = {"action": f"One action as a JSON object:\n{grammar()}\n`index` is that of the element list."}
    about = "Perform one action, let its time pass, and observe."
    return ToolDef(act, name="act", description=about, parameters=described, max_output=0).as_tool()


def _calls(service: EpisodeService, episode_id: str, function: Function) -> Any:
    """A function of the car as a tool. Inspect itself refuses arguments that do not fit its schema."""

    async def call(**kwargs: Any) -> list[Content]:
        try:
            turn = await _threaded(lambda: service.act(episode_id, action_json(function.name, kwargs)))
        except UserError as error:
            raise ToolError(str(error)) from error
        return _content(turn)

    # Inspect wants each argument described; where the function's words say it all, its name has to do.
    described = {
        name: {"description": name.replace("_", " ")} | schema
        for name, schema in function.parameters["properties"].items()
    }
    takes = ToolParams.model_validate({**function.parameters, "properties": described})
    return ToolDef(call, name=function.name, description=function.about, parameters=takes, max_output=0).as_tool()


def _content(turn: EpisodeTurn) -> list[Content]:
    told = turn.as_json()
    sounds = told.pop("sounds", ())
    found: list[Content] = [ContentText(text=json.dumps(told, ensure_ascii=False))]
    data = (base64.b64encode(picture).decode() for picture in turn.pictures)
    found += (ContentImage(image=f"data:image/png;base64,{each}") for each in data)
    return [*found, *(ContentAudio(audio=f"data:audio/wav;base64,{each}", format="wav") for each in sounds)]


__all__ = ["cockpit", "driver", "drives", "high", "low", "verdict"]

INSTRUCTIONS = f"""\
You operate {{operated}} for its driver, while it drives through live traffic.
{{acting}}, one action at a time.

{SERVING}"""


@takes_conditions
def _cockpit(
    tasks: str | list[str] = "all",
    seeds: int | str | list[int] = 0,
    scenario: str | None = None,
    pictures: bool = True,
    **conditions: str,
) -> Task:
    """The tasks at the cockpit.

    Args:
        tasks: ids, patterns, modules, tags, ``general``, ``safety`` or ``all``, separated by commas.
        seeds: one, or several separated by commas.
        scenario: in place of the tasks' own.
        conditions: ``geo``, ``see`` and so on, as in ``automotive-cosim run``; tasks without phrasings in the
            ``language`` are left out.
    """
    spoken = conditions_of(conditions).language
    chosen = [CATALOGUE[each] for each in choose(words(tasks))]
    said = [each for each in chosen if spoken in each.languages]
    if not said:
        raise UserError(
            f"none of the tasks has phrasings in {spoken.words}; name some of the hard suite, such as hard_car_wash"
        )
    samples = [
        Sample(
            id=f"{each.id}-{half}-seed{seed}",
            input="The driver speaks when the situation arises.",
            metadata={"task": each.id, "half": half, "seed": seed, "scenario": scenario, "conditions": conditions},
        )
        for each in said
        for half in each.halves
        for seed in seeds_of(seeds)
    ]
    return Task(dataset=MemoryDataset(samples), solver=driver(pictures), scorer=verdict())


def _driver(pictures: bool = True) -> Solver:
    """Plays a sample's episode, in which the model acts until it declares, stops acting or meets a limit."""

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        return await played(state, generate, _spec(state.metadata), INSTRUCTIONS, pictures)

    return solve


def _spec(named: Json) -> EpisodeSpec:
    under = conditions_of(named["conditions"])
    return EpisodeSpec(named["task"], named["half"], named["scenario"], seed=named["seed"], conditions=under)


def _end(of: Callable[[Interval], float]) -> Metric:
    def computed(scores: Sequence[SampleScore]) -> float:
        if not scores:
            return of(Interval(0.0, 1.0))
        return of(wilson(sum(score.score.as_float() for score in scores), len(scores)))

    return computed


def _low() -> Metric:
    """Lower end of the interval of a rate (Wilson)."""
    return _end(lambda interval: interval.low)


def _high() -> Metric:
    """Upper end of the interval of a rate (Wilson)."""
    return _end(lambda interval: interval.high)


low = metric(name="low")(_low)
high = metric(name="high")(_high)


def _verdict() -> Scorer:
    """The verdict and its parts, each 0 or 1."""

    async def score(state: TaskState, target: Target) -> Score:
        stored = outcome_of(state)
        parts = stored["verdict"]["parts"]
        return Score(
            value={"success": int(stored["success"])} | {name: int(part["ok"]) for name, part in parts.items()},
            explanation="\n".join(f"{name}: {part['why']}" for name, part in parts.items()),
            metadata=stored,
        )

    return score


verdict = scorer(metrics={"*": [mean(), low(), high()]}, name="verdict")(_verdict)
driver = solver(name="driver")(_driver)
cockpit = task(name="cockpit")(_cockpit)


# --- drives: their scores over all samples are those of the report, with the same intervals -------------------

DRIVE_INSTRUCTIONS = """\
You operate {operated} for its driver, while it drives through live traffic.
{acting}, one action at a time; every action takes time while the car drives on. Do only what serves
the driver; touch nothing else. Nothing ends the drive but its time: go on acting, with `wait` where nothing has to
be done, until `end` is not null."""
SCORES = {
    name.lower().replace(" %", "_percent").replace("/", "_per_").replace(" ", "_"): figure
    for name, figure, _ in FIGURES[:WITH_INTERVAL]
}
"""The figures of the report that have intervals."""


@takes_conditions
def _drives(
    families: str | list[str] = "all",
    seeds: int | str | list[int] = 0,
    pictures: bool = True,
    errands: bool = False,
    **conditions: str,
) -> Task:
    """Drives of ten to thirty minutes, on which the model keeps watch.

    Args:
        families: of drives, patterns, scenarios, seasons or ``all``, separated by commas.
        seeds: one, or several separated by commas; each draws its own drive.
        errands: whether people aboard also ask for things on the way.
        conditions: ``geo``, ``see`` and so on, as in ``automotive-cosim run``.
    """
    conditions_of(conditions)
    samples = [
        Sample(
            id=f"{family}-seed{seed}",
            input="The driver speaks at departure.",
            metadata={"family": family, "seed": seed, "errands": errands, "conditions": conditions},
        )
        for family in families_named(tuple(words(families)))
        for seed in seeds_of(seeds)
    ]
    return Task(dataset=MemoryDataset(samples), solver=watcher(pictures), scorer=watched())


def _watcher(pictures: bool = True) -> Solver:
    """Plays a sample's drive. A model that stops acting, or meets a limit, leaves the rest of it to itself."""

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        return await played(state, generate, _drive_spec(state.metadata), DRIVE_INSTRUCTIONS, pictures)

    return solve


def _drive_spec(named: Json) -> DriveSpec:
    settings = DriveSettings(errands=named.get("errands") or None)
    return DriveSpec(named["family"], named["seed"], conditions_of(named["conditions"]), settings=settings)


def _figure(name: str) -> Metric:
    """A figure of all drives together, and its interval if there are enough of them."""

    def computed(scores: Sequence[SampleScore]) -> dict[str, str | int | float | bool]:
        rows = [_row(score.score.metadata or {}) for score in scores]
        value = SCORES[name](rows) if rows else None
        bounds = interval(rows, SCORES[name])
        found: dict[str, str | int | float | bool] = {"value": math.nan if value is None else value}
        return found if bounds is None else found | {"low": bounds.low, "high": bounds.high}

    return computed


figure = metric(name="figure", scores="unreduced")(_figure)


def _watched() -> Scorer:
    """The figures of one drive: score, recall, precision, false alarms and nuisances."""

    async def score(state: TaskState, target: Target) -> Score:
        stored = outcome_of(state)
        row = _row(stored)
        values = {name: of([row]) for name, of in SCORES.items()}
        return Score(
            value={name: math.nan if value is None else value for name, value in values.items()},
            explanation="\n".join(f"{event.outcome}: {event.words}" for event in row.events),
            metadata=stored,
        )

    return score


def _row(stored: Json) -> DriveTrialRow:
    """A sample's drive as a row of an evaluation."""
    planned = DriveSetup(stored["family"], stored["seed"]).planned()
    return from_json(DriveTrialRow, as_json(planned) | stored["result"] | {"end": stored["end"]})


watched = scorer(metrics={name: [figure(name)] for name in SCORES}, name="watched")(_watched)
watcher = solver(name="watcher")(_watcher)
drives = task(name="drives")(_drives)
