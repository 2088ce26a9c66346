"""The gates that a task must pass, each a function from its hand-over to the task's faults.

| gate | what must be true |
|---|---|
| oracle | every reference solution succeeds by public actions, within the budget and 70 % of the deadline |
| makes | the first of them succeeds in the cockpit of every other make too, by its way there |
| start | the goal does not hold at the hand-over, and the context does not leave the deciding rule to a query |
| world | weather, speed, lamps and cabin are such as the place has at that date and hour |
| wording | each phrasing to be asked about says that one of several is meant |
| slip | each usual mistake that the task names can be made, and fails |
| prefix | ``complete`` after any earlier step of the reference solution scores 0 |
| late | the reference solution after the deadline fails |
| undone | with the goal's own writes reverted, it fails |
| near | another zone, value or direction fails |
| coupled | the reference solution and one switch more fails, for every switch of the car |
| uncoupled | undoing what the car coupled to the reference solution, or keeping it from happening, still wins |
| optional | the reference solution still wins with every field that the prompt offers for its alerts |
| effect | where the words do not say what to do, a solution that acts on the air has an effect on it |
| knowable | what was drawn has been told before the reference solution uses it |
| lawful | the reference solution breaks no sign and no verified rule, nor has cruise control break one |
| policy | no reference solution breaks a house rule, and a temptation that is declared for the half is reported \
(``proof.house_rules``) |
| functions | by calls of functions, translated by machine, the reference solution wins too, with a wrong value it \
loses, and to end or to warn at once wins no pair (``proof.functions``); not of tasks that need the picture |
| trivial | no negative control wins both halves of a pair, or the only half |
| random | random actions win at most one of twenty, or no more than their declarations win by chance where a \
declaration alone is right: what would come about once in a hundred times |
| leak | without goal and solutions, every observation is the same, byte for byte |
| road | a parked car does not reach the trigger |
| law | what is right in one half fails in the other |
| sight | the halves of a pair differ at first sight only in what the pair declares |
| lasting | a tunnel or a school zone that the trigger names lasts half as long again as the longer reference \
solution, or up to the deadline |
| place | a pair has the tag ``place`` exactly if only place tells what is right |
| repeat | the same seed gives the same words and trace; other seeds give others |
| residue | after another task's episode, a task still gives its own trace |
| reach | in every scenario that the task names, the trigger comes in time and the reference solution succeeds |
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from dataclasses import replace
from functools import partial
from itertools import product

from automotive_cosim.agents.trivial import AlwaysAlert, AlwaysAsk, NoOp, PressEverything, Random
from automotive_cosim.cockpit.apps.phone.person import PHOTO
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import ACTUATORS, ADAS, GLASS, HVAC, named
from automotive_cosim.contracts import (
    KMH_PER_MPS,
    Action,
    ActionType,
    AlertKind,
    FeedbackCode,
    GoalStatus,
    Observation,
)
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.contracts.ids import resource_id
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.episode import replayed
from automotive_cosim.errors import ScenarioError, TriggerNotReachedError
from automotive_cosim.geo.breaches import EQUAL_UP_TO_KMH, violations
from automotive_cosim.geo.rules import Status
from automotive_cosim.proof import mutations
from automotive_cosim.proof.first_sight import undeclared
from automotive_cosim.proof.hand_over import Ground, Played, Script, Trial, finish
from automotive_cosim.proof.knowledge import DrawnValues, unknown
from automotive_cosim.proof.place import mistagged
from automotive_cosim.proof.world import implausible
from automotive_cosim.tasking.binding import rules_of
from automotive_cosim.tasking.checks import AlertGiven, Check, nothing_done
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Consult, Move
from automotive_cosim.tasking.parameters import FromCockpit
from automotive_cosim.tasking.task import Basis, Differs, Half, Task
from automotive_cosim.tasking.triggers import All, Not, Situation, TriggerCondition
from automotive_cosim.tasking.verdict import judge, may_part
from automotive_cosim.traffic.base import WarmSimulations

PACE = 0.7
"""Share of the deadline that a reference solution may take, so that agents have a chance."""
RANDOM_RUNS = 20
RANDOM_WINS = 1
CHANCE = 0.01
"""What comes about less often is no chance; our choice."""
PRESSES = 60
"""Steps for pressing everything: more controls than the fullest screen has."""
LEISURE = 1.5
"""Time that somebody takes who looks round first, as a share of a reference solution's; our choice."""
PATIENCE = 200
"""Steps for waiting, independent of the budget."""
ONE_OF_SEVERAL = re.compile(
    r"\b(one|either|just|only|that|which|whichever|whose|whoever|whatever)\b", re.IGNORECASE
)
BY_NUMBER = re.compile(r"\b(element|index|widget)\s*(number\s*)?\d", re.IGNORECASE)

