"""Laws over the catalogue as a whole: it is as large, as varied and as spread as it claims."""

import itertools
import re
from collections import Counter
from dataclasses import replace

import pytest

from automotive_cosim.cockpit.language import Language
from automotive_cosim.cockpit.occupants import Kind, Seat
from automotive_cosim.contracts import GoalStatus, Reason
from automotive_cosim.tasking.catalogue import Catalogue
from automotive_cosim.tasking.dialogue import NEUTRAL, spoken_s
from automotive_cosim.tasking.instance import draw, instances
from automotive_cosim.tasking.own_files import check
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Basis, Differs, Dimension, Module, Task
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

TASKS = list(CATALOGUE.values())
SAFETY = [task for task in TASKS if task.is_safety]
LEAST = {
    Module.HVAC: (16, 12, 2, 6),
    Module.MEDIA: (14, 7, 2, 1),
    Module.MAPS: (12, 6, 8, 4),
    Module.ROAD: (6, 3, 16, 5),
    Module.PHENOMENON: (4, 4, 4, 14),
    Module.APPS: (7, 2, 1, 1),
    Module.SYSTEM: (10, 4, 1, 3),
    Module.COMMS: (6, 2, 1, 1),
}
"""By dimension, in ``Dimension``'s order; 185 together."""


FAMILIES = {Suite.SPEED: (60, 9, 4, tuple(Language)), Suite.VOICE: (30, 10, 1, (Language.ENGLISH,))}
"""The suites of families: how many pairs and families at least, how many in each, and the languages."""
OF_FAMILIES = [task for task in TASKS if task.suite in FAMILIES]


@over((suite, *counts) for suite, counts in FAMILIES.items())
def test_some_suites_are_of_families(suite, pairs, families, members, languages):
    found = Counter(task.templates for task in OF_FAMILIES if task.suite is suite)
    assert sum(found.values()) >= pairs
    assert len(found) >= families
    assert len({text for texts in found for text in texts}) == sum(map(len, found)), "a family's words are its own"
    assert min(found.values()) >= members
    assert all(task.second and task.languages == languages for task in OF_FAMILIES if task.suite is suite)


def halves(task: Task):
    return [task.half(name) for name in task.halves]


def share(count: int) -> float:
    return count / len(TASKS)


@pytest.mark.parametrize("module", list(Module))
def test_every_cell_has_its_tasks(module):
    counts = Counter(task.dimension for task in TASKS if task.module is module)
    short = {
        str(dimension): f"{counts[dimension]} of {least}"
        for dimension, least in zip(Dimension, LEAST[module], strict=True)
        if counts[dimension] < least
    }
    assert not short


def test_instances_run_into_the_millions_and_each_task_has_twenty():
    """Eight in the hard suite, whose messages and memos are written for each."""
    assert sum(map(instances, TASKS)) > 2_000_000
    assert [task.id for task in TASKS if instances(task) < (8 if task.suite == "hard" else 20)] == []


@over(TASKS)
def test_phrasings_differ(task):
    """Of the words two phrasings use together, they share at most 60 %."""
    for one, other in itertools.combinations(task.templates, 2):
        words = [set(re.findall(r"[a-z']+", re.sub(r"\{[^}]*\}", "", said.lower()))) for said in (one, other)]
        assert len(words[0] & words[1]) <= 0.6 * len(words[0] | words[1]), (one, other)


@over(TASKS)
def test_who_speaks_is_aboard_and_awake(task):
    for name in task.halves:
        start = draw(task, name, 0).half.start
        voices = [one for one in start.aboard if one.seat is start.voice]
        if start.voice is not Seat.DRIVER:
            assert [one.kind.speaks and not one.asleep for one in voices] == [True]


ABOARD = {
    r"beside me|next to me|(?<!those )behind us|back there|in the back|my passenger|one of us|interrupting us": (
        frozenset(Kind)
    ),
    r"\b(my|the|those|our) (kids?|twins?|sons?|daughter|little ones?)\b|our smallest": {Kind.CHILD, Kind.BABY},
    r"\bbaby\b|\binfant\b": {Kind.BABY},
    r"grann?y|grandma|grandpa|old lady|\bgran\b": {Kind.ELDERLY},
    r"the dog|my dog|\brex\b|\bbello\b": {Kind.PET},
    r"my (wife|neighbour|friend)": {Kind.ADULT, Kind.ELDERLY},
}
"""How a wish speaks of somebody in the car, and what may sit there then."""
ELSEWHERE = {
    "maps_ask_which_museum": "the children are in the museum",
    "maps_headache": "the little one is at home",
    "media_ask_which_side": "the twins have yet to get in",
    "system_ask_which_child_lock": "Granny has yet to get in",
    "hard_photo_of_the_bench": "the child has yet to get in",
    "road_heavy_foot": "the wife hears of the fine at home",
    "road_children_about": "the wife complains at other times",
    "hard_window_comes_down": "the rear window switches are called the kids'",
    "system_trunk_open": "the bags are in the trunk",
}
"""Tasks whose words speak of others who are not in the car, and where they are."""


@over(TASKS)
def test_whoever_a_wish_says_is_in_the_car_sits_in_it(task):
    """In one half at least, for who is there may be the difference."""
    if task.id in ELSEWHERE:
        return
    seated = {one.kind for name in task.halves for one in draw(task, name, 0).half.start.aboard}
    for pattern, kinds in ABOARD.items():
        said = [words for words in task.templates if re.search(pattern, words, re.IGNORECASE)]
        assert not said or seated & kinds, (said, sorted(seated))


@over(TASKS)
def test_no_reason_fits_wherever_nothing_has_to_be_done(task):
    for half in halves(task):
        assert half.declares is not GoalStatus.NOT_NEEDED or Reason.NONE in half.reasons


