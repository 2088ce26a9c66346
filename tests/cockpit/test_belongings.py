"""What a driver brings into the car, what comes in between, and the screens that work with it."""

from dataclasses import replace

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.state import Contact, Thread
from automotive_cosim.cockpit.apps.trip import TripMeter
from automotive_cosim.cockpit.belongings import EVENTS, Belongings, Diary
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import CABIN, HMI, LINK
from automotive_cosim.contracts import FeedbackCode
from automotive_cosim.errors import UnknownNameError, UserError
from tests.cockpit.fingers import press, shown

from .conftest import outside, town

BROUGHT = Belongings(
    contacts=(Contact("Isla Brook", "555 31 40"),),
    threads=(Thread("Isla Brook", "Today 08:10", ("Zone B, two hours",), unread=True),),
    agenda=(Appointment("10:00", "Bank", "Work"), Appointment("15:30", "Fitting", "Home")),
    memos=("Trip A: tax",),
    trip_b=TripMeter(212_000.0, 9000.0, 38.8),
)


def parked(brought: Belongings = BROUGHT) -> Cockpit:
    signals = {"Vehicle.Powertrain.Transmission.Gear": "P"}
    cockpit = Cockpit(town(), rng=np.random.default_rng(1), signals=signals, belongings=brought)
    cockpit.sense(outside(900.0, 0.0), 1.0)
    return cockpit


def pass_s(cockpit: Cockpit, seconds: int, since_s: float = 900.0) -> float:
    for second in range(1, seconds + 1):
        cockpit.sense(outside(since_s + second, 0.0), 1.0)
    return since_s + seconds


def tap(cockpit: Cockpit, *keys: str) -> None:
    for key in keys:
        assert press(cockpit, key) is FeedbackCode.OK, key


def test_what_is_brought_is_there_and_the_rest_is_what_is_drawn():
    mine, drawn = parked().content, parked(Belongings()).content
    assert mine["favourite_contacts"] == ("Isla Brook", *drawn["favourite_contacts"])
    assert mine["unread"] == ("Isla Brook", *drawn["unread"])
    assert {key: mine[key] for key in ("places", "tracks", "fm")} == {
        key: drawn[key] for key in ("places", "tracks", "fm")
    }
    assert parked().commands()["apps.memos"] == ["Trip A: tax"]
    assert "calendar" in parked().commands()["apps.installed"]
    assert "calendar" not in parked(Belongings()).commands()["apps.installed"]


def test_a_diary_has_what_was_said_among_drawn_events_the_newest_first():
    around = tuple(f"Mila: {number}" for number in range(EVENTS))
    diary = Diary("2026-11-19", "The car: first", ((1, "Rosa: later"), (20, "Rosa: sooner")), around)
    memos, others = (diary.memos(np.random.default_rng(seed)) for seed in (1, 2))
    assert len(memos) == len(set(memos)) == EVENTS
    assert memos != others
    assert memos[-1] == others[-1] == "Thu 22 Oct: The car: first"
    for each in (memos, others):
        assert each.index("Wed 18 Nov: Rosa: later") < each.index("Fri 30 Oct: Rosa: sooner")
    with pytest.raises(UserError, match="lacks 1"):
        replace(diary, around=around[4:]).memos(np.random.default_rng(1))


def test_a_detail_of_a_place_that_is_not_there_is_refused():
    with pytest.raises(UnknownNameError, match="Nowhere"):
        parked(Belongings(details={"Nowhere": "Open until 18:00"}))


def test_an_appointment_is_moved_and_removed_and_nothing_else():
    cockpit = parked()
    cockpit.open_app("calendar")
    tap(cockpit, "calendar.1", "appointment.later", "appointment.hour_earlier")
    entries = cockpit.commands()["calendar.entries"]
    assert [entry["at"] for entry in entries] == ["10:00", "14:45"]
    tap(cockpit, "appointment.remove")
    assert cockpit.commands()["calendar.entries"] == entries[:1]
    assert cockpit.screen == "calendar"


def test_what_cannot_be_done_now_is_disabled_and_says_why():
    cockpit = parked(replace(BROUGHT, agenda=(Appointment("10:00", "Bank", ""),)))
    cockpit.open_app("calendar")
    tap(cockpit, "calendar.0")
    assert shown(cockpit, "appointment.place") == "No place is given"
    cockpit.open_app("parking")
    cockpit.command(LINK.MOBILE_DATA, False)
    pass_s(cockpit, 1)
    (disabled,) = (widget for widget in cockpit.tree.walk() if widget.disabled)
    assert (disabled.key, disabled.disabled) == ("parking.pay", "Paying needs a connection")


def test_trip_b_counts_on_and_is_reset_by_itself():
    cockpit = parked()
    cockpit.open_app("trip")
    tap(cockpit, "trip.other")
    assert (shown(cockpit, "trip_b.distance"), shown(cockpit, "trip_b.energy")) == ("212 km", "38.8 kWh")
    tap(cockpit, "trip_b.reset")
    assert shown(cockpit, "trip_b.distance") == "0 m"
    commands = cockpit.commands()
    assert (commands["trip.resets"], commands["trip.resets_b"]) == (0, 1)


def test_a_draft_with_a_figure_outlives_a_call():
    cockpit = parked()
    cockpit.expect((Arrival("call", 2.0, "Isla Brook"),))
    cockpit.visit("phone")
    tap(
        cockpit,
        "phone.favourite.0",
        "contact.message",
        "thread.figure",
        "figure.say.late",
        "figure.up",
        "figure.up",
    )
    pass_s(cockpit, 3)
    tap(cockpit, "call.answer")
    cockpit.home()
    cockpit.visit("figure")
    assert shown(cockpit, "figure.words") == "I'll be 10 minutes late"
    tap(cockpit, "figure.send")
    assert cockpit.commands()["messages.sent"] == [{"to": "Isla Brook", "text": "I'll be 10 minutes late"}]


def test_interruptions_come_at_their_seconds():
    cockpit = parked()
    cockpit.expect(
        (
            CarChange(2.0, HMI.LANGUAGE.path, "ja"),
            Arrival("message", 4.0, "Isla Brook", "Make it five"),
            CarChange(3.0, CABIN.REAR_LEFT_WINDOW.path, 60.0),
        )
    )
    now_s = pass_s(cockpit, 1)
    assert cockpit.signals[HMI.LANGUAGE] == "en"
    now_s = pass_s(cockpit, 1, now_s)
    assert (cockpit.signals[HMI.LANGUAGE], cockpit.signals[CABIN.REAR_LEFT_WINDOW]) == ("ja", 0.0)
    pass_s(cockpit, 2, now_s)
    assert cockpit.signals[CABIN.REAR_LEFT_WINDOW] == 60.0
    cockpit.visit("phone")
    tap(cockpit, "phone.tab.messages")
    assert shown(cockpit, "phone.thread.0").startswith("Isla Brook")


@pytest.mark.parametrize(
    "wrong", [Arrival("call", 2.0), Arrival("message", 2.0, "Isla Brook"), CarChange(-1.0, HMI.LANGUAGE.path, "ja")]
)
def test_an_impossible_interruption_is_refused(wrong):
    with pytest.raises(UserError):
        parked().expect((wrong,))
