"""The same instance with another input of place."""

import re
from collections.abc import Iterator

import pytest

from automotive_cosim import scenarios
from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.interface.controls import SPOTS, GeoInput, unrelated
from automotive_cosim.interface.observe import ALL
from automotive_cosim.models.skills import SKILLS
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.trial import run_trial

QUICK = {"task": "hvac_fan_max", "scenario": "grid"}
PLACE = {"gps", "context"}


@pytest.fixture(scope="module")
def views(simulations):
    """The first observation of one instance, under each control, and what a query comes to."""
    found = {}
    for control in GeoInput:
        env = CockpitEnv(**QUICK, geo=control, simulations=simulations)
        env.reset(seed=0)
        seen = env.episode.observation
        said = []
        for asked in ("rules", "position"):
            env.step({"action_type": "query", "text": asked})
            said.append(env.episode.observation.feedback)
        found[control] = (seen, *said)
        env.close()
    return found


def test_everything_but_place_is_the_same(views):
    whole = views[GeoInput.FULL][0]
    for seen, *_ in views.values():
        for name in ("goal", "time_s", "elements", "vehicle", "connectivity"):
            assert getattr(seen, name) == getattr(whole, name)
        assert (seen.screenshot == whole.screenshot).all()


@pytest.mark.parametrize(
    ("control", "given"),
    [
        (GeoInput.FULL, {"gps", "context"}),
        (GeoInput.GPS, {"gps"}),
        (GeoInput.CONTEXT, {"context"}),
        (GeoInput.WRONG, {"gps", "context"}),
        (GeoInput.IRRELEVANT, {"context"}),
        (GeoInput.NONE, set()),
    ],
)
def test_what_is_withheld_is_absent(views, control, given):
    seen = views[control][0]
    assert {name for name in PLACE if getattr(seen, name) is not None} == given


def test_the_space_lacks_what_is_withheld(simulations):
    env = CockpitEnv(**QUICK, geo="none", simulations=simulations)
    assert not PLACE & set(env.observation_space.spaces)
    env.close()


def test_context_without_gps_states_no_position(views):
    seen, _, feedback = views[GeoInput.CONTEXT]
    degrees = f"{views[GeoInput.FULL][0].gps.lat_deg:.4f}"[:-2]
    assert degrees in views[GeoInput.FULL][0].context
    assert degrees in views[GeoInput.FULL][2].text
    assert degrees not in seen.context
    assert degrees not in feedback.text
    assert len(seen.context.split("\n")) == len(views[GeoInput.FULL][0].context.split("\n")) - 1


def test_wrong_is_another_country_throughout(views):
    whole, seen = views[GeoInput.FULL][0], views[GeoInput.WRONG][0]
    assert whole.context.startswith("Place: France")
    own = {"Avenue Centrale", "France", "Code de la route", f"{whole.gps.lat_deg:.4f}"[:-2]}
    for text in (seen.context, *(feedback.text for feedback in views[GeoInput.WRONG][1:])):
        assert not [word for word in own if word in text]
    assert "South Africa (ZA)" in seen.context.split("\n")[0]
    assert abs(seen.gps.lat_deg - whole.gps.lat_deg) > 10


def test_irrelevant_is_exactly_as_long_and_says_nothing_of_driving(views):
    whole, seen = views[GeoInput.CONTEXT][0], views[GeoInput.IRRELEVANT][0]
    assert len(seen.context) == len(whole.context)
    assert not any(word in seen.context for word in ("km/h", "France", "limit", "lamp", "Weather"))


@pytest.mark.parametrize("control", [GeoInput.GPS, GeoInput.IRRELEVANT, GeoInput.NONE])
def test_without_context_there_is_nobody_to_ask(views, control):
    assert views[control][1].code == "refused"


def test_text_about_bees_has_any_length():
    for length in (0, 1, 999, 12_345):
        assert len(unrelated(length)) == length
    text = unrelated(5000).lower()
    assert not [word for skill in SKILLS for word in skill.words if re.search(word, text)]


def test_no_scenario_lies_where_others_are_sent():
    """Else the halves of a pair could be told apart by the wrong place that they are given."""
    country = SPOTS[0].country
    for name in scenarios.shipped():
        assert scenarios.load(name).country != country


def test_the_other_places_are_in_different_countries():
    assert len({spot.country for spot in SPOTS}) == len(SPOTS) >= 2


@pytest.mark.parametrize("control", list(GeoInput))
def test_agent_and_environment_agree_on_the_channels(control):
    agent = make_agent("asurada", settings=AgentSettings(Conditions(GeoInput(control))))
    assert agent.channels == ALL - control.withheld


def _won(simulations, agent: str, geo: GeoInput = GeoInput.FULL) -> Iterator[bool | None]:
    """Half by half, played when asked for."""
    for half in ("first", "second"):
        setup = EpisodeSetup(half=half, conditions=Conditions(GeoInput(geo)))
        yield run_trial(
            setup, make_agent(agent, settings=AgentSettings(Conditions(GeoInput(geo)))), simulations=simulations
        ).success


@pytest.mark.slow
def test_with_a_wrong_place_a_pairs_success_falls_to_that_without_place(simulations):
    """80 in a 50: the pipeline carries the information, and nothing else does.

    That asurada wins both halves and t3a the second alone is shown in ``tests/tasks/test_on_the_road.py``."""
    assert list(_won(simulations, "asurada", GeoInput.CONTEXT)) == [True, True]
    for control in (GeoInput.WRONG, GeoInput.NONE):
        assert not all(_won(simulations, "asurada", control))


def test_the_record_says_under_which_control_it_was_made(simulations):
    setup = EpisodeSetup(**QUICK, conditions=Conditions(GeoInput.WRONG))
    result = run_trial(setup, make_agent("no-op"), simulations=simulations)
    assert as_json(result)["conditions"]["geo"] == "wrong"
