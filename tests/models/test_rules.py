"""The rule model: a pure function of a prompt, which follows its own plan from turn to turn."""

import json
import re

import numpy as np
import pytest

from automotive_cosim.agents.answer import labelled, read
from automotive_cosim.contracts.given import Language, Order
from automotive_cosim.drives.order import ordered
from automotive_cosim.models import ChatMessage, Rules
from automotive_cosim.models.page import Page
from automotive_cosim.models.skills import SKILLS, Course, call, in_app, opened, say, slide, tap, typed
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasks import CATALOGUE


def prompt(goal: str, **sections: str) -> str:
    titles = {
        "screen": "The screen", "car": "The car", "context": "What applies here", "plan": "Your plan",
        "result": "Last result", "changes": "What changed on the screen",
    }  # fmt: skip
    whole = {"What the driver said": goal} | {titles[name]: text for name, text in sections.items()}
    return "\n\n".join(f"## {title}\n{text}" for title, text in whole.items())


def row(index: int, label: str, state: str = "") -> str:
    return f"button: {index} {json.dumps(label)}{state and f' [{state}]'}"


def ask(text: str):
    reply = Rules().chat([ChatMessage("user", text)])
    return read(reply.text), reply


def follow(goal: str, screen: str, result: str = "ok", most: int = 12, **sections: str) -> list[dict]:
    """The actions it takes on a screen that never changes, until it declares."""
    done: list[dict] = []
    plan = ""
    while len(done) < most:
        answer, _ = ask(prompt(goal, screen=screen, plan=plan, result=result if done else "none", **sections))
        action = answer.action
        done.append({"type": str(action.action_type), "index": action.index, "status": action.goal_status})
        plan = answer.plan
        if action.goal_status:
            break
    return done


def test_it_is_a_pure_function_of_its_prompt():
    text = prompt("Turn up the fan")
    assert ask(text)[1] == ask(text)[1]


def test_its_answers_have_the_form_that_is_asked_for():
    for task in CATALOGUE.values():
        for template in task.templates:
            answer, reply = ask(prompt(template, car="speed_kmh: 80"))
            assert answer.strict, reply.text
            assert answer.situation


def test_a_plan_is_followed_to_its_end():
    screen = "\n".join([row(4, "Fan at full speed"), row(5, "other")])
    steps = follow("fan to max", screen)
    assert [(step["type"], step["index"]) for step in steps] == [("open_app", None), ("click", 4), ("status", None)]
    assert steps[-1]["status"] == "complete"


def test_a_plan_holds_though_the_situation_changes():
    """What it decided stands: the speed may fall while it is on its way to the warning."""
    context = "Speed limit here: 50 km/h (posted)"
    first, _ = ask(prompt("watch my speed", car="speed_kmh: 80", context=context))
    screen = row(1, "Speed")
    second, _ = ask(prompt("watch my speed", car="speed_kmh: 50", context=context, plan=first.plan, screen=screen))
    assert second.action.index == 1


@pytest.mark.parametrize("code", ["restricted", "disabled", "refused", "no_such_element"])
def test_what_the_car_does_not_do_is_declined(code):
    steps = follow("fan to max", row(4, "Fan at full speed"), result=code)
    assert [step["status"] for step in steps] == [None, "infeasible"]


def test_it_scrolls_for_what_is_not_in_sight_and_gives_up_in_the_end():
    steps = follow("fan to max", row(0, "list", "scrolls"))
    kinds = [step["type"] for step in steps]
    assert kinds == ["open_app", *["scroll"] * 6, "status"]
    assert steps[-1]["status"] == "infeasible"


def test_every_kind_of_move_is_an_action(monkeypatch):
    moves = (
        opened("media"), tap("a"), tap("Some Text"), slide("s", 0.5), typed("f", "Rue 'x' \"y\""), say("hello"),
        call("show_alert", kind="speed"),
    )  # fmt: skip
    screen = "\n".join([row(1, "a"), row(2, "some text"), row(3, "s", "x 100 to 340, y 20"), row(4, "f")])
    monkeypatch.setattr("automotive_cosim.models.rules.SKILLS", (type(SKILLS[0])((".",), Course("so", moves)),))
    plan, actions = "", []
    for _ in range(len(moves) + 1):
        answer, _ = ask(prompt("x", screen=screen, plan=plan, result="ok"))
        actions.append(answer.action)
        plan = answer.plan
    assert [action.index for action in actions] == [None, 1, 2, None, 4, None, None, None]
    assert (actions[3].x, actions[3].y) == (220, 20)
    assert actions[4].text == "Rue 'x' \"y\""
    assert actions[-1].goal_status == "complete"


