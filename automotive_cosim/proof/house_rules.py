"""The gate of the house rules: no reference solution breaks one, and who takes a temptation is reported."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache

from automotive_cosim.contracts.given import Interface
from automotive_cosim.formats.shipped import shipped_table
from automotive_cosim.proof.hand_over import Ground, Played, finish
from automotive_cosim.tasking import reading
from automotive_cosim.tasking.moves import Move
from automotive_cosim.tasking.parameters import bind
from automotive_cosim.tasking.policy import Breach, Conduct, breaches
from automotive_cosim.tasks import CATALOGUE


@dataclass(frozen=True, slots=True)
class Temptation:
    """A half of a task, and what breaks a house rule in it."""

    task: str
    half: str
    moves: tuple[Move, ...]


@cache
def temptations() -> Mapping[str, Temptation]:
    """Where the house rules are tempting to break (``tasks/temptations.toml``), by the id of the rule."""
    found = {}
    for rule, told in shipped_table("tasks", "temptations.toml").items():
        task = CATALOGUE[told["task"]]
        if "slip" in told:
            taken = task.half(told["half"]).slips[told["slip"]]
        elif "as_in" in told:
            taken = task.half(told["as_in"]).moves
        else:
            taken = reading.moves(told["moves"])
        found[rule] = Temptation(task.id, told["half"], taken)
    return found


def policy(ground: Ground) -> Iterator[str]:
    """Looks at the reference solution, and plays each temptation declared for this half. Other ways that the
    verdict accepts may break a rule, such as one without a look-up."""
    for breach in broken(ground, ground.reference):
        yield f"the reference solution breaks the house rule {breach.rule} after {breach.at_s:g} s"
    for rule, temptation in temptations().items():
        if (temptation.task, temptation.half) == (ground.task.id, ground.half_name):
            played = tempted(ground, temptation)
            if played.stuck:
                yield f"the temptation to break {rule} cannot be taken: {played.stuck}"
            elif rule not in {breach.rule for breach in broken(ground, played)}:
                yield f"whoever takes the temptation to break {rule} is not reported"


def broken(ground: Ground, played: Played) -> tuple[Breach, ...]:
    """What an episode did against the house rules."""
    return breaches(Conduct(played.moments, played.steps, played.given, ground.half.start.voice))


def tempted(ground: Ground, temptation: Temptation) -> Played:
    """An episode in which the temptation is taken, by an agent that may touch and call."""
    episode = ground.episode.branch()
    conditions = replace(episode.setup.conditions, interface=Interface.BOTH)
    episode.setup = replace(episode.setup, conditions=conditions)
    return finish(episode, ground.oracle(bind(temptation.moves, ground.instance.parameters)))
