"""How much of what agents can do is left when the driver's words are heard in noise.

    python benchmarks/noise.py --keep runs/noise                # resumes
    python benchmarks/noise.py --keep runs/noise --for-s 240    # no episode begins later than that

The same episodes, drawn from the standard suite, with words as text and as a recogniser made them out at each ratio
of words to noise: unlike with ``--hear cabin`` alone, the ratio is set, whatever the car and the cockpit do. With
``--suite voice --levels text,cabin``, pairs of that suite, in the noise of the drive:

* ``careful`` takes words for the likeliest of those that the task can have, and then does all that its reference
  solution does, questions and waiting included, and makes it quieter where the driver has not understood it;
* ``eager`` takes them so, too, but asks nothing before it acts, does what any voice says, and answers at length.
"""

from __future__ import annotations

import argparse
import json
import time
from contextlib import closing, suppress
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from automotive_cosim.agents import AgentSettings, Oracle, make_agent
from automotive_cosim.contracts import Action, Observation
from automotive_cosim.contracts.given import Hearing, PromptLength
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.situation import HandOver
from automotive_cosim.errors import TriggerNotReachedError
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.proof.hand_over import SETUP, Ground, Trial, finish
from automotive_cosim.report.stats import bracketed, wilson
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.trial import run_trial
from automotive_cosim.tasking.dialogue import PARDON
from automotive_cosim.tasking.instance import Instance, draw
from automotive_cosim.tasking.moves import Consult, Move, Open, Slide, Tap
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.voice.table import CLEAN_DB, LEVELS_DB, lacking, word_errors

AGENTS = ("asurada", "t3a", "caller")
MODEL, SCENARIO, SEED = "rules", "grid", 0
TASKS = 40
TEXT = "text"
LEVELS = (TEXT, *(f"{CLEAN_DB if level is None else level:g}" for level in LEVELS_DB))
INSTANCES = 100
"""Of a task, among which the words are looked for."""


def _shut(*windows: str) -> list[Move]:
    return [Open("vehicle"), Tap("vehicle.tab.doors"), *(Slide(f"window.{each}", 0) for each in windows)]


QUIETING: dict[str, list[Move]] = {
    "windows": _shut("driver", "passenger", "rear_left", "rear_right"),
    "motorway": _shut("driver"),
    "music": [Open("media"), Slide("media.volume", 10)],
}
"""What makes it quieter, by where a task of the family ``voice_ask`` is asked."""


class Listener(Oracle):
    """Plays the solution of the instance whose words are nearest to what it has heard."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name
        self._known: list[Instance] = []
        self._taken: Instance | None = None
        self._heard = 0

    def brief(self, instance: Instance, *_: object, **__: object) -> None:
        """Learns what the task can be; which of it, it has to hear."""
        half = instance.half_name
        if self.name == "eager":
            half = "first" if instance.task.id.split("_")[1] in ("heed", "over", "quiet") else "second"
        self._known = [draw(instance.task, half, number) for number in range(INSTANCES)]
        self._taken, self._heard = None, 0

    def act(self, observation: Observation) -> Action:
        """The next move of what it takes the words for."""
        if self._taken is None:
            self._taken = min(self._known, key=lambda each: word_errors(each.goal, observation.goal)[0])
            super().brief(self._taken)
        elif len(observation.said) > self._heard and (replies := self._replies(observation.said[-1])):
            asked = max(at for at, move in enumerate(self._taken.moves) if isinstance(move, Consult))
            if word_errors(PARDON, observation.said[-1])[0] < 3:  # the driver has not understood: first less noise
                super().brief(
                    self._taken, [*QUIETING[self._taken.task.id.split("_")[-1]], *self._taken.moves[asked:]]
                )
            else:
                self._taken = replies[0]
                super().brief(self._taken, self._taken.moves[asked + 1 :])
        self._heard = len(observation.said)
        return super().act(observation)

    def _replies(self, heard: str) -> list[Instance]:
        """Instances in which a question is asked, by how near an answer of the driver's is."""
        answering = [each for each in self._known if any(isinstance(move, Consult) for move in each.moves)]
        return sorted(answering, key=lambda each: min(
            word_errors(topic.reply, heard)[0] for topic in each.half.topics
        ))  # fmt: skip


def drawn(count: int, suite: str) -> list[tuple[str, str]]:
    """Halves of so many tasks of a suite, of the standard suite of those that run in the scenario, drawn from those
    whose words the table has."""
    able = [task for task in CATALOGUE.of(Suite(suite)) if not task.needs_picture]
    if suite == Suite.STANDARD:
        able = [task for task in able if SCENARIO in task.runs_in]
    said = {task.id: [draw(task, half, SEED).spoken for half in task.halves] for task in able}
    able = [task for task in able if not any(map(lacking, said[task.id]))]
    chosen = np.random.default_rng(SEED).permutation(len(able))[:count]
    return [(able[at].id, half) for at in chosen for half in able[at].halves]