@pytest.mark.parametrize(("limit", "speed", "warns"), [("30 mph", 60.0, True), ("50 mph", 80.0, False)])
def test_it_reads_limits_in_miles(limit, speed, warns):
    text = prompt("Watch my speed", car=f"speed_kmh: {speed}", context=f"Speed limit here: {limit} (posted)")
    assert (ask(text)[0].action.action_type == "open_app") == warns


def test_an_unknown_wish_is_declined():
    assert ask(prompt("Qwertz uiop"))[0].action.goal_status == "infeasible"


def test_asked_to_look_back_it_gives_one_line():
    for changes, lesson in (("new: b", "ok; the screen changed."), ("nothing", "ok; nothing changed.")):
        reply = Rules().chat([ChatMessage("user", prompt("x", changes=changes, result="ok: done"))])
        assert labelled(reply.text, "lesson") == lesson


def test_pictures_change_nothing():
    text = prompt("fan to max")
    assert not Rules.sees_pictures
    assert (
        Rules().chat([ChatMessage("user", text, (b"png",))]).text == Rules().chat([ChatMessage("user", text)]).text
    )


def test_its_tokens_are_counted_by_length():
    short, long = (ask(prompt("fan", context="x" * count))[1].tokens_in for count in (0, 4000))
    assert 950 < long - short < 1050


def test_random_prompts_never_break_it():
    rng = np.random.default_rng(0)
    pieces = ["\n## Your plan\n", '{"moves": [["tap"', "\n## The screen\n", '{"index": ']
    alphabet = [*'## \n:{}[]"$ab1', *pieces]
    for _ in range(400):
        Page.read("".join(rng.choice(alphabet, 60)))
        assert Rules().chat([ChatMessage("user", "".join(rng.choice(alphabet, 60)))]).text


@pytest.mark.slow
def test_no_skill_hides_behind_another():
    """Each skill is reached by some phrasing that the table was made on, or by the standing order of a drive."""
    orders = {
        ordered(order, language, with_errands=errands)
        for order in Order
        for language in Language
        for errands in (False, True)
    }
    assert len({skill_of(order) for order in orders}) == 1
    goals = [*orders, *(goal for task in CATALOGUE.values() for goal in first_goals(task))]
    assert set(range(len(SKILLS))) <= {skill_of(goal) for goal in goals}


def skill_of(goal: str) -> int:
    """Place in the table of the skill that a wish reaches; -1 without one."""
    found = (n for n, skill in enumerate(SKILLS) if any(re.search(word, goal.lower()) for word in skill.words))
    return next(found, -1)


def first_goals(task) -> set[str]:
    """What the table was made on: every phrasing but the held-out one, its parameters filled in."""
    drawn = (draw(task, "first", seed) for seed in range(40))
    return {instance.goal for instance in drawn if not instance.held_out}


RAIN = "Weather: heavy rain, 12 °C, humidity 95 %, 8.0 mm/h, visibility 3000 m (good), wind 12 km/h"
DRIZZLE = "Weather: light drizzle, 12 °C, humidity 95 %, 0.2 mm/h, visibility 9000 m (good), wind 12 km/h"
DRY = "Weather: clear sky, 12 °C, humidity 50 %, visibility 20000 m (good), wind 12 km/h"
FOG = "Weather: fog, 4 °C, humidity 99 %, visibility 120 m (fog), wind 2 km/h"
THICK = FOG.replace("120 m", "40 m")
SNOW = "Weather: light snow, -2 °C, humidity 90 %, 0.5 mm/h, visibility 2000 m (good), wind 12 km/h"
FRANCE = (
    "Default limit: 130 km/h on motorways (FR x)\n"
    "Reduced limit: 110 km/h on motorways in rain or other precipitation (FR x)"
)
BELOW_50_M = "Speed limit here: 80 km/h (posted)\nReduced limit: 50 km/h with visibility under 50 m (FR x)"
LIT = "Road: x, lit\nHigh beam: not where lit (SE x)"


