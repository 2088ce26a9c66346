"""What the rule-perfect watcher makes of what it reads."""

from collections.abc import Sequence
from pathlib import Path
from runpy import run_path
from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.cockpit.actions import check
from automotive_cosim.contracts import Action, ActionType, AlertKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.alarm import Alarm, noticed
from automotive_cosim.drives.attention import LOOK_S
from automotive_cosim.drives.events import KINDS, DriveAct
from automotive_cosim.drives.reading import Reader
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.safety.space import read_space
from tests.drives.scenes import NOON, limit, moment, stream

CAR = {
    "speed_kmh": 50.0,
    "leader_gap_m": None,
    "leader_time_to_collision_s": None,
    "aboard": "driver: adult, 75 kg, awake, belted",
    "is_low_beam_on": True,
    "is_high_beam_on": False,
    "is_front_fog_on": False,
    "is_rear_fog_on": False,
    "range_km": 250.0,
}
ALSACE, BADEN = (7.3, 48.2), (7.9, 48.2)
IRELAND, ULSTER, SWEDEN, MANHATTAN = (-7.5, 53.3), (-6.5, 54.25), (20.2, 67.8), (-73.97, 40.77)
FOG = {"visibility": 40.0, "weather_code": 45, "kmh": 10.0, "limit": limit(90)}
NIGHT = NOON.replace(hour=23, minute=30)


def seen(now: Moment, words: Sequence[str] = (), changed: Sequence[str] = (), **car: Any) -> Any:
    """An observation with what the watcher reads of it; the words stand for readings of the car."""
    feedback = SimpleNamespace(text="1 s passed")
    vehicle = SimpleNamespace(**(CAR | {"noticed": "\n".join([noticed([now], changed), *words])} | car))
    return SimpleNamespace(
        time_s=now.time_s, vehicle=vehicle, context=now.context.text(), feedback=feedback, said=(), elements=()
    )


def watched(drive: Sequence[Moment], **car: Any) -> list[Action]:
    """What it does, looking each second."""
    watcher, alarm, acts = RulePerfect(), Alarm(), []
    for count, now in enumerate(drive, 1):
        changed = [change.name for change in alarm.see(drive[:count])]
        acts.append(check(watcher.act(seen(now, changed=changed, **car))))
    return acts


SEARCH = Path(__file__).parents[2] / "docs/examples/search"


@pytest.mark.parametrize(
    ("fault", "scene"),
    [
        ("Blind", {"kmh": 70, "visibility": 200.0}),
        ("Late", {"kmh": 70}),
        ("Night", {"kmh": 70, "at": NIGHT}),
        ("Wrong", {"kmh": 50, "limit": limit(30)}),
    ],
)
def test_a_planted_fault_fails_where_it_says_and_nowhere_else(fault: str, scene: Any) -> None:
    """Nor does a fault that is about blue lights alone."""
    planted = run_path(str(SEARCH / "planted.py"))

    def told_after_s(watcher: RulePerfect, **scene: Any) -> float | None:
        drive, alarm = stream(30, **scene), Alarm()
        for count, now in enumerate(drive, 1):
            changed = [change.name for change in alarm.see(drive[:count])]
            if watcher.act(seen(now, changed=changed, speed_kmh=scene["kmh"])).kind is AlertKind.SPEED:
                return now.time_s
        return None

    right_s = told_after_s(RulePerfect(), **scene)
    assert told_after_s(planted["Deaf"](), **scene) == right_s is not None
    assert told_after_s(planted[fault](), **scene) == (right_s + 8.0 if fault == "Late" else None)
    if fault != "Late":
        assert told_after_s(planted[fault](), kmh=70) == told_after_s(RulePerfect(), kmh=70) is not None
    assert set(read_space(SEARCH / "town.toml").rule.events) >= {"roadworks", "blue_light"}


@pytest.mark.parametrize(
    ("before", "beyond", "settled"), [(IRELAND, ULSTER, (True, False)), (ALSACE, BADEN, (False, True))]
)
def test_a_border_is_told_in_words_that_settle_it(
    before: tuple[float, float], beyond: tuple[float, float], settled: tuple[bool, bool]
) -> None:
    places = [before] * 3 + [beyond] * 10 + [before] * 10 + [beyond] * 10
    drive = [moment(float(second), position=position) for second, position in enumerate(places)]
    acts = [(at, act.text or "") for at, act in enumerate(watched(drive)) if act.action_type is ActionType.ANSWER]
    units, law = KINDS["limit_units"], KINDS["rule_change"]
    said = [DriveAct(0.0, said=text) for _, text in acts]
    assert [(units.settles(act, 1.0), law.settles(act, None)) for act in said] == [settled]
    assert all(3 < at < 8 for at, _ in acts)


def test_a_rule_that_is_not_shown_is_asked_for_once() -> None:
    """The law on rear fog lamps is shown in fog only; a lamp that is on makes it a matter."""
    watcher, now = RulePerfect(), moment(0.0, position=SWEDEN)
    first = watcher.act(seen(now, is_rear_fog_on=True))
    assert (first.action_type, first.text) == (ActionType.QUERY, "Rear fog lamp")
    law = "Rear fog lamp: allowed in fog, heavy precipitation or the like (SE TF 3:72, verified 2026-11-20)"
    acts = []
    for second in range(1, 6):
        told = seen(moment(float(second), position=SWEDEN), is_rear_fog_on=True)
        if second == 1:
            told.feedback.text = law
        acts.append(watcher.act(told))
    assert [act.kind for act in acts if act.action_type is ActionType.SHOW_ALERT] == [AlertKind.VISIBILITY]
    assert not [act for act in acts if act.action_type is ActionType.QUERY]