Wrong = Iterator[str]
GateStrategy = Callable[[Ground], Played]


# --- one half ---------------------------------------------------------------------------------------------


def oracle(ground: Ground) -> Wrong:
    """Plays every reference solution."""
    others = (ground.play(ground.oracle(way)) for way in ground.half.ways)
    for number, played in enumerate((ground.reference, *others)):
        if not played.success:
            yield f"solution {number}: {played.why}"
        elif played.seconds > PACE * ground.half.deadline.seconds:
            yield f"solution {number} takes {played.seconds:.0f} s of {ground.half.deadline.seconds:g} s"


def makes(ground: Ground) -> Wrong:
    """Plays the reference solution in every other make."""
    for make in CarMake:
        if make not in (CarMake.HOME, CarMake.DRAWN) and not (played := ground.in_make(make)).success:
            yield f"{make}: {played.why}"


def start(ground: Ground) -> Wrong:
    """Checks the goal, its words and its law at the hand-over."""
    moment = ground.episode.moments[0]
    if is_to_do(ground.half) and ground.half.goal.holds(moment, moment, [moment]):
        yield f"holds already: {ground.half.goal}"
    if ground.half.basis is Basis.LAW:
        every, shown = ({line.source for line in lines} for lines in (moment.context.lines, moment.context.shown))
        for rule in rules_of(ground.half):
            if rule.id in every - shown:
                yield f"{rule.id} decides, but the context leaves it to a query"
    if BY_NUMBER.search(ground.instance.goal):
        yield f"names a widget by its number: {ground.instance.goal!r}"


def is_to_do(half: Half) -> bool:
    """Whether something of the car has to change; where the driver has to be told something, nothing may."""
    return half.declares is GoalStatus.COMPLETE and not half.tells


def world(ground: Ground) -> Wrong:
    """Holds the weather against the climate."""
    yield from implausible(ground.episode.moments[0])


def slip(ground: Ground) -> Wrong:
    """Makes the usual mistakes, each before ``complete``."""
    for number, moves in enumerate(ground.half.slips):
        played = ground.play(ground.oracle(moves, GoalStatus.COMPLETE))
        if played.stuck:
            yield f"slip {number} cannot be made: {played.stuck}"
        elif played.success:
            yield f"slip {number} succeeds"


def prefix(ground: Ground) -> Wrong:
    """Declares ``complete`` before the reference solution's last move; at once if nothing has to be done."""
    oracle = ground.oracle()
    walk = ground.episode.branch()
    while walk.verdict is None:
        action = oracle.act(walk.observation)
        if action.action_type is ActionType.STATUS and len(walk.steps) > 1:
            break  # all is done: the declaration is due
        early = finish(walk.branch(), Script((Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE),)))
        if early.success:
            yield f"complete after {len(walk.steps) - 1} actions succeeds"
        if action.action_type is ActionType.STATUS:
            break
        walk.step(action)
    walk.close()


def late(ground: Ground) -> Wrong:
    """Plays the reference solution after the deadline."""
    oracle = ground.oracle()
    wait_s = ground.half.deadline.seconds

    class Late:
        channels = oracle.channels
        left_s = wait_s

        def act(self, observation: Observation) -> Action:
            if self.left_s > 0:
                self.left_s -= 10
                return Action(ActionType.WAIT, seconds=10)
            return oracle.act(observation)

    if ground.play(Late(), PATIENCE).success:
        yield f"succeeds {wait_s:g} s late"


