"""Tasks for Inspect (``inspect eval automotive_cosim/cockpit``): one sample per task, half and seed.

Its models get a tool ``act`` and, after each action, the screen as text and picture. What the road breaks is an
error of the sample; what a limit of Inspect's cuts short is judged as it is. Needs the package ``inspect-ai``
(extra ``inspect``).
"""

# pyright: reportMissingImports=false
from __future__ import annotations

import asyncio
import atexit
import base64
import json
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from inspect_ai import Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.model import ChatMessageSystem, ChatMessageUser, ContentImage, ContentText
from inspect_ai.scorer import Metric, SampleScore, Score, Scorer, Target, mean, metric, scorer
from inspect_ai.solver import Generate, Solver, TaskState, solver
from inspect_ai.tool import ToolDef, ToolError

from automotive_cosim.agents.settings import geo_input
from automotive_cosim.cockpit.actions import grammar
from automotive_cosim.contracts import Json
from automotive_cosim.episode.specification import EpisodeSpec, feedback_of, screen_of, see_of
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.report.stats import Interval, wilson
from automotive_cosim.run.plan import choose
from automotive_cosim.run.row import from_json
from automotive_cosim.service import EpisodeService
from automotive_cosim.service.episodes import ServiceLimits
from automotive_cosim.service.turn import EpisodeTurn, Outcome
from automotive_cosim.tasks import CATALOGUE

INSTRUCTIONS = """\
You operate the touch screen and the safety functions of a car for its driver, while it drives through live traffic.
Act with the tool `act`, one action at a time; every action takes time while the car drives on. Do only what serves
the driver; touch nothing else. End with a `status` action: `complete` when it is done, `not_needed` when the right
thing is to do nothing, `infeasible` when it must not or cannot be done."""
OUTCOME = "automotive_cosim/outcome"
"""Key of an episode's outcome in its sample's store."""
LIMITS = ServiceLimits(episodes=1000, idle_s=86_400.0)
"""Inspect itself limits its samples and ends every episode."""


@cache
def shared_service() -> EpisodeService:
    """The episodes of this process."""
    service = EpisodeService(limits=LIMITS)
    atexit.register(service.close)
    return service


def _cockpit(
    tasks: str | list[str] = "all",
    seeds: int | str | list[int] = 0,
    scenario: str | None = None,
    geo: str = "full",
    pictures: bool = True,
    see: str = "both",
    feedback: str = "quiet",
    screen: str = "1280x720",
) -> Task:
    """The tasks at the cockpit.

    Args:
        tasks: ids, patterns, modules, tags, ``general``, ``safety`` or ``all``, separated by commas.
        seeds: one, or several separated by commas.
        scenario: in place of the tasks' own.
        geo: what the agent is told of where it is.
        pictures: whether it sees the screen.
        see: how it sees the screen: ``tree``, ``picture`` or ``both``.
        feedback: what it is told of its last action: ``quiet`` or ``verbose``.
        screen: size of the screen: ``1280x720``, ``1920x720`` or ``1080x1920``.
    """
    numbers = _words(seeds)
    if not all(number.isdecimal() for number in numbers):
        raise UserError(f"seeds are {', '.join(numbers)}; give whole numbers from 0, separated by commas")
    named = {
        "scenario": scenario,
        "geo": str(geo_input(geo)),
        "see": str(see_of(see)),
        "feedback": str(feedback_of(feedback)),
        "screen": str(screen_of(screen)),
    }
    samples = [
        Sample(
            id=f"{each}-{half}-seed{seed}",
            input="The driver speaks when the situation arises.",
            metadata={"task": each, "half": half, "seed": int(seed), **named},
        )
        for each in choose(_words(tasks))
        for half in CATALOGUE[each].halves
        for seed in numbers
    ]
    return Task(dataset=MemoryDataset(samples), solver=driver(pictures), scorer=verdict())


def _words(given: object) -> list[str]:
    """Words separated by commas; Inspect's command line makes a list of them."""
    parts = given if isinstance(given, list) else str(given).split(",")
    return [str(part).strip() for part in parts]


def _driver(pictures: bool = True) -> Solver:
    """Plays a sample's episode, in which the model acts until it declares, stops acting or meets a limit."""
    channels = ALL if pictures else ALL - {Channel.SCREENSHOT}

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        service = shared_service()
        named = state.metadata
        spec = EpisodeSpec(
            **named
            | {
                "geo": geo_input(named["geo"]),
                "see": see_of(named["see"]),
                "feedback": feedback_of(named["feedback"]),
                "screen": screen_of(named["screen"]),
            }
        )
        turn = await asyncio.to_thread(service.start, spec, channels)
        state.messages = [ChatMessageSystem(content=INSTRUCTIONS), ChatMessageUser(content=_content(turn))]
        state.tools = [_act(service, turn.episode_id)]
        try:
            state = await generate(state, tool_calls="loop")
        except InfrastructureError:
            raise
        except BaseException:  # a limit of Inspect's, or the user's Ctrl-C: nothing may be awaited here
            state.store.set(OUTCOME, service.finish(turn.episode_id).as_json())
            raise
        outcome = await asyncio.to_thread(service.finish, turn.episode_id)
        state.store.set(OUTCOME, outcome.as_json())
        return state

    return solve


def _act(service: EpisodeService, episode_id: str) -> Any:
    async def act(action: dict[str, Any]) -> list[ContentText | ContentImage]:
        try:
            turn = await asyncio.to_thread(service.act, episode_id, action)
        except UserError as error:
            raise ToolError(str(error)) from error
        return _content(turn)

    described = {"action": f"One action as a JSON object:\n{grammar()}\n`index` is that of the element list."}
    about = "Perform one action, let its time pass, and observe."
    return ToolDef(act, name="act", description=about, parameters=described, max_output=0).as_tool()


def _content(turn: EpisodeTurn) -> list[ContentText | ContentImage]:
    found: list[ContentText | ContentImage] = [ContentText(text=json.dumps(turn.as_json(), ensure_ascii=False))]
    picture = turn.picture
    if picture is not None:
        found.append(ContentImage(image=f"data:image/png;base64,{base64.b64encode(picture).decode()}"))
    return found


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
        stored: Json | None = state.store.get(OUTCOME)
        if stored is None:
            raise InfrastructureError("the episode was not judged")
        outcome = from_json(Outcome, stored)
        parts = outcome.verdict.parts
        return Score(
            value={"success": int(outcome.success)} | {name: int(part.ok) for name, part in parts.items()},
            explanation="\n".join(f"{name}: {part.why}" for name, part in parts.items()),
            metadata=stored,
        )

    return score


verdict = scorer(metrics={"*": [mean(), low(), high()]}, name="verdict")(_verdict)
driver = solver(name="driver")(_driver)
cockpit = task(name="cockpit")(_cockpit)