def played(
    agent: str, task: str, half: str, level: str, simulations: Simulations, model: str, steps: int | None
) -> bool | None:
    """Whether an agent wins an episode with its words heard like that; None if the situation did not arise."""
    more: dict[str, Any] = {"interface": "functions"} if agent == "caller" else {}
    more |= {} if model == MODEL else {"prompt": str(PromptLength.SHORT)}
    under = Conditions.named({"hear": str(Hearing.TEXT if level == TEXT else Hearing.CABIN)} | more)
    setup = EpisodeSetup(
        task, half, SCENARIO, seed=SEED, conditions=under, agent=agent, model=model, max_steps=steps
    )
    snr_db = 0.0 if level == TEXT else float(level)
    with patch("automotive_cosim.episode.session.driver_snr_db", lambda noise_db: snr_db):
        return run_trial(setup, make_agent(agent, model, AgentSettings(under)), simulations=simulations).success


def controlled(agent: str, task: str, half: str, level: str, simulations: Simulations, *_: object) -> bool | None:
    """As ``played``, in the noise of the drive, which agents and ways to hear share up to the hand-over."""
    ground = _ground(task, half, simulations)
    if ground is None:
        return None
    under = replace(SETUP, conditions=Conditions(hear=Hearing(level)))
    there = HandOver(
        ground.instance, ground.episode.world.branch(), ground.episode.drive, ground.episode.scenario, SEED
    )
    player = Listener(agent) if agent in ("careful", "eager") else make_agent(agent, "none", AgentSettings())
    return finish(Trial.take_over(there, under), ground.agent(player)).success


_GROUNDS: dict[str, Ground | None] = {}
"""The half that is played, at its hand-over."""


def _ground(task: str, half: str, simulations: Simulations) -> Ground | None:
    if (name := f"{task} {half}") not in _GROUNDS:
        for each in filter(None, _GROUNDS.values()):
            each.close()
        _GROUNDS.clear()
        _GROUNDS[name] = None
        with suppress(TriggerNotReachedError):
            _GROUNDS[name] = Ground.reach(CATALOGUE[task], half, SEED, simulations)
    return _GROUNDS[name]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", type=Path, default=Path("runs/noise"), help="folder of what was played")
    parser.add_argument("--for-s", type=float, default=float("inf"), help="no episode begins later than that")
    parser.add_argument("--tasks", type=int, default=TASKS)
    parser.add_argument("--suite", default=str(Suite.STANDARD))
    parser.add_argument("--agents", default=",".join(AGENTS))
    parser.add_argument("--levels", default=",".join(LEVELS))
    parser.add_argument("--model", default=MODEL, help="another than the default gets short prompts")
    parser.add_argument("--steps", type=int, help="how many at most")
    parsed, begun_s = parser.parse_args(), time.monotonic()
    agents, levels = parsed.agents.split(","), parsed.levels.split(",")
    parsed.keep.mkdir(parents=True, exist_ok=True)
    file = parsed.keep / "won.json"
    won = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    halves = drawn(parsed.tasks, parsed.suite)
    with closing(Simulations()) as simulations:
        for (task, half), agent, level in product(halves, agents, levels):
            name = f"{agent} {task} {half} {level}"
            if name not in won and time.monotonic() - begun_s < parsed.for_s:
                play = played if parsed.suite == Suite.STANDARD else controlled
                won[name] = play(agent, task, half, level, simulations, parsed.model, parsed.steps)
                write_whole(file, json.dumps(won, indent=1) + "\n")
    whole = [
        each for each in halves if all(won.get(f"{agent} {' '.join(each)} {level}") is not None
                                       for agent, level in product(agents, levels))
    ]  # fmt: skip
    print(f"| {len(whole)} halves | " + " | ".join(levels) + " |\n|---|" + "---:|" * len(levels))
    for agent in agents:
        counts = [sum(won[f"{agent} {task} {half} {level}"] for task, half in whole) for level in levels]
        pairs = [
            sum(half == "second" and all(won[f"{agent} {task} {each} {level}"] for each in ("first", "second"))
                for task, half in whole) for level in levels
        ]  # fmt: skip
        cells = [f"{count}{bracketed(wilson(count, len(whole)), '.0%')}, {both} pairs"
                 for count, both in zip(counts, pairs, strict=True)]  # fmt: skip
        print(f"| {agent} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