@pytest.mark.parametrize(
    ("context", "limit_kmh"),
    [
        ("Speed limit here: not posted; the map assumes 31 mph\nDefault limit: 20 mph in town (GB x)", 32.2),
        ("Speed limit here: 80 km/h (posted on x)\nDefault limit: 100 km/h outside (DE x)", 80),
        (
            "Speed limit here: not posted\nDefault limit: none on motorways (DE x)\nDefault limit: 50 km/h (DE x)",
            None,
        ),
        (f"Speed limit here: not posted\n{FRANCE}\n{DRY}", 130),
        (f"Speed limit here: not posted\n{FRANCE}\n{DRIZZLE}", 110),
        (
            f"{BELOW_50_M}\n{FOG}",
            80,
        ),
        (
            f"{BELOW_50_M}\n{THICK}",
            50,
        ),
        (f"Speed limit here: 80 km/h (posted)\nReduced limit: 60 km/h for novice drivers (FR x)\n{THICK}", 80),
        ("Default limit: unknown", None),
        ("", None),
    ],
)
def test_it_reads_the_limit_that_holds(context, limit_kmh):
    found = Page.read(prompt("x", context=context)).limit_kmh()
    assert found == (None if limit_kmh is None else pytest.approx(limit_kmh, abs=0.05))


@pytest.mark.parametrize(
    ("rule", "weather", "allowed"),
    [
        ("allowed in fog with visibility under 50 m, not otherwise (DE x)", FOG, False),
        ("allowed in fog with visibility under 50 m, not otherwise (DE x)", THICK, True),
        ("allowed in fog or snow, not in rain; no visibility is named (FR x)", RAIN, False),
        ("allowed in fog or snow, not in rain; no visibility is named (FR x)", SNOW, True),
        ("allowed in fog or heavy precipitation, instead of dipped beam (SE x)", SNOW, False),
        ("allowed in fog or heavy precipitation, instead of dipped beam (SE x)", RAIN, True),
        ("allowed where visibility is seriously reduced, generally under 100 m (GB x)", FOG, False),
        ("in reduced sight (NO x)", FOG, True),
    ],
)
def test_it_reads_what_fog_lamps_are_for(rule, weather, allowed):
    page = Page.read(prompt("x", context=f"Rear fog lamp: {rule}\n{weather}"))
    assert page.allows_now("Rear fog lamp") is allowed
    assert page.allows_now("Front fog lamps") is None


@pytest.mark.parametrize(
    ("rule", "road", "weather", "forbidden"),
    [
        ("not where lit, for oncoming traffic (SE x)", "E10, trunk, 1 lane, built-up, lit", DRY, True),
        ("not where lit, for oncoming traffic (SE x)", "E10, trunk, 1 lane, built-up, unlit", SNOW, False),
        ("avoided in built-up areas (CH x)", "E10, trunk, 1 lane, outside built-up areas, lit", DRY, False),
        ("avoided in built-up areas (CH x)", "E10, trunk, 1 lane, built-up, unlit", DRY, True),
        ("dipped in fog, snow or heavy rain (FR x)", "E10, trunk, 1 lane, unlit", SNOW, True),
        ("dipped in fog, snow or heavy rain (FR x)", "E10, trunk, 1 lane, unlit", DRIZZLE, False),
    ],
)
def test_it_reads_when_high_beam_is_out_of_place(rule, road, weather, forbidden):
    context = f"Road: {road}\nHigh beam: {rule}\n{weather}"
    assert Page.read(prompt("x", context=context)).forbids_high_beam() is forbidden


@pytest.mark.parametrize(
    ("goal", "one", "other"),
    [
        ("Is my driving all right?", "Speed limit here: 50 km/h (posted)", "Speed limit here: 80 km/h (posted)"),
        ("High beam, please.", LIT, LIT.replace(", lit", ", unlit")),
        ("Rear fog lamp!", f"Rear fog lamp: allowed in fog or snow (FR x)\n{FOG}",
         f"Rear fog lamp: allowed in fog with visibility under 50 m (DE x)\n{FOG}"),
        ("What's posted?", "Speed limit here: 20 mph (posted)", "Speed limit here: 30 mph (posted)"),
    ],
)  # fmt: skip
def test_another_context_is_another_act(goal, one, other):
    acts = {
        ask(prompt(goal, car="speed_kmh: 80", context=context))[1].text.partition("Action")[2]
        for context in (one, other)
    }
    assert len(acts) == 2


def test_a_way_through_an_app_opens_it_first():
    assert in_app("climate", "a", "b", because="so").moves == (opened("climate"), tap("a"), tap("b"))