def test_distances_are_read_from_the_readings() -> None:
    known = Reader().read(seen(moment(0.0), ["jam: in 500 m, 25 s at this speed"], speed_kmh=72.0))
    assert known is not None
    assert known.away_m("jam") == 500.0
    known = Reader().read(seen(moment(0.0), ["jam: the car is in it, 140 m are left"]))
    assert known is not None
    assert known.away_m("jam") is None
    known = Reader().read(seen(moment(0.0)))
    assert known is not None
    assert known.left_km == 8.0


def test_what_has_ended_is_no_reading() -> None:
    known = Reader().read(seen(moment(0.0), changed=["jam"]))
    assert known is not None
    assert known.away_m("jam") is None
    assert known.changed == {"jam"}


def test_it_waits_as_long_as_the_rule() -> None:
    drive = [moment(float(second), kmh=90.0) for second in range(8)]
    alerts = [at for at, act in enumerate(watched(drive, speed_kmh=90.0)) if act.kind is AlertKind.SPEED]
    assert alerts == [3]
    assert not [act for act in watched(drive[:3], speed_kmh=90.0) if act.kind is AlertKind.SPEED]


def test_it_keeps_looking_at_a_sign_ahead_that_a_slow_car_may_yet_meet_too_fast() -> None:
    watcher, ahead = RulePerfect(), ["limit ahead: 30 km/h in 140 m"]
    slow = watcher.act(seen(moment(0.0, kmh=20.0), ahead, speed_kmh=20.0))
    assert (slow.action_type, slow.seconds) == (ActionType.WAIT, LOOK_S)
    fast = watcher.act(seen(moment(2.0, kmh=60.0), ahead, speed_kmh=60.0))
    assert (fast.action_type, fast.kind) == (ActionType.SHOW_ALERT, AlertKind.SPEED)


@pytest.mark.parametrize(
    ("scene", "car"),
    [
        ({"at": NIGHT, "kmh": 0.0}, {"speed_kmh": 0.0, "is_low_beam_on": False}),
        (FOG, {"speed_kmh": 10.0}),
        (FOG | {"position": MANHATTAN}, {"speed_kmh": 10.0}),
        ({"position": MANHATTAN}, {"leader_gap_m": 25.0}),
    ],
    ids=["no lamps at a red light", "a law for fog while slow", "fog while slow", "a gap that may close"],
)
def test_it_keeps_looking_at_what_nothing_wakes_for(scene: dict[str, Any], car: dict[str, Any]) -> None:
    act = RulePerfect().act(seen(moment(**scene), **car))
    assert (act.action_type, act.seconds) == (ActionType.WAIT, LOOK_S)


def test_it_tells_of_a_slow_vehicle_also_where_the_limit_is_not_certain() -> None:
    told = {}
    for kmh in (50, 90):
        now = seen(moment(kmh=90.0), speed_kmh=90.0, leader_gap_m=140.0, leader_time_to_collision_s=8.0)
        limits = ("Speed limit here: ", "Default limit: ")
        lines = [line for line in now.context.splitlines() if not line.startswith(limits)]
        now.context = "\n".join(
            [*lines, "Speed limit here: none posted", f"Default limit: {kmh} km/h (XX 1, knowledge)"]
        )
        told[kmh] = RulePerfect().act(now).kind
    assert told == {50: None, 90: AlertKind.TRAFFIC}


def warnings_of_breakdown(speeds_kmh: Sequence[float]) -> list[int]:
    """When it warns of a breakdown that the car nears at these speeds, a second each."""
    watcher, away_m, acts = RulePerfect(), 120.0, []
    for second, kmh in enumerate(speeds_kmh):
        ahead = [f"breakdown: in {away_m:.0f} m"] if away_m > 0 else []
        acts.append(watcher.act(seen(moment(float(second), kmh=kmh), ahead, speed_kmh=kmh)))
        away_m -= kmh / 3.6
    return [second for second, act in enumerate(acts) if act.kind is AlertKind.MOVE_OVER]


def test_it_warns_again_of_a_breakdown_if_the_car_stood_before_it_was_due() -> None:
    assert warnings_of_breakdown([32.0] + [0.0] * 70 + [32.0] * 5) == [0, 71]


def test_it_warns_once_of_a_breakdown_that_was_due_or_that_the_car_only_paused_before() -> None:
    assert warnings_of_breakdown([40.0] * 2 + [0.0] * 20 + [40.0] * 5) == [0]
    assert warnings_of_breakdown([32.0] * 2 + [0.0] * 5 + [32.0] * 5) == [0]


@pytest.mark.parametrize(("kind", "again"), [(AlertKind.MOVE_OVER, False), (AlertKind.TRAFFIC, True), (None, True)])
def test_it_does_not_tell_again_what_another_has_told(kind: AlertKind | None, again: bool) -> None:
    watcher, now = RulePerfect(), seen(moment(0.0, kmh=50), ["breakdown: in 120 m"])
    given = Action(ActionType.WAIT) if kind is None else Action(ActionType.SHOW_ALERT, kind=kind)
    watcher.look_on(now, given)
    act = watcher.act(seen(moment(2.0, kmh=50), ["breakdown: in 92 m"]))
    assert (act.kind is AlertKind.MOVE_OVER) is again
