"""The cycle: what is asked, what is recorded, what is carried on, and what stops it."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from automotive_cosim.agents import PROFILES, AgentPart, AgentSettings, ModelAgent, StageName, make_agent
from automotive_cosim.agents.marks import png
from automotive_cosim.agents.memory import Memory
from automotive_cosim.contracts import Action, ActionType, Feedback, FeedbackCode, GoalStatus, Observation
from automotive_cosim.contracts.given import Interface
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import ActionError, OutOfBudgetError, UnknownNameError, UserError
from automotive_cosim.interface.controls import GeoInput
from automotive_cosim.interface.observe import ALL, Channel, See
from automotive_cosim.models import ChatMessage, ModelReply

COUNTRY = "Place: Beauce, France\nSpeed limit here: 80 km/h (posted on D 24)"
TAP = 'Situation: speeding\nPlan: then warn\nAction: {"action_type": "click", "index": 0}'
FAILED = Feedback(FeedbackCode.NO_EFFECT, "")
DONE = 'Action: {"action_type": "status", "goal_status": "complete"}'


@dataclass
class Scripted:
    """A model that says what it is told to and notes what it was asked."""

    answers: Sequence[str]
    sees_pictures: bool = False
    finish: str = "stop"
    tokens: int = 100
    asked: list[ChatMessage] = field(default_factory=list)
    name: str = "scripted"

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        self.asked.append(messages[-1])
        text = self.answers[(len(self.asked) - 1) % len(self.answers)]
        return ModelReply(text, self.tokens, 10, 0.01, 2.0, self.finish)


@pytest.fixture
def agent() -> Callable[..., tuple[ModelAgent, Scripted]]:
    def make(*answers: str, profile: str = "t3a", sees: bool = False, finish: str = "stop", **settings: object):
        model = Scripted(answers, sees, finish)
        made = ModelAgent(PROFILES[profile], model, AgentSettings(**settings))
        made.reset("Watch my speed")
        return made, model

    return make


def play(agent_name: str, seen: Observation, most: int = 6) -> list[Action]:
    made = make_agent(agent_name)
    made.reset(seen.goal)
    actions: list[Action] = []
    while len(actions) < most and (not actions or actions[-1].action_type is not ActionType.STATUS):
        actions.append(made.act(seen))
    return actions


def test_an_answer_can_only_call_what_is_offered(agent, observation):
    made, model = agent(DONE, conditions=Conditions(interface=Interface.FUNCTIONS))
    made.act(observation("Watch my speed"))
    form, text = model.asked[0].form, model.asked[0].text
    kinds = form["properties"]["action"]["anyOf"]
    (called,) = (kind["properties"]["function"]["enum"] for kind in kinds if "function" in kind["properties"])
    assert "set_hvac_temperature" in called
    assert all(f"- {name}(" in text for name in called)
    assert '"function": "' not in text, "small models call an example whatever is asked for"


# --- with the rule model: the prompt carries the information --------------------------------------------------


def test_with_place_it_warns_of_80_in_a_50(observation):
    kinds = [action.action_type for action in play("asurada", observation("Let me know if I'm going too fast."))]
    assert kinds == [ActionType.OPEN_APP, ActionType.CLICK, ActionType.CLICK, ActionType.STATUS]


def test_swapping_the_context_flips_its_act(observation):
    in_the_country = play("asurada", observation("Let me know if I'm going too fast.", COUNTRY))
    assert [action.goal_status for action in in_the_country] == [GoalStatus.NOT_NEEDED]


@pytest.mark.parametrize("name", ["t3a", "m3a"])
def test_without_place_it_cannot_tell(observation, name):
    assert [action.goal_status for action in play(name, observation("My speed"))] == [GoalStatus.NOT_NEEDED]


# --- the stages ---------------------------------------------------------------------------------------------


def test_each_stage_is_recorded_with_what_it_took(agent, observation):
    made, model = agent(TAP, "Lesson: it is locked", DONE)
    made.act(observation("x"))
    assert [stage.name for stage in made.stages] == ["perceive", "interpret", "plan", "act"]
    made.act(observation("x", time_s=1.0, feedback=Feedback(FeedbackCode.RESTRICTED, "locked")))
    assert [stage.name for stage in made.stages] == ["reflect", "remember", "perceive", "interpret", "plan", "act"]
    by_name = {stage.name: stage for stage in made.stages}
    assert by_name[StageName.REFLECT].text == "it is locked"
    assert by_name[StageName.PERCEIVE].text == model.asked[2].text
    replies = [stage.reply for stage in made.stages if stage.reply]
    assert [(reply.tokens_in, reply.cost_usd, reply.seconds) for reply in replies] == [(100, 0.01, 2.0)] * 2
    assert {stage.at_s for stage in made.stages} == {1.0}


@pytest.mark.parametrize("code", FeedbackCode)
def test_a_lesson_is_asked_for_after_a_failure_alone(agent, observation, code):
    made, model = agent(TAP, "Lesson: so", TAP)
    made.act(observation("x"))
    with suppress(ActionError):
        made.act(observation("x", feedback=Feedback(code, "")))
    asked = any("Lesson: ..." in message.text for message in model.asked)
    assert asked == (code not in (FeedbackCode.NONE, FeedbackCode.OK, FeedbackCode.READ_OUT))


def test_history_and_plan_are_carried_on(agent, observation):
    made, model = agent(TAP, "Lesson: it is locked", DONE)
    made.act(observation("x"))
    made.act(observation("x", feedback=Feedback(FeedbackCode.RESTRICTED, "not now")))
    asked = model.asked[2].text
    assert "Step 1 at 0 s: click" in asked
    assert "Speed -> restricted not now; it is locked" in asked
    assert "## Your plan\nthen warn" in asked


def test_a_new_episode_begins_with_nothing(agent, observation):
    made, model = agent(TAP)
    made.act(observation("x"))
    made.act(observation("x"))
    made.reset("x")
    made.act(observation("x"))
    assert model.asked[-1].text == model.asked[0].text


def test_without_reflection_it_is_asked_once_a_turn(agent, observation):
    made, model = agent(TAP, without=frozenset({AgentPart.REFLECTION}))
    for _ in range(3):
        made.act(observation("x"))
    assert len(model.asked) == 3
    assert "Step 2 at 0 s: click" in model.asked[2].text


def test_an_unreadable_answer_is_recorded_with_what_was_wrong(agent, observation):
    made, model = agent("no idea", "Lesson: answer in form", TAP)
    with pytest.raises(ActionError, match="no JSON"):
        made.act(observation("x"))
    assert made.stages[-1].name is StageName.ACT
    assert made.stages[-1].reply.text == "no idea"
    made.act(observation("x", feedback=Feedback(FeedbackCode.MALFORMED, "no JSON")))
    assert "Step 1 at 0 s: unreadable answer -> malformed no JSON; answer in form" in model.asked[2].text


def test_an_answer_that_was_cut_off_is_told_so(agent, observation):
    made, _ = agent("Situation: it is", finish="length")
    with pytest.raises(ActionError, match="cut off"):
        made.act(observation("x"))


def test_an_action_that_it_was_not_offered_is_refused(agent, observation):
    made, _ = agent('Action: {"action_type": "query", "text": "rules"}')
    with pytest.raises(ActionError, match="no action query"):
        made.act(observation("x"))


# --- pictures -------------------------------------------------------------------------------------------------


@pytest.fixture
def seen(observation):
    return observation("x", screenshot=np.zeros((720, 1280, 3), np.uint8))


def test_m3a_sends_the_screen_and_the_marked_screen_then_before_and_after(agent, seen):
    made, model = agent(TAP, "Lesson: so", profile="m3a", sees=True)
    made.act(seen)
    made.act(replace(seen, feedback=FAILED))
    assert [len(message.pictures) for message in model.asked] == [2, 2, 2]
    raw, marked = model.asked[0].pictures
    assert raw != marked
    assert raw.startswith(b"\x89PNG")
    assert model.asked[1].pictures == (marked, marked)
    assert "## The pictures" in model.asked[0].text


@pytest.mark.parametrize(
    ("profile", "sees", "without"),
    [
        ("t3a", True, ()),
        ("m3a", False, ()),
        ("m3a", True, (AgentPart.SCREEN,)),
        ("asurada", True, (AgentPart.SCREEN,)),
    ],
)
def test_no_pictures_where_there_are_none_to_be(agent, seen, profile, sees, without):
    made, model = agent(TAP, profile=profile, sees=sees, without=frozenset(without))
    made.act(seen)
    assert model.asked[0].pictures == ()
    assert "## The pictures" not in model.asked[0].text


def test_the_rule_models_m3a_does_what_its_t3a_does(seen):
    assert play("m3a", seen) == play("t3a", seen)


# --- switches, memory, budgets ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("settings", "lost"),
    [
        ({"without": frozenset({AgentPart.GPS})}, {Channel.GPS}),
        ({"without": frozenset({AgentPart.CONTEXT})}, {Channel.CONTEXT}),
        ({"without": frozenset({AgentPart.SCREEN})}, {Channel.SCREENSHOT}),
        ({"conditions": Conditions(GeoInput.GPS)}, {Channel.CONTEXT}),
        ({"conditions": Conditions(GeoInput.CONTEXT)}, {Channel.GPS}),
        ({"conditions": Conditions(GeoInput.NONE)}, {Channel.GPS, Channel.CONTEXT}),
        ({"conditions": Conditions(GeoInput.IRRELEVANT)}, {Channel.GPS}),
        ({"conditions": Conditions(GeoInput.WRONG)}, set()),
    ],
    ids=["gps", "context", "screen", "geo gps", "geo context", "geo none", "geo irrelevant", "geo wrong"],
)
def test_switches_take_channels_away(settings, lost):
    made = make_agent("asurada", settings=AgentSettings(**settings))
    assert ALL - made.channels == lost


def test_memory_is_off_unless_it_is_given_a_file(agent, observation, tmp_path):
    made, _ = agent(TAP, profile="asurada")
    made.act(observation("x"))
    made.learn(True)
    assert "remember" not in [stage.name for stage in made.stages]
    without, _ = agent(TAP, profile="asurada", memory=tmp_path / "m", without=frozenset({AgentPart.MEMORY}))
    without.act(observation("x"))
    without.learn(True)
    assert not (tmp_path / "m").exists()


def test_what_worked_is_read_in_the_next_episode(agent, observation, tmp_path):
    made, _ = agent(TAP, DONE, profile="asurada", memory=tmp_path / "m")
    made.act(observation("Watch my speed"))
    made.act(observation("Watch my speed"))
    made.learn(True)
    kept = Memory(tmp_path / "m").all()
    assert [(found.place, found.worked) for found in kept] == [("Paris, France", 1)]
    assert kept[0].steps == "click index=Speed > status goal_status=complete"
    later, model = agent(TAP, profile="asurada", memory=tmp_path / "m")
    later.act(observation("Watch my speed again"))
    assert kept[0].steps in model.asked[0].text
    assert later.stages[0].name is StageName.REMEMBER
    elsewhere, model = agent(TAP, profile="asurada", memory=tmp_path / "m")
    elsewhere.act(observation("Watch my speed", COUNTRY))
    assert "What worked here before" not in model.asked[0].text


def test_what_failed_is_not_read_again(agent, observation, tmp_path):
    for _ in range(2):
        made, model = agent(TAP, profile="asurada", memory=tmp_path / "m")
        made.act(observation("Watch my speed"))
        made.learn(False)
    assert "What worked here before" not in model.asked[0].text


@pytest.mark.parametrize("budget", [{"most_tokens": 250}, {"most_seconds": 5.0}])
def test_a_budget_stops_a_runaway(agent, observation, budget):
    made, model = agent(TAP, **budget)
    made.act(observation("x"))
    with pytest.raises(OutOfBudgetError, match="budget"):
        list(map(made.act, [observation("x")] * 50))
    assert len(model.asked) == 3
    made.reset("x")
    made.act(observation("x"))


def test_unknown_agents_and_models_suggest_the_nearest():
    with pytest.raises(UnknownNameError, match="asurada"):
        make_agent("asurda")
    with pytest.raises(UnknownNameError, match="rules"):
        make_agent("t3a", "ruls")


def test_the_picture_alone_comes_without_list_and_index(agent, observation):
    made, model = agent(
        'Action: {"action_type": "click", "x": 5, "y": 6}',
        profile="m3a",
        sees=True,
        conditions=Conditions(see=See.PICTURE),
    )
    seen = observation("Watch my speed", elements=None, screenshot=np.zeros((720, 1280, 3), np.uint8))
    assert made.channels.isdisjoint({Channel.ELEMENTS})
    for now in (seen, replace(seen, feedback=FAILED)):
        assert made.act(now) == Action(ActionType.CLICK, x=5, y=6)
    first, back, _ = model.asked
    assert "index" not in first.text
    assert "## The screen" not in first.text
    assert (len(first.pictures), len(back.pictures)) == (1, 2)


def test_the_road_comes_as_the_last_picture(agent, observation):
    made, model = agent(TAP, profile="m3a", sees=True, conditions=Conditions(see=See.CAMERA))
    screen, road = np.zeros((720, 1280, 3), np.uint8), np.full((360, 640, 3), 90, np.uint8)
    made.act(observation("Watch my speed", screenshot=screen, camera=road))
    assert model.asked[0].pictures[-1] == png(road)
    assert len(model.asked[0].pictures) == 3
    assert "The last picture is the road" in model.asked[0].text


@pytest.mark.parametrize(("profile", "sees"), [("t3a", True), ("m3a", False)])
def test_the_picture_alone_needs_an_agent_and_a_model_with_eyes(agent, profile, sees):
    with pytest.raises(UserError, match="would see nothing"):
        agent("", profile=profile, sees=sees, conditions=Conditions(see=See.PICTURE))
