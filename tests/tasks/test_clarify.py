"""Laws over the suite of wishes that have to be made clear."""

from automotive_cosim.tasking.checks import not_asked
from automotive_cosim.tasking.dialogue import topic_of
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.moves import Consult
from automotive_cosim.tasking.parameters import names
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

CLARIFY = CATALOGUE.of(Suite.CLARIFY)


def test_there_are_thirty_pairs_and_more_of_every_module():
    assert len(CLARIFY) >= 30
    assert {task.module for task in CLARIFY} == set(Module)
    assert not any(task.id.startswith("clarify_") for task in CATALOGUE.of(Suite.STANDARD))


@over(CLARIFY)
def test_only_the_second_half_tells_what_is_meant_and_there_a_question_loses(task):
    assert task.id.startswith("clarify_")
    assert task.second is not None
    assert len(task.templates) == 5
    assert "which" not in names((task.templates, task.first.start))
    assert "which" in names(task.second.start)
    assert not_asked() in task.second.goal.checks
    assert not any(isinstance(move, Consult) for move in task.second.moves)


@over(CLARIFY)
def test_one_question_names_every_choice_and_gets_what_is_meant(task):
    drawn = [draw(task, "first", number) for number in range(40)]
    for instance in drawn:
        (topic,) = instance.half.topics
        (question,) = (move.text for move in instance.moves if isinstance(move, Consult))
        assert len(question) <= 120
        assert topic.named(question) == len(topic.choices) >= 2
        assert topic_of(question, instance.half.topics) is topic
        assert instance.half.needed_topics == (topic,)
        for choice in topic.choices:
            assert topic.named(" ".join(choice)) < len(topic.choices)
    replies = {instance.parameters["which"]: instance.half.topics[0].reply for instance in drawn}
    assert len(set(replies.values())) == len(replies) >= 2


@over(CLARIFY)
def test_guessing_asking_too_late_and_asking_what_is_known_are_tried_and_lose(task):
    """The gate ``slip`` plays them."""
    (guess, late), (needless,) = task.first.slips, task.second.slips
    assert not any(isinstance(move, Consult) for move in guess)
    assert isinstance(late[-1], Consult)
    assert isinstance(needless[0], Consult)
