"""Laws over the pairs in which the driver is asked, and those in which he changes his mind."""

from itertools import combinations

from automotive_cosim.agents.trivial import AlwaysAsk
from automotive_cosim.cockpit.actions import TEXT_LIMIT
from automotive_cosim.contracts import Observation
from automotive_cosim.tasking.checks import not_asked
from automotive_cosim.tasking.dialogue import topic_of
from automotive_cosim.tasking.instance import Instance, draw
from automotive_cosim.tasking.moves import Consult, Hear, Open, Tap
from automotive_cosim.tasking.parameters import names
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Module, Task
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

ASKING = [task for task in CATALOGUE.of(Suite.STANDARD) if "asking" in task.tags]
CHANGED = [task for task in CATALOGUE.values() if "second_thoughts" in task.tags]


def drawn(task: Task, half: str = "first") -> list[Instance]:
    """As many instances as there can be different ones of what is meant."""
    return [draw(task, half, number) for number in range(40)]


def question_of(instance: Instance) -> str:
    (question,) = (move.text for move in instance.moves if isinstance(move, Consult))
    return question


def test_there_are_forty_pairs_over_every_module():
    assert len(ASKING) >= 40
    assert {task.module for task in ASKING} == set(Module)


@over(ASKING)
def test_the_question_comes_first_names_every_choice_and_gets_what_is_meant(task):
    for instance in drawn(task):
        (topic,) = instance.half.topics
        question = question_of(instance)
        asks_at = next(number for number, move in enumerate(instance.moves) if isinstance(move, Consult))
        assert all(isinstance(move, Open | Tap) for move in instance.moves[:asks_at])  # only looks before
        assert len(question) <= TEXT_LIMIT
        assert topic.named(question) == len(topic.choices) >= 2
        assert topic_of(question, instance.half.topics) is topic
        assert instance.half.needed_topics == (topic,)
    replies = {instance.parameters["which"]: instance.half.topics[0].reply for instance in drawn(task)}
    assert len(set(replies.values())) == len(replies) >= 2


@over(ASKING)
def test_nothing_tells_what_is_meant_where_it_has_to_be_asked(task):
    first, second = task.first, task.second
    assert "which" not in names((task.templates, first.start, first.trigger))
    assert "which" in names(second.start)
    assert "which" in names(first.goal)


@over(ASKING)
def test_where_it_can_be_found_out_a_question_loses(task):
    for instance in drawn(task, "second"):
        assert not_asked() in instance.half.goal.checks
        assert not any(isinstance(move, Consult) for move in instance.moves)
        assert instance.half.topics


@over(ASKING)
def test_one_choice_is_no_question_and_a_vague_one_names_none(task):
    agent = AlwaysAsk()
    agent.reset("")
    vague = agent.act(Observation("", 0.0, None)).text  # type: ignore[arg-type]
    for instance in drawn(task)[:4]:
        (topic,) = instance.half.topics
        assert topic.named(vague) < len(topic.choices)
        for words in topic.choices:
            assert topic.named(" ".join(words)) < len(topic.choices)


def test_no_two_share_goal_trigger_and_solution():
    for one, other in combinations([*ASKING, *CHANGED], 2):
        for half in ("first", "second"):
            mine, theirs = one.half(half), other.half(half)
            assert (mine.goal, mine.trigger, mine.moves) != (theirs.goal, theirs.trigger, theirs.moves)


@over(CHANGED)
def test_a_changed_mind_is_heard_only_in_the_half_where_it_changes(task):
    for number in range(20):
        first, second = (draw(task, half, number) for half in task.halves)
        (heard,) = (move.text for move in first.moves if isinstance(move, Hear))
        assert any(heard in says.text for says in first.half.says)
        assert second.half.says == ()
        assert first.half.goal != second.half.goal
