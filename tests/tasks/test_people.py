"""Laws over the suite in which those aboard react, or have told the car what holds."""

import re

from automotive_cosim.cockpit.belongings import DAYS
from automotive_cosim.cockpit.occupants import Seat
from automotive_cosim.cockpit.signals import CABIN, DRIVE, HMI, HVAC, MEDIA, SEAT, VOICE
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Differs, Hurry
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

PEOPLE = [task for task in CATALOGUE.of(Suite.PEOPLE) if task.first.start.belongings.diary is None]
REMEMBERED = [task for task in CATALOGUE.of(Suite.PEOPLE) if task.first.start.belongings.diary is not None]
ALL = frozenset(Seat)
FRONT = frozenset({Seat.DRIVER, Seat.PASSENGER})
NOTICED = {
    CABIN.AMBIENT_LIGHT.path: ALL,
    CABIN.DOME_LIGHT.path: ALL,
    CABIN.DRIVER_READING_LIGHT.path: FRONT,
    CABIN.DRIVER_WINDOW.path: ALL,
    CABIN.PASSENGER_WINDOW.path: ALL,
    CABIN.REAR_LEFT_WINDOW.path: ALL,
    CABIN.REAR_RIGHT_WINDOW.path: ALL,
    CABIN.SUNROOF.path: ALL,
    CABIN.SUNROOF_SHADE.path: ALL,
    DRIVE.MODE.path: ALL,
    HMI.BRIGHTNESS.path: FRONT,
    HMI.REAR_SCREEN.path: ALL,
    HVAC.AIR_CONDITIONING.path: ALL,
    HVAC.DRIVER_TEMPERATURE.path: frozenset({Seat.DRIVER}),
    HVAC.FAN_SPEED.path: ALL,
    HVAC.PASSENGER_TEMPERATURE.path: FRONT,
    MEDIA.ACTION.path: ALL,
    MEDIA.SOURCE.path: ALL,
    MEDIA.VOLUME.path: ALL,
    SEAT.DRIVER_HEATING.path: frozenset({Seat.DRIVER}),
    SEAT.PASSENGER_HEATING.path: FRONT,
    VOICE.GUIDANCE_VOLUME.path: FRONT,
}
"""From which seats a change can be seen, heard or felt: light, wind, sound and how it drives everywhere, a zone's
air or a seat's warmth by who sits in it; those in front see the middle screen besides."""


@over((task, name) for task in PEOPLE for name in task.halves)
def test_who_reacts_is_aboard_awake_and_notices_it(task, name):
    half = draw(task, name, 0).half
    awake = {Seat.DRIVER, *(each.seat for each in half.start.aboard if not each.asleep)}
    for says in half.says:
        named = re.match(r"From the (.+?) seat: ", says.text)
        seat = next(seat for seat in Seat if seat.words == named[1]) if named else Seat.DRIVER
        assert seat in awake
        paths = set(re.findall(r"Vehicle\.[\w.]*\w", str(says)))
        assert paths or says.time_s, "a reaction is to something, or comes at a time"
        assert {path for path in paths if seat not in NOTICED[path]} == set()


@over(PEOPLE)
def test_a_wish_is_said_again_if_nothing_has_come_of_it_and_the_first_act_does_not_settle_it(task):
    assert any(says.unchanged and says.time_s for says in task.first.says)
    assert task.first.slips
    assert task.second.slips
    assert task.hurries is Hurry.WORDS


def test_every_kind_of_reaction_is_there():
    said = "\n".join(says.text for task in PEOPLE for says in draw(task, "first", 0).half.says)
    for kind in (["Did you hear me?", "Hello?"], ["Thank you.", "Great."], ["Not mine"], ["No quarrel"]):
        assert any(each in said for each in kind), kind


def test_there_are_thirty_pairs_over_weeks_and_ten_of_them_on_the_move():
    assert len(REMEMBERED) >= 30
    assert sum(not task.first.start.parked for task in REMEMBERED) >= 9


@over(REMEMBERED)
def test_halves_differ_in_one_note_of_four_weeks_or_in_what_the_notes_speak_of(task):
    starts = [draw(task, name, 0).half.start for name in task.halves]
    diaries = [start.belongings.diary for start in starts]
    assert {diary.today for diary in diaries} == {start.start[:10] for start in starts}
    first, second = (set(diary.said) for diary in diaries)
    assert len(first - second) == len(second - first) == (Differs.CONTENT in task.differs)
    assert first & second, "a note that stands in both halves leads elsewhere"
    assert all(0 < ago < DAYS for ago, _ in first | second)