def undone(ground: Ground, right: Played) -> Wrong:
    """Judges the reference solution's end state with the goal's writes reverted."""
    if ground.half.goal.writes:
        moments = mutations.undone(right.moments[0], right.moments, ground.half)
        if _wins(ground, right, moments):
            yield "succeeds with everything reverted"


def near(ground: Ground, right: Played) -> Wrong:
    """Judges the reference solution's end state in another zone or direction, or with another value."""
    for what, moments in mutations.near_misses(right.moments[0], right.moments, ground.half):
        if _wins(ground, right, moments):
            yield f"succeeds with {what}"


def coupled(ground: Ground, right: Played) -> Wrong:
    """Turns each switch that the goal does not allow on its own, after the reference solution.

    All are tried, so that those which the car couples to the goal are among them. One that the car refuses or that
    changes nothing is skipped."""
    before, first, end = right.moments[:-1], right.moments[0], right.moments[-1]
    done = replayed(ground.episode.at_hand_over, right.given, before)
    for path in sorted(set(ACTUATORS) - ground.half.allowed_writes - may_part(ground.half)):
        car = done.copy()
        value = mutations.another_value(named(path), car.signals[named(path)])
        if value == first.commands[path]:  # sets back what followed, which is free: `uncoupled`
            continue
        if car.command(named(path), value).code is not FeedbackCode.OK:
            continue
        car.sense(end.surroundings, end.time_s - before[-1].time_s)
        last = replace(end, signals=car.signals.snapshot(), commands=car.commands())
        if last.commands != end.commands and _wins(ground, right, (*before, last)):
            yield f"succeeds with {path} {value} as well"


def uncoupled(ground: Ground, right: Played) -> Wrong:
    """Sets back what followed a command of the reference solution without being asked for, and parts what couples
    two commands before or after it; what breaks the goal itself or what the car refuses is skipped."""
    before, first, end = right.moments[:-1], right.moments[0], right.moments[-1]
    aims = frozenset().union(*(record.aims for record in right.given))
    followed = {
        path
        for path in ACTUATORS
        if end.commands[path] != right.baseline[-1].commands[path] and path not in ground.half.goal.writes | aims
    }

    def fails(car: Cockpit) -> bool:
        """With the goal reached."""
        trace = (*before, replace(end, signals=car.signals.snapshot(), commands=car.commands()))
        return ground.half.goal.holds(first, trace[-1], trace) and not _wins(ground, right, trace)

    done = replayed(ground.episode.at_hand_over, right.given, before)
    for what, paths in [*((path, {path}) for path in sorted(followed)), ("all that followed", followed)]:
        car = done.copy()
        _give(car, {path: first.commands[path] for path in paths}, end, before[-1])
        if fails(car):
            yield f"fails once {what} is as before, which only followed"
    for switch in sorted(may_part(ground.half)):
        if first.commands[switch]:
            car = ground.episode.at_hand_over.copy()
            car.command(named(switch), False)
            car = replayed(car, right.given, before)
            car.sense(end.surroundings, end.time_s - before[-1].time_s)
            if fails(car):
                yield f"fails with {switch} off first, so that nothing else follows"


def _give(car: Cockpit, values: Mapping[str, object], end: Moment, before: Moment) -> None:
    for path, value in values.items():
        car.command(named(path), value)
    car.sense(end.surroundings, end.time_s - before.time_s)


def optional(ground: Ground, right: Played) -> Wrong:
    """Fills in whatever an alert of the reference solution may take besides, with what is true."""
    first, end = right.moments[0], right.moments[-1]
    given = end.commands["alerts"][len(first.commands["alerts"]) :]
    limit = end.context.binding_limit
    advice = round(end.driving.speed_mps * KMH_PER_MPS) if limit is None else round(limit.kmh)
    for at, alert in enumerate(given):
        for fields in ({"severity": "critical"}, {"text": "Careful, please"}, {"speed_kmh": float(advice)}):
            if alert["speed_kmh"] is not None and "speed_kmh" in fields:
                continue
            if "speed_kmh" in fields and not _may_advise(ground, alert["kind"], advice):
                continue
            alerts = [*end.commands["alerts"]]
            alerts[len(first.commands["alerts"]) + at] = {**alert, **fields}
            last = replace(end, commands={**end.commands, "alerts": alerts})
            if not _wins(ground, right, (*right.moments[:-1], last)):
                yield f"fails if the {alert['kind']} alert has {fields} as well"


