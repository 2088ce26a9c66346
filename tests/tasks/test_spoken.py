"""Laws over what drivers say in French, German and Japanese."""

import re
from contextlib import closing
from functools import cache
from itertools import cycle
from string import Formatter

import pytest

from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.cockpit.language import Language, word
from automotive_cosim.cockpit.occupants import Seat
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource, SessionSetup
from automotive_cosim.errors import UserError
from automotive_cosim.interface.spaces import GOAL_BYTES, SAID_BYTES
from automotive_cosim.tasking.dialogue import NEUTRAL, topic_of
from automotive_cosim.tasking.instance import Instance, draw, phrased
from automotive_cosim.tasking.moves import Consult
from automotive_cosim.tasking.parameters import FromCockpit
from automotive_cosim.tasking.reading import FOREIGN
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from tests.laws import over

EVERY = over((task, language) for task in CATALOGUE.values() for language in task.spoken)
ENGLISH = re.compile(r"\b(the|and|with|please|then|when|what|my|you|that|this|send|write|of|put)\b", re.IGNORECASE)
"""Words that no sentence in another of the languages has."""
JAPANESE = "\u3001-\u9fff"
WRONG = {
    Language.FRENCH: re.compile(r"[\"“”’]|[^ \u202f][;!?»]|[^ \u202f\d]:|«[^ \u202f]|  |\d\.\d"),
    Language.GERMAN: re.compile(r"[\"«»”’]| [;!?:]|  |\d\.\d"),
    Language.JAPANESE: re.compile(
        rf"[\"',;!?:“”„«»()](?!\d)|\.(?!\d)|\u3000| (?=[{JAPANESE}])|(?<=[{JAPANESE}]) |[０-９Ａ-Ｚａ-ｚ％]"
    ),
}
"""Marks as another language, or a careless typist, sets them."""
QUOTES = {Language.FRENCH: "«»", Language.GERMAN: "„“", Language.JAPANESE: "「」"}
NUMBERS = 4
"""Instances to try of each task."""
ON_THE_GRID = (
    "hard_fitting_moved",
    "hard_two_parents_write",
    "hard_bluetooth_back",
    "hard_a_part_taken_back",
    "hard_what_guests_may",
)
"""A message, a question, a word that is chosen, a remark, and a passenger's wish."""


def fields(template: str) -> list[str]:
    return sorted(name for _, name, _, _ in Formatter().parse(template) if name)


def instances(task: Task, language: Language) -> tuple[Instance, ...]:
    return _instances(task.id, language)


@cache
def _instances(task_id: str, language: Language) -> tuple[Instance, ...]:
    task = CATALOGUE[task_id]
    return tuple(draw(task, half, number, language=language) for half in task.halves for number in range(NUMBERS))


def test_the_languages_are_those_of_the_car():
    assert tuple(Language) == HMI.LANGUAGE.allowed
    assert tuple(Language)[1:] == FOREIGN


@over(CATALOGUE.of(Suite.HARD))
def test_the_hard_suite_is_said_in_every_language(task: Task):
    """Add its phrasings beside the English ones; or say, in the task, why it is in English alone."""
    assert task.languages == ((Language.ENGLISH,) if task.only_english else tuple(Language))


@EVERY
def test_there_are_as_many_phrasings_with_the_same_parameters(task: Task, language: Language):
    own = task.spoken[language].templates
    assert len(set(own)) == len(task.templates)
    assert [fields(template) for template in own] == [fields(template) for template in task.templates]


@EVERY
def test_every_value_that_is_said_has_its_word(task: Task, language: Language):
    speech = task.spoken[language]
    used = {name for template in task.templates for name in fields(template)}
    for name, choices in task.parameters.items():
        values = () if isinstance(choices, FromCockpit) or name not in used else choices
        for value in values:
            if not isinstance(value, str) or not re.search(r"[^\W\d_]{2}", value):
                continue
            shown = word(value, language)
            assert value in speech.words or shown != value, f"no word for {value!r}"
            assert shown in (value, speech.word(value)), f"the car shows {shown!r} for {value!r}"


