"""Laws over the suite in which the cabin's sound decides, or who said it."""

from automotive_cosim.tasking.checks import not_asked
from automotive_cosim.tasking.dialogue import asks_again, topic_of, untold, words_of
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.moves import Consult, Inform
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.voice import table
from tests.laws import over

VOICE = CATALOGUE.of(Suite.VOICE)
BY_KIND = {
    kind: [task for task in VOICE if task.id.startswith(f"voice_{kind}_")]
    for kind in ("ask", "heed", "quiet", "over", "brief", "merge", "siren")
}


def asks(moves):
    return any(isinstance(move, Consult) for move in moves)


@over(BY_KIND["ask"])
def test_in_noise_a_guess_loses_and_in_quiet_a_question(task):
    """The gate ``slip`` plays them."""
    assert any(getattr(check, "name", "") == "asked_back" for check in task.first.goal.checks)
    assert not_asked() in task.second.goal.checks
    assert asks(task.first.moves)
    assert not asks(task.first.slips[0])
    assert not asks(task.second.moves)
    assert asks(task.second.slips[0])


@over(BY_KIND["ask"])
def test_whoever_asks_for_it_again_is_told_in_other_words(task):
    for number in range(8):
        half = draw(task, "first", number).half
        (question,) = (move.text for move in half.moves if isinstance(move, Consult))
        for words in (question, "Could you say that again?", "Pardon?", "I didn't catch that."):
            assert topic_of(words, half.topics) == half.topics[0]
        assert half.topics[0].choices[0][0].casefold() in half.topics[0].reply.casefold()


@over(BY_KIND["heed"])
def test_the_same_words_come_from_the_driver_or_from_elsewhere(task):
    for number in range(8):
        (mine,), (theirs,) = (draw(task, name, number).half.says for name in task.halves)
        assert theirs.text.startswith("From the ")
        assert list(table.pieces(theirs.text)) == list(table.pieces(mine.text)) == [mine.text]


@over(BY_KIND["quiet"])
def test_what_is_loud_in_one_half_is_soft_in_the_other(task):
    loud, soft = task.first.start.signals, task.second.start.signals
    assert loud != soft
    assert not task.first.goal.writes & task.second.goal.writes


@over(BY_KIND["over"])
def test_who_talks_over_the_car_is_the_driver_or_somebody_else_and_it_has_to_be_said_again(task):
    for number in range(8):
        (mine,), (theirs,) = (draw(task, name, number).half.says for name in task.halves)
        assert mine.over_s == theirs.over_s > 0
        assert list(table.pieces(theirs.text)) == list(table.pieces(mine.text)) == [mine.text]
        assert theirs.text.startswith("From the ")
    for half in (task.first, task.second):
        said = [move.text for move in half.moves if isinstance(move, Inform)]
        assert len(said) == len(set(said)) + 1


@over(BY_KIND["brief"])
def test_at_the_wheel_there_is_time_for_a_few_words(task):
    assert task.first.most_words is not None is task.second.most_words
    for number in range(8):
        moving, standing = (draw(task, name, number).half for name in task.halves)
        short, long = (
            [move.text for move in half.moves if isinstance(move, Inform)] for half in (moving, standing)
        )
        assert words_of(short) <= moving.most_words < words_of(long)
        assert not untold(long, [*moving.tells, *standing.tells])


@over(BY_KIND["merge"] + BY_KIND["siren"])
def test_on_a_slip_road_and_near_a_siren_the_question_waits(task):
    waits = "asked_on" if task in BY_KIND["merge"] else "asked_without_siren"
    assert any(getattr(check, "name", "") == waits for check in task.first.goal.checks)
    assert asks(task.first.moves)
    assert asks(task.second.moves)
    assert asks(task.first.slips[0][:1])


def test_every_pair_is_of_a_kind_and_may_be_asked_to_repeat():
    assert sum(map(len, BY_KIND.values())) == len(VOICE) >= 60
    for words in ("Sorry, say that again?", "Could you repeat that?", "I didn’t catch that.", "What did you say?"):
        assert asks_again(words)
    for words in ("Shall I shut the window?", "Which one, Tara or Dara?", "Should the fan go to 50 percent?"):
        assert not asks_again(words)