def _may_advise(ground: Ground, kind: AlertKind, kmh: float) -> bool:
    """Whether a goal that names a speed names this one; another is wrong, and one that names none takes any."""
    named_kmh = {found.speed_kmh for found in _alerts_of(ground.half.goal) if found.kind == kind}
    return None in named_kmh or any(abs(speed - kmh) < 1.0 for speed in named_kmh if speed is not None)


def _alerts_of(check: Check) -> Iterator[AlertGiven]:
    if isinstance(check, AlertGiven):
        yield check
    for part in getattr(check, "checks", ()):
        yield from _alerts_of(part)


AIR = frozenset(
    signal.path
    for signal in (
        HVAC.DRIVER_TEMPERATURE, HVAC.PASSENGER_TEMPERATURE, HVAC.FAN_SPEED, HVAC.AIR_CONDITIONING, HVAC.AUTO,
        HVAC.RECIRCULATION, HVAC.PURIFIER, HVAC.FRONT_DEFROSTER, HVAC.MAX_DEFROST, HVAC.MAX_COOLING,
    )
)  # fmt: skip
"""What acts on nothing but the air of the cabin and, through it, on the glass."""
FELT: Mapping[str, float] = {
    HVAC.CABIN_TEMPERATURE.path: 0.05,
    HVAC.CABIN_HUMIDITY.path: 0.2,
    HVAC.CABIN_FINE_DUST.path: 0.2,
    GLASS.WINDSHIELD_FOG.path: 0.01,
    GLASS.REAR_FOG.path: 0.01,
}
"""The least change of a reading within ``EFFECT_S`` that is one; our choice."""
EFFECT_S = 60.0


def effect(ground: Ground) -> Wrong:
    """Lets a minute pass after each solution and after none, under the sky and on the road of its end."""
    if not ground.task.is_implicit or not ground.half.goal.writes & AIR:
        return
    others = (ground.play(ground.oracle(way)) for way in ground.half.ways)
    for number, played in enumerate((ground.reference, *others)):
        aims = frozenset().union(*(record.aims for record in played.given))
        if not aims or not aims <= AIR or not played.success:
            continue
        acted, idle = (_later(ground, played, keys) for keys in (None, frozenset[str]()))
        if all(abs(acted[path] - idle[path]) < least for path, least in FELT.items()):
            yield f"solution {number} has no effect on the air: a minute later it is as if nothing had been done"


def _later(ground: Ground, played: Played, keys: frozenset[str] | None) -> Mapping[str, float]:
    car = replayed(ground.episode.at_hand_over, played.given, played.moments, keys)
    car.sense(played.moments[-1].surroundings, EFFECT_S)
    return {path: float(car.signals[named(path)]) for path in FELT}


def wording(ground: Ground) -> Wrong:
    """Looks, where the settings alone make a wish unclear, for words that say that one of several is meant."""
    if ground.half.needed_topics and ground.task.differs == {Differs.SETTINGS}:
        for words in ground.task.templates:
            if not ONE_OF_SEVERAL.search(words):
                yield f"{words!r} does not say that one of several is meant"


def lawful(ground: Ground, right: Played) -> Wrong:
    """Looks for violations that the baseline run does not have, and at the speed that cruise control is to hold."""
    anyway = {(found.kind, found.rule) for found in violations(right.baseline)}
    for found in violations(right.moments):
        if found.status is Status.VERIFIED and (found.kind, found.rule) not in anyway:
            yield f"breaks {found.rule}: {found.text}"
    first, end = right.moments[0], right.moments[-1]
    engaged = end.signals[ADAS.CRUISE_ACTIVE.path] and not first.signals[ADAS.CRUISE_ACTIVE.path]
    limit, set_kmh = first.context.binding_limit, end.signals[ADAS.CRUISE_SPEED.path]
    if engaged and limit is not None and limit.status is Status.VERIFIED and set_kmh > limit.kmh + EQUAL_UP_TO_KMH:
        yield f"has cruise control hold {set_kmh:g} km/h where the limit is {limit.kmh:.0f} ({limit.rule})"