@over(task for task in TASKS if task.differs and task.differs <= {Differs.ABOARD, Differs.VOICE})
def test_there_is_time_to_ask_the_driver_where_others_are_aboard(task):
    """An attentive person may ask whether it is to be done; question and answer must not cost the deadline."""
    asked_s = spoken_s("Is that really to be done, with them in the car?", NEUTRAL)
    for half in halves(task):
        assert half.deadline.seconds >= asked_s + 5.0, half.deadline


def test_the_seat_that_speaks_is_heard():
    task = next(iter(TASKS))
    behind = replace(task, first=replace(task.first, start=replace(task.first.start, voice=Seat.REAR_LEFT)))
    assert draw(behind, "first", 0).goal == f"From the rear left seat: {draw(task, 'first', 0).goal}"


def test_no_two_tasks_share_goal_trigger_and_reference_solution():
    """What triggers a task is its condition in the situation that it starts from."""
    told = Counter(
        repr([(half.goal, half.start, half.trigger, half.moves) for half in halves(task)]) for task in TASKS
    )
    assert max(told.values()) == 1


def test_no_text_belongs_to_two_tasks():
    """But to the members of a family."""
    said = Counter(
        text.casefold()
        for text in (
            *{text for task in OF_FAMILIES for text in task.templates},
            *(text for task in TASKS if task not in OF_FAMILIES for text in set(task.templates)),
        )
    )
    assert [text for text, count in said.items() if count > 1] == []


def test_triggers_ask_many_things():
    def asked(condition: object) -> set[str]:
        parts = getattr(condition, "conditions", ()) or tuple(filter(None, [getattr(condition, "condition", None)]))
        parts += tuple(each for each in getattr(condition, "values", ()) if callable(each))
        return set().union({getattr(condition, "name", type(condition).__name__)}, *map(asked, parts))

    kinds = set().union(*(asked(half.trigger.condition) for task in TASKS for half in halves(task)))
    assert len(kinds - {"All", "Not"}) >= 25


def test_goals_ask_many_things():
    def kinds(check: object) -> frozenset[str]:
        parts = getattr(check, "checks", ())
        if parts:
            return frozenset().union(*map(kinds, parts))
        return frozenset({getattr(check, "name", type(check).__name__)})

    pairs = set()
    for task in TASKS:
        for name in task.halves:
            goal = draw(task, name, 0).half.goal
            pairs.add((kinds(goal), goal.writes))
    assert len(pairs) >= 110


def test_many_tasks_are_long():
    steps = [task.optimal_steps for task in TASKS]
    assert share(sum(count >= 4 for count in steps)) >= 0.4
    assert share(sum(count >= 7 for count in steps)) >= 0.1


@pytest.mark.parametrize(
    ("tag", "least"), [("two_modules", 15), ("conflict", 8), ("preference", 10), ("locked", 12), ("place", 10)]
)
def test_special_kinds_are_there(tag, least):
    assert sum(tag in task.tags for task in TASKS) >= least


def test_what_is_locked_can_be_done_when_parked():
    for task in TASKS:
        if "locked" in task.tags:
            assert task.dimension is Dimension.EXPLICIT_CONTROL
            assert task.first.start.parked
            assert task.second is not None
            assert not task.second.start.parked


def test_safety_tasks_are_spread_over_scenarios():
    own = Counter(task.first.start.scenario for task in SAFETY)
    assert max(own.values()) <= len(SAFETY) / 4
    assert sum(count >= 4 for count in own.values()) >= 8


def test_a_third_of_the_second_halves_want_another_act():
    acts = sum(task.second is not None and task.second.declares is GoalStatus.COMPLETE for task in SAFETY)
    assert acts >= len(SAFETY) / 3


def test_translated_pairs_differ_in_place_alone():
    translated = 0
    for task in SAFETY:
        assert task.second is not None
        one, other = task.first.start, task.second.start
        if one.scenario == other.scenario and one.origin != other.origin:
            assert one.origin is not None
            assert other.origin is not None
            assert (one.trip, one.driver, one.sign_camera) == (other.trip, other.driver, False)
            translated += 1
    assert translated >= 10


def test_forty_safety_tasks_rest_on_verified_law_in_eight_countries():
    lawful = [task for task in SAFETY if any(half.basis is Basis.LAW for half in halves(task))]
    countries = {
        rule[:2] for task in lawful for half in halves(task) if half.basis is Basis.LAW for rule in [half.rule]
    }
    assert len(lawful) >= 40
    assert len(countries) >= 8


WISH = re.compile(
    r"\b(warn|alert|alarm|tell|say|speak|shout|sound|call out|object|announce|remind|name|noise|loudly|watch"
    r"|figure|pipe up)",
    re.IGNORECASE,
)
"""What asks for a warning, not for an answer."""


REQUEST = re.compile(r"\b(please|(would|will|could|can) (you|we|i))\b", re.IGNORECASE)


@over(task for task in TASKS if task.second and not task.first.tells)
def test_nobody_asks_a_mere_question_where_an_act_counts(task):
    questions = [said for said in task.templates if said.rstrip().endswith("?")]
    assert [said for said in questions if not (WISH.search(said) or REQUEST.search(said))] == []


def _warns(task: Task) -> bool:
    found = [draw(task, name, 0).half.goal for name in task.halves]
    return any("alerts" in goal.writes for goal in found)


@over(task for task in TASKS if _warns(task))
def test_where_only_a_warning_counts_nobody_asks_a_mere_question(task):
    assert [said for said in task.templates if "?" in said and not WISH.search(said)] == []


@over(CATALOGUE.values())
def test_what_is_required_of_a_users_task_holds_of_ours(task):
    Catalogue().add(task)
    assert not [str(error) for half in task.halves for _, error in check(task.half(half))]
