"""The trace's hash grows with the episode, and is that of the JSON that is kept of it."""

import json
import math
from dataclasses import asdict, replace

import pytest

from automotive_cosim.contracts import Action, ActionType
from automotive_cosim.episode.session import Session
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource, SessionSetup
from automotive_cosim.interface.trace import HASHED, Hash, Step, canonical, plain, sha256
from automotive_cosim.traffic.fork import Simulations

APPS = ("climate", "map", "media", "home", "climate", "vehicle")


@pytest.fixture(scope="module")
def steps(simulations: Simulations) -> list[Step]:
    finder = SituationFinder(EpisodeSpec("hvac_fan_max", scenario="grid"), simulations)
    world = finder.find(SeedSource(2).next()).world
    session = Session.begin(world, "", SessionSetup(frozenset()))
    for app in APPS:
        session.step(Action(ActionType.OPEN_APP, app_name=app))
    session.refuse("no action")
    session.close()
    return session.steps


def test_the_hash_is_that_of_the_json_after_every_step(steps: list[Step]) -> None:
    lines = [json.loads(json.dumps(step.as_json())) for step in steps]
    grown = Hash()
    for count, step in enumerate(steps, 1):
        grown.add(step)
        branch = grown.copy()
        branch.add(step)
        assert grown.hex == Hash(steps[:count]).hex == sha256(lines[:count]) != branch.hex
        assert (grown.count, branch.count) == (count, count + 1)


def test_whatever_is_hashed_changes_the_hash(steps: list[Step]) -> None:
    step = steps[1]
    moment, (first, *others) = step.moment, step.elements
    changed = {
        "traffic": replace(step, moment=replace(moment, driving=replace(moment.driving, speed_mps=99.0))),
        "signals": replace(step, moment=replace(moment, signals={**moment.signals, "Vehicle.Speed": 99.0})),
        "elements": replace(step, elements=(replace(first, is_enabled=not first.is_enabled), *others)),
        "action": replace(step, action=None),
    }
    assert set(changed) == set(HASHED)
    assert len({Hash([each]).hex for each in (step, *changed.values())}) == len(HASHED) + 1


def test_plain_is_what_asdict_gives(steps: list[Step]) -> None:
    for step in steps:
        for value in (step.moment.driving, step.moment.weather, step.feedback, *step.elements[:5]):
            whole = asdict(value)
            if ahead := whole.get("ahead"):
                assert ahead.pop("next_sign") is ahead.pop("sign_distance_m") is None, "rare: left out"
                assert whole.pop("trailer") is None, "rare: left out"
            for other in filter(None, whole.get("around", {}).values()):
                if isinstance(other, dict):
                    del other["kind"], other["is_braking"]  # untraced
            if "road" in whole:
                assert whole["road"].pop("lane_alone") is None, "rare: left out"
            assert canonical(plain(value)) == canonical(whole), type(value)
    ahead = replace(steps[0].moment.driving.ahead, next_sign="stop", sign_distance_m=0.0)
    assert plain(ahead) == json.loads(json.dumps(asdict(ahead)))


def test_what_is_no_number_is_refused(steps: list[Step]) -> None:
    moment = steps[0].moment
    broken = replace(steps[0], moment=replace(moment, driving=replace(moment.driving, speed_mps=math.nan)))
    with pytest.raises(ValueError, match="not JSON compliant"):
        Hash([broken])


def test_screens_that_come_again_have_the_same_elements(steps: list[Step]) -> None:
    """Equal ones are one object, which makes their hash cheap."""
    climate = [step for step in steps if step.action and step.action.app_name == "climate"]
    assert sum(one is other for one, other in zip(*(step.elements for step in climate), strict=False)) > 30