def knowable(ground: Ground, right: Played) -> Wrong:
    """Looks for acts of the reference solution that depend on what nothing observed before has told."""
    instance, cockpit = ground.instance, ground.episode.world.cockpit
    said = (words for words in ground.task.templates if words.format_map(instance.parameters) in instance.goal)
    choices = {
        name: cockpit.content[drawn.kind] if isinstance(drawn, FromCockpit) else drawn
        for name, drawn in ground.task.parameters.items()
    }
    drawn = DrawnValues(instance.parameters, choices)
    half = ground.task.half(ground.half_name)
    yield from unknown(half, next(said), drawn, right.steps, ground.move_of_action)


UNSEEN = frozenset({Differs.CONTENT, Differs.EQUIPMENT})
"""Differences that nobody sees before a screen is opened."""


def parted(grounds: dict[str, Ground]) -> Wrong:
    """Looks for halves that differ in content alone, and whose solutions part before either has seen it."""
    if any(not ground.task.differs <= UNSEEN or ground.half.needed_topics for ground in grounds.values()):
        return
    if len(grounds) < 2 or not all(ground.half.moves for ground in grounds.values()):
        return
    one, other = (ground.reference for ground in grounds.values())
    for mine, theirs, act, another in zip(one.steps, other.steps, one.actions, other.actions, strict=False):
        if (mine.elements, mine.feedback, mine.said) != (theirs.elements, theirs.feedback, theirs.said):
            return
        if any(element.resource_id == resource_id(PHOTO) for element in mine.elements):
            return  # what it shows is in no list
        if act != another:
            yield f"the halves part at action {mine.number + 1}, before anything seen differs"
            return


def random(ground: Ground) -> Wrong:
    """Plays random actions. Of runs that end with a declaration, chance alone wins the share of declarations that
    win by themselves: a third where the driver has to be refused."""
    runs = [ground.play(ground.agent(Random(number)), stop_when_lost=True) for number in range(RANDOM_RUNS)]
    wins = sum(run.success for run in runs)
    if wins <= RANDOM_WINS:
        return
    declared = sum(any(act is not None and act.goal_status is not None for act in run.actions) for run in runs)
    right = sum(ground.declares(status).success for status in GoalStatus) / len(GoalStatus)
    most = max(RANDOM_WINS, by_chance(declared, right))
    if wins > most:
        yield f"random actions win {wins} of {RANDOM_RUNS}, where chance explains {most}"


def by_chance(trials: int, share: float) -> int:
    """The most wins of so many trials, each won with the same chance, that come about at least once in a hundred
    times (binomial distribution)."""
    at_least = [
        sum(math.comb(trials, won) * share**won * (1 - share) ** (trials - won) for won in range(wins, trials + 1))
        for wins in range(trials + 1)
    ]
    return max(wins for wins, chance in enumerate(at_least) if chance >= CHANCE)


def _wins(ground: Ground, right: Played, moments: tuple[object, ...]) -> bool:
    declared = right.actions[-1]
    assert declared is not None
    verdict = judge(
        ground.instance,
        moments,  # type: ignore[arg-type]
        right.baseline,
        right.counterfactual,
        declared.goal_status,
        declared.reason,
        said=right.said,
    )
    return verdict.success


# --- strategies over all halves ---------------------------------------------------------------------------


def _strategies(grounds: dict[str, Ground]) -> Iterator[tuple[str, GateStrategy]]:
    yield "no-op", lambda ground: ground.play(ground.agent(NoOp()), stop_when_lost=True)
    for status in GoalStatus:
        yield str(status), partial(Ground.declares, status=status)
    yield (
        "press-everything",
        lambda ground: ground.play(ground.agent(PressEverything()), PRESSES, stop_when_lost=True),
    )
    for kind in AlertKind:
        yield f"always {kind}", partial(_alerts, kind=kind)
    yield "always-ask", lambda ground: ground.play(ground.agent(AlwaysAsk()), stop_when_lost=True)
    if topics := next((ground.half.topics for ground in grounds.values() if ground.half.topics), ()):
        yield "asks first", partial(_talks, asks=tuple(Consult(_naming_all(topic)) for topic in topics))
        yield "never asks", partial(_talks, asks=())
    if len(grounds) > 1:
        for name, acting in grounds.items():
            yield f"context-reader, {name}", partial(_reads_context, acting=acting)


