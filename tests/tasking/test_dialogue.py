"""The driver who answers: what a question is about, what it costs, and what the driver says by himself."""

from dataclasses import dataclass, field
from typing import Any

import pytest

from automotive_cosim.tasking.checks import AllOf, asked_first, asked_in, not_asked, nothing_done
from automotive_cosim.tasking.dialogue import NEUTRAL, Says, Topic, dialogue, questions, spoken_s, topic_of

WHO = Topic("which Nora", (("keller", "nora keller"), ("holm", "nora holm")), "Nora Holm.", ("nora", "which one"))
WHERE = Topic("which way", (("tunnel",), ("bridge",)), "Over the bridge.", ("way",))


@dataclass(frozen=True)
class At:
    """As much of a moment as a dialogue looks at."""

    commands: dict[str, Any] = field(default_factory=dict)
    time_s: float = 0.0


def at(*asked: str, given: int = 0, time_s: float = 0.0, **commands: Any) -> Any:
    return At({"questions": [{"text": text, "commands": given} for text in asked], **commands}, time_s)


@pytest.mark.parametrize(
    "question",
    [
        "Nora Keller or Nora Holm?",
        "Do you mean Nora Holm, or Keller?",
        "NORA KELLER / NORA HOLM",
        "Which one: Keller's or Holm's number?",
        "Which Nora?",
    ],
)
def test_the_same_question_in_other_words_gets_the_same_answer(question):
    assert topic_of(question, [WHERE, WHO]) is WHO


@pytest.mark.parametrize("question", ["", "?", "What do you want?", "Kellermann or Stockholm?", "Is it late?"])
def test_a_question_about_something_else_gets_an_answer_that_does_not_help(question):
    assert topic_of(question, [WHERE, WHO]) is None
    (asked,) = dialogue([question], [WHERE, WHO], [WHO])
    assert (asked.reply, asked.is_needed) == (NEUTRAL, False)


def test_alternatives_are_found_as_whole_words():
    assert WHO.named("Keller or Holm?") == 2
    assert WHO.named("Nora Keller?") == 1
    assert WHO.named("Which Nora?") == 0
    assert WHO.named("Kellerholm?") == 0


def test_only_the_first_question_about_what_must_be_asked_is_needed():
    asked = dialogue(["Keller or Holm?", "Holm, not Keller?", "Which way?"], [WHO, WHERE], [WHO])
    assert [question.is_needed for question in asked] == [True, False, False]
    assert [question.reply for question in asked] == ["Nora Holm.", "Nora Holm.", "Over the bridge."]


def test_talking_takes_time():
    assert spoken_s("Yes.") == 1.0
    assert spoken_s("one two three four five", "six seven eight nine ten") == 4.0
    assert spoken_s(" ".join(["word"] * 30), NEUTRAL) > spoken_s("Which?", NEUTRAL) > spoken_s("Which?")


@pytest.mark.parametrize(
    ("now", "right"),
    [
        (at("Keller or Holm?"), True),
        (at(), False),
        (at("Which Nora?"), False),
        (at("Keller?"), False),
        (at("Keller or Holm?", "Keller or Holm?"), False),
        (at("What's up?", "Keller or Holm?"), False),
        (at("Keller or Holm?", given=1), False),
    ],
)
def test_asking_is_one_question_first_that_names_every_alternative(now, right):
    assert asked_first(WHO).holds(at(), now, [now]) is right
    assert not_asked().holds(at(), now, [now]) is (not questions(at(), now))


def test_a_goal_says_what_must_be_asked():
    assert tuple(asked_in(AllOf((nothing_done(), AllOf((asked_first(WHO),)))))) == (WHO,)
    assert tuple(asked_in(not_asked())) == ()


@pytest.mark.parametrize(
    ("says", "now", "steps", "due"),
    [
        (Says("No."), at(), 1, True),
        (Says("No.", step=3), at(), 2, False),
        (Says("No.", step=3), at(), 3, True),
        (Says("No.", time_s=5.0), at(time_s=4.0), 9, False),
        (Says("No.", time_s=5.0), at(time_s=5.0), 1, True),
        (Says("No.", changed=frozenset({"horn"})), at(horn=0), 9, False),
        (Says("No.", changed=frozenset({"horn"})), at(horn=1), 1, True),
        (Says("No.", unchanged=frozenset({"horn"})), at(horn=0), 9, True),
        (Says("No.", unchanged=frozenset({"horn"})), at(horn=1), 9, False),
        (Says("No.", after=1), at(), 9, False),
        (Says("No.", after=1), at("Which Nora?"), 1, True),
        (Says("No.", when=lambda moment: moment.time_s > 2.0), at(time_s=2.0), 9, False),
        (Says("No.", step=2, time_s=5.0), at(time_s=5.0), 1, False),
    ],
)
def test_a_remark_is_due_once_all_that_it_waits_for_is_so(says, now, steps, due):
    assert says.is_due(at(horn=0), now, steps) is due
    assert str(says)


def test_japanese_is_heard_without_spaces_and_takes_its_time() -> None:
    ben = Topic("the time", (("16:15", "isla"), ("16:45", "malik")), "16:45", ("time", "迎え"))
    other = Topic("the place", (("home",), ("work",)), "home", ("place", "場所"))
    for question in ("Islaさんの16:15ですか、Malikさんの16:45ですか？", "お迎えは１６：１５、それとも１６：４５？"):
        assert topic_of(question, (other, ben)) is ben
        assert ben.named(question) == 2
    assert topic_of("場所はどこですか？", (other, ben)) is other
    assert topic_of("何かありますか？", (other, ben)) is None
    assert spoken_s("お迎えは何時ですか、それともあとで決めますか") == spoken_s(" ".join(["word"] * 11))


def test_what_no_topic_is_about_gets_the_given_answer() -> None:
    (asked,) = dialogue(["Which?"], (), (), "Weiß ich nicht.")
    assert (asked.reply, asked.is_needed) == ("Weiß ich nicht.", False)
