"""An assessment as AgentBeats asks for one: who takes part, what is played, and the result as data.

{"participants": {ROLE: URL}, "config": {...}}  ->  a plan  ->  an evaluation  ->  {"score", ..., "rows"}
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from automotive_cosim import __version__
from automotive_cosim.agents.registry import PREFIX
from automotive_cosim.contracts import Json
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.report.answer import answer
from automotive_cosim.report.consistency import pass_hats
from automotive_cosim.report.results import Contestant, Results, pairs, read_results
from automotive_cosim.report.stats import Rate
from automotive_cosim.report.summary import rate_of
from automotive_cosim.run.plan import Plan, make_plan
from automotive_cosim.run.row import as_json
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.scenarios import shipped

CONFIG = (
    "tasks",
    "suite",
    "scenarios",
    "everywhere",
    "seeds",
    "repeats",
    "held_out",
    "split",
    "limits",
    *(each.name for each in TABLE),
)
"""What an assessment may set of a plan."""
NAMES = ("tasks", "scenarios")
DEFAULTS: Json = {"interface": ["functions"], "see": ["nothing"]}
"""How agents of CAR-bench's contract are played unless the assessment says otherwise."""
MOST_RUNS = 100_000
"""Of one assessment, counted before it is unfolded."""
MOST_PARTICIPANTS, MOST_WORDS = 32, 1000
"""Of one assessment: agents, and names of tasks and scenarios."""


@dataclass(frozen=True, slots=True)
class Assessment:
    """What was asked for."""

    participants: Mapping[str, str]
    """Addresses by role."""
    plan: Plan


def read_assessment(text: str) -> Assessment:
    """Reads an assessment request: AgentBeats' form, or CAR-bench's with ``agent_under_test``.

    Raises UserError: it is none, or its plan cannot be run."""
    try:
        asked = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UserError(f"the assessment request is not JSON ({error}); {FORM}") from error
    if not isinstance(asked, dict):
        raise UserError(f"the assessment request is no JSON object; {FORM}")
    named = asked.get("participants")
    if named is None and "agent_under_test" in asked:
        named = {"agent_under_test": asked["agent_under_test"]}
    if not isinstance(named, dict) or not named or not all(isinstance(url, str) for url in named.values()):
        raise UserError(f"the assessment request names no participants; {FORM}")
    config = {} if asked.get("config") is None else asked["config"]
    if not isinstance(config, dict):
        raise UserError(f"the config of the assessment request is no JSON object; {FORM}")
    for name in config:
        if name not in CONFIG:
            raise UnknownNameError("setting of an assessment", name, CONFIG)
    if len(named) > MOST_PARTICIPANTS or sum(map(_length, (config.get(name) for name in NAMES))) > MOST_WORDS:
        most = f"{MOST_PARTICIPANTS} participants and {MOST_WORDS:,} names of tasks and scenarios"
        raise UserError(f"the assessment has too many names; at most {most} are allowed")
    values = {name: _whole(value) for name, value in config.items()}
    participants = {str(role): url.rstrip("/") for role, url in named.items()}
    plan = make_plan({**DEFAULTS, **values, "agents": [PREFIX + url for url in participants.values()]})
    for name in plan.scenarios:
        if name not in shipped():  # no folder of this machine
            raise UnknownNameError("scenario", name, shipped(), "automotive-cosim scenarios list")
    if (count := plan.most_runs()) > MOST_RUNS:
        raise UserError(
            f"the assessment has {count:,} runs; at most {MOST_RUNS:,} are allowed, so take fewer seeds"
        )
    return Assessment(participants, plan)


FORM = 'send {"participants": {"ROLE": "http://HOST:PORT"}, "config": {"tasks": ["general"]}}'


def result_of(asked: Assessment, folder: Path) -> tuple[str, Json]:
    """The result of an evaluation in a sentence, and as data."""
    found = read_results(folder)
    everything = rate_of(found.rows)
    data: Json = {
        "score": everything.successes,
        "max_score": everything.planned,
        "pass_rate": 100 * (everything.value or 0.0),
        "errors": everything.errors,
        "participants": {
            role: [_standing(found, each) for each in found.contestants if each.agent == PREFIX + url]
            for role, url in asked.participants.items()
        },
        "rows": [as_json(row) for row in found.rows],
        "version": __version__,
    }
    return answer(found), data


def _standing(found: Results, each: Contestant) -> Json:
    rows: Sequence[EpisodeRow] = found.of(each)
    most = int(found.manifest["plan"]["repeats"])
    return {
        "agent": each.agent,
        "conditions": {one.name: str(getattr(each.conditions, one.name)) for one in TABLE},
        "episodes": _rate(rate_of(rows)),
        "pairs": _rate(rate_of(pair for pair, _ in pairs(rows))),
        "pass^k": {str(k): share for k, share in enumerate(pass_hats(rows, most), start=1)},
        "tokens_in": sum(row.tokens_in for row in rows),
        "tokens_out": sum(row.tokens_out for row in rows),
        "cost_usd": sum(row.cost_usd for row in rows),
    }


def _rate(rate: Rate) -> Json:
    return {
        "successes": rate.successes,
        "planned": rate.planned,
        "errors": rate.errors,
        "rate": rate.value,
        "interval": None if rate.interval is None else asdict(rate.interval),
    }


def _length(value: object) -> int:
    return len(value) if isinstance(value, list) else 0


def _whole(value: Any) -> Any:
    """The value with whole numbers as such: data in A2A knows only floats."""
    if isinstance(value, dict):
        return {name: _whole(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [_whole(entry) for entry in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value