def _alerts(ground: Ground, kind: AlertKind) -> Played:
    return ground.play(ground.agent(AlwaysAlert(kind)), stop_when_lost=True)


def _talks(ground: Ground, asks: tuple[Move, ...]) -> Played:
    """Asks the right questions, or none, in whichever half it is, and then does what is right there."""
    acts = tuple(move for move in ground.half.moves if not isinstance(move, Consult))
    return ground.play(ground.oracle((*asks, *acts)))


def _naming_all(topic: Topic) -> str:
    return f"Which: {', or '.join(words[0] for words in topic.choices)}?"


def _reads_context(ground: Ground, acting: Ground) -> Played:
    """Does what is right in ``acting`` if the context has a rule on its topic, else declines."""
    topics = {topic.strip() for topic in acting.half.rule.split(",")}
    known = {
        name
        for applied in ground.episode.moments[0].context.rules
        for name in (applied.rule.topic, applied.rule.id)
    }
    if acting.half.basis is not Basis.LAW or _topics(acting, topics) & known:
        return ground.play(acting.oracle())
    return ground.declares(GoalStatus.NOT_NEEDED)


def _topics(ground: Ground, ids: set[str]) -> set[str]:
    return {applied.rule.topic for applied in ground.episode.moments[0].context.rules if applied.rule.id in ids}


def trivial(grounds: dict[str, Ground]) -> Wrong:
    """Plays the negative controls in every half."""
    for name, strategy in _strategies(grounds):
        if all(strategy(ground).success for ground in grounds.values()):
            yield f"{name} wins" + (" both halves" if len(grounds) > 1 else "")


def law(grounds: dict[str, Ground]) -> Wrong:
    """Does in one half what is right in the other."""
    if len(grounds) < 2:
        return
    for name, other in (("first", "second"), ("second", "first")):
        if grounds[name].play(grounds[other].oracle()).success:
            yield f"what is right in the {other} half also succeeds in the {name}"


def sight(grounds: dict[str, Ground]) -> Wrong:
    """Compares the first observations of both halves."""
    if len(grounds) == 2:
        one, other = ((ground.episode.observation, ground.episode.moments[0]) for ground in grounds.values())
        yield from undeclared(grounds["first"].task.differs, one, other)


def lasting(grounds: dict[str, Ground]) -> Wrong:
    """Waits as long as somebody needs who looks round first, and holds the place against the trigger's."""
    played = [ground.reference.moments for ground in grounds.values()]
    longest_s = max(moments[-1].time_s - moments[0].time_s for moments in played)
    for half, ground in grounds.items():
        needed_s = min(LEISURE * longest_s, ground.half.deadline.seconds)
        if not (spots := tuple(_spots(ground.half.trigger.condition))):
            continue
        moments = ground.play(Script((Action(ActionType.WAIT, seconds=1),)), math.ceil(needed_s)).moments
        for moment in moments:
            if left := [spot for spot in spots if not spot(moment)]:
                passed_s = moment.time_s - moments[0].time_s
                yield f"{half}: {left[0]} for less than {passed_s:.0f} s, where {needed_s:.0f} s are needed"
                break


def _spots(condition: TriggerCondition) -> Iterator[TriggerCondition]:
    """What a trigger says of places that a car has soon passed."""
    if isinstance(condition, All):
        for part in condition.conditions:
            yield from _spots(part)
        return
    match condition.condition if isinstance(condition, Not) else condition:
        case Situation("in_tunnel" | "in_school_zone"):
            yield condition