@EVERY
def test_everything_said_later_is_in_that_language(task: Task, language: Language):
    for here, english in zip(instances(task, language), instances(task, Language.ENGLISH), strict=True):
        pairs = [
            *zip(here.half.says, english.half.says, strict=True),
            *(
                (move, other)
                for move, other in zip(here.moves, english.moves, strict=True)
                if isinstance(move, Consult)
            ),
        ]
        assert all(move.text != other.text for move, other in pairs), "add it to the lines of the task"
        for topic, other in zip(here.half.topics, english.half.topics, strict=True):
            assert topic.reply != other.reply
            words = [word for words in (*other.choices, other.about) for word in words if word.islower()]
            assert all(word in task.spoken[language].asked for word in words)
        assert here.half.neutral != NEUTRAL


@EVERY
def test_the_reference_solution_asks_what_the_driver_understands(task: Task, language: Language):
    for instance in instances(task, language):
        half = instance.half
        asked = [move.text for move in half.moves if isinstance(move, Consult)]
        assert all(topic_of(text, half.topics) in half.needed_topics for text in asked)
        assert all(topic in half.topics for topic in half.needed_topics)


@EVERY
def test_it_is_written_as_that_language_is(task: Task, language: Language):
    for instance in instances(task, language):
        half = instance.half
        lines = [says.text for says in half.says] + [topic.reply for topic in half.topics]
        names = [value for value in instance.parameters.values() if isinstance(value, str)]
        for text in (instance.goal, *lines, half.neutral):
            assert not WRONG[language].search(_without(text, names)), text
            assert not ENGLISH.search(_without(text, names)), text
            opened, closed = QUOTES[language]
            assert text.count(opened) == text.count(closed)
            assert text.endswith((".", "?", "!", "。", "？", "！", "」。"))
            assert (language is Language.JAPANESE) == bool(re.search("[\u3040-\u30ff]", text))


def _without(text: str, names: list[str]) -> str:
    for name in sorted({*names, "Family Market", "Union Market", "Sun Pharmacy"}, key=len, reverse=True):
        text = text.replace(name, "0")
    return text


@EVERY
def test_a_seed_draws_the_same_in_every_language(task: Task, language: Language):
    for number in range(NUMBERS):
        here, english = (draw(task, "first", number, language=each) for each in (language, Language.ENGLISH))
        assert (here.parameters, here.held_out) == (english.parameters, english.held_out)
        at, other = (
            phrased(task, "first", each.parameters, each.language).index(each.goal) for each in (here, english)
        )
        assert at == other


@EVERY
def test_the_observation_has_room_for_it(task: Task, language: Language):
    for instance in instances(task, language):
        assert len(instance.goal.encode()) <= GOAL_BYTES
        assert len("\n".join(says.text for says in instance.half.says).encode()) <= SAID_BYTES


@pytest.mark.parametrize("language", FOREIGN)
def test_every_seat_has_its_name(language: Language):
    lines = next(task.spoken[language] for task in CATALOGUE.values() if language in task.spoken).lines
    heard = {lines.said(f"From the {seat.words} seat: 42") for seat in Seat if seat is not Seat.DRIVER}
    assert len(heard) == len(Seat) - 1
    assert not [words for words in heard if "seat" in words or "rear" in words or "passenger" in words]


def test_a_task_without_phrasings_is_refused():
    with pytest.raises(UserError, match=r"road_speed_80_in_50.*no phrasings in German.*--language en"):
        draw(CATALOGUE["road_speed_80_in_50"], "first", 0, language=Language.GERMAN)
    with pytest.raises(UserError, match="no phrasings in French: a guest turns the car"):
        draw(CATALOGUE["hard_language_midway"], "first", 0, language=Language.FRENCH)


@pytest.mark.slow
def test_the_oracle_wins_in_traffic(simulations: Simulations):
    """What the words of the driver, the screens and the verdict share; the rest of the suite is solved without
    traffic (``test_solutions.py``)."""
    for task, language in zip(ON_THE_GRID, cycle(FOREIGN)):
        spec = EpisodeSpec(task, scenario="grid", conditions=Conditions(language=language))
        hand_over = SituationFinder(spec, simulations).find(SeedSource(0).next())
        with closing(Episode.take_over(hand_over, SessionSetup())) as episode:
            oracle = Oracle()
            oracle.reset(episode.goal)
            oracle.brief(episode.instance)
            assert episode.moments[0].signals[HMI.LANGUAGE.path] == language
            while episode.end is None:
                episode.step(oracle.act(episode.observation))
            assert episode.verdict is not None
            assert episode.verdict.success, (task, episode.verdict)
            assert episode.instance.goal in phrased(
                episode.instance.task, "first", episode.instance.parameters, language
            )