def place(grounds: dict[str, Ground]) -> Wrong:
    """Holds the tag against the hand-overs."""
    if len(grounds) == 2:
        yield from mistagged(grounds["first"], grounds["second"])


# --- further hand-overs -----------------------------------------------------------------------------------


def leak(ground: Ground, simulations: WarmSimulations) -> Wrong:
    """Compares with the same hand-over of a task without a goal."""
    task = ground.task
    bare = {name: _bare(task.half(name)) for name in task.halves}
    again = Ground.reach(
        replace(task, first=bare["first"], second=bare.get("second")), ground.half_name, ground.seed, simulations
    )
    steps = [Action(ActionType.NAVIGATE_HOME), Action(ActionType.WAIT, seconds=2)]
    seen = [_observed(side.episode, steps) for side in (ground, again)]
    again.close()
    if seen[0] != seen[1]:
        yield "an observation differs without goal, solutions and declaration"


def _bare(half: Half) -> Half:
    return replace(
        half,
        goal=nothing_done(),
        moves=(),
        ways=(),
        basis=Basis.WISH,
        rule="",
        declares=GoalStatus.INFEASIBLE,
        reasons=frozenset(),
        may_write=frozenset(),
    )


def _observed(episode: Trial, actions: list[Action]) -> list[str]:
    branch = episode.branch()
    seen = [repr(branch.observation)]
    for action in actions:
        branch.step(action)
        seen.append(repr(branch.observation))
    branch.close()
    return seen


def road(ground: Ground, simulations: WarmSimulations) -> Wrong:
    """Parks the car, in traffic that moves in steps of a second: a parked car needs no finer one. A task that
    requires a stationary car is skipped, and none that requires a moving one need be tried."""
    half = ground.task.half(ground.half_name)
    if half.start.parked or _requires(half.trigger.condition, _stands) or _requires(half.trigger.condition, _moves):
        return
    parked = replace(half, start=replace(half.start, parked=True))
    changed = {"first": parked} if ground.half_name == "first" else {"second": parked}
    try:
        parked_task = replace(ground.task, **changed)  # type: ignore[arg-type]
        Ground.reach(parked_task, ground.half_name, ground.seed, simulations, coarse=True).close()
    except TriggerNotReachedError:
        return
    yield "its trigger is reached by a parked car"


def _requires(condition: TriggerCondition, what: Callable[[Situation], bool]) -> bool:
    if isinstance(condition, All):
        return any(_requires(part, what) for part in condition.conditions)
    return isinstance(condition, Situation) and what(condition)


def _stands(situation: Situation) -> bool:
    """Whether it holds only for a stationary car."""
    return situation.name in ("parked", "standing")


def _moves(situation: Situation) -> bool:
    """Whether it holds only for a car that is faster than 0 km/h."""
    match situation:
        case Situation("driving" | "headway_below"):
            return True
        case Situation("speed_above" | "speed_between", (float() | int() as more_than, *_)):
            return more_than >= 0
    return False


def repeat(ground: Ground, simulations: WarmSimulations) -> Wrong:
    """Repeats the same seed."""
    again = Ground.reach(ground.task, ground.half_name, ground.seed, simulations)
    if (again.instance.goal, again.instance.parameters) != (ground.instance.goal, ground.instance.parameters):
        yield f"the same seed says {again.instance.goal!r} after {ground.instance.goal!r}"
    if again.episode.trace_sha256 != ground.episode.trace_sha256 or hash_of_oracle(again) != hash_of_oracle(ground):
        yield "the same seed gives another trace"
    again.close()


def hash_of_oracle(ground: Ground) -> str:
    """The trace hash of the reference solution."""
    return ground.reference.trace_sha256


def reach(task: Task, seed: int, simulations: WarmSimulations) -> Wrong:
    """Plays the task in every further scenario, in each half."""
    for scenario, half in product(task.scenarios, task.halves):
        try:
            ground = Ground.reach(task, half, seed, simulations, scenario)
        except (TriggerNotReachedError, ScenarioError) as error:
            yield f"{half} in {scenario}: {error}"
            continue
        with closing(ground):
            played = ground.play(ground.oracle())
        if not played.success:
            yield f"{half} in {scenario}: {played.why}"
