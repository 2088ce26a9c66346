"""Calls and messages that come in while driving."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from automotive_cosim.cockpit.apps.phone.arrivals import RINGS_S, Arrival
from automotive_cosim.cockpit.apps.phone.state import TEMPLATES
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.signals import CALL, LINK, difference
from automotive_cosim.contracts import Connectivity, FeedbackCode, Surroundings
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.errors import UserError
from tests.cockpit.fingers import find, press

Make = Callable[..., Cockpit]
WHO = "Ada Adler"
OFFLINE = Connectivity(False, "none", 0)


def keys(cockpit: Cockpit) -> set[str]:
    return {key_of(element.resource_id) for element in cockpit.elements()}


def drive(cockpit: Cockpit, around: Surroundings, from_s: float, to_s: float, **changes: object) -> None:
    """Second by second, both counted from departure."""
    for second in range(int(from_s) + 1, int(to_s) + 1):
        driving = replace(around.driving, time_s=around.driving.time_s + second)
        cockpit.sense(replace(around, driving=driving, **changes), 1.0)  # type: ignore[arg-type]


@pytest.fixture
def ringing(make: Make, around: Surroundings) -> Cockpit:
    cockpit = make(arrivals=[Arrival("call", 10.0, WHO)])
    drive(cockpit, around, 0, 9)
    assert cockpit.signals[CALL.RINGING] == ""
    assert not keys(cockpit) & {"call.incoming", "call.answer", "call.decline", "call.reply"}
    drive(cockpit, around, 9, 10)
    return cockpit


def test_a_call_rings_on_every_screen_and_nothing_else_moves(ringing: Cockpit) -> None:
    assert ringing.signals[CALL.RINGING] == WHO
    for screen in pages():
        ringing.visit(screen)
        assert find(ringing, "call.incoming").text == WHO
        assert {"call.answer", "call.decline", "call.reply"} <= keys(ringing)


def test_a_call_is_answered_and_ended(ringing: Cockpit) -> None:
    before = ringing.commands()
    assert press(ringing, "call.answer") is FeedbackCode.OK
    assert difference(before, ringing.commands()) == {"calls.answered": ([], [WHO]), "phone.on_call": ("", WHO)}
    assert (ringing.signals[CALL.RINGING], ringing.signals[CALL.PARTNER]) == ("", WHO)
    assert "call.answer" not in keys(ringing)
    press(ringing, "open phone; call.end")
    assert ringing.signals[CALL.PARTNER] == ""
    press(ringing, "phone.tab.recents")
    assert "Incoming" in find(ringing, "phone.recent.0").content_description


def test_a_call_is_declined(ringing: Cockpit) -> None:
    before = ringing.commands()
    assert press(ringing, "call.decline") is FeedbackCode.OK
    assert difference(before, ringing.commands()) == {"calls.declined": ([], [WHO])}


def test_a_message_to_the_caller_declines_the_call(ringing: Cockpit) -> None:
    before = ringing.commands()
    assert press(ringing, "call.reply", "thread.answer.1") is FeedbackCode.OK
    after = ringing.commands()
    assert after["messages.sent"] == [{"to": WHO, "text": TEMPLATES[1]}]
    assert set(difference(before, after)) == {"calls.declined", "messages.sent"}


def test_a_call_that_nobody_answers_is_missed(ringing: Cockpit, around: Surroundings) -> None:
    before = ringing.commands()
    drive(ringing, around, 10, 10 + RINGS_S - 1)
    assert ringing.signals[CALL.RINGING] == WHO
    drive(ringing, around, 10 + RINGS_S - 1, 10 + RINGS_S)
    assert ringing.signals[CALL.RINGING] == ""
    assert find(ringing, "status.notice").text == f"Missed call from {WHO}"
    assert difference(before, ringing.commands()) == {}
    assert press(ringing, "status.notice") is FeedbackCode.OK
    assert ringing.screen == "contact"


@pytest.mark.parametrize(("who", "missed"), [(WHO, False), ("Somebody Else", True)])
def test_who_rings_is_not_noted_as_missed_and_another_is(
    make: Make, around: Surroundings, who: str, missed: bool
) -> None:
    cockpit = make(arrivals=[Arrival("call", 10.0, WHO), Arrival("call", 15.0, who)])
    drive(cockpit, around, 0, 20)
    assert cockpit.signals[CALL.RINGING] == WHO
    assert any("Missed" in notice.text for notice in cockpit._state.notices) == missed


def test_a_message_is_told_read_out_and_answered(make: Make, around: Surroundings) -> None:
    cockpit = make(arrivals=[Arrival("message", 5.0, WHO, "The gate is open.")])
    unread = cockpit.signals[CALL.UNREAD]
    drive(cockpit, around, 0, 5)
    assert cockpit.signals[CALL.UNREAD] == unread + 1
    assert find(cockpit, "status.notice").text == f"New message from {WHO}"
    assert press(cockpit, "status.notice") is FeedbackCode.OK
    assert (cockpit.screen, find(cockpit, "thread.who").text) == ("thread", WHO)
    assert "The gate is open." not in " ".join(one.content_description for one in cockpit.elements())
    box = find(cockpit, "thread.read").bbox_pixels
    assert "The gate is open." in cockpit.tap((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2).text
    assert cockpit.signals[CALL.UNREAD] == unread
    press(cockpit, "thread.answer.3")
    assert cockpit.commands()["messages.sent"] == [{"to": WHO, "text": TEMPLATES[3]}]
    press(cockpit, "open phone; phone.tab.messages")
    assert find(cockpit, "phone.thread.0").text == WHO


def test_a_message_can_be_read_on_screen_at_a_standstill(make: Make, around: Surroundings) -> None:
    standing = replace(around, driving=replace(around.driving, speed_mps=0.0))
    cockpit = make(arrivals=[Arrival("message", 1.0, WHO, "The gate is open.")], surroundings=standing)
    drive(cockpit, standing, 0, 1)
    press(cockpit, "status.notice", "thread.read")
    assert "The gate is open." in " ".join(one.content_description for one in cockpit.elements())


def test_do_not_disturb_keeps_calls_and_messages_silent(make: Make, around: Surroundings) -> None:
    cockpit = make(arrivals=[Arrival("call", 2.0, WHO), Arrival("message", 3.0, WHO, "Hello")])
    press(cockpit, "open phone; phone.do_not_disturb")
    drive(cockpit, around, 0, 3)
    assert not keys(cockpit) & {"call.incoming", "status.notice"}
    assert cockpit.signals[CALL.RINGING] == ""
    cockpit.open_app("notifications")
    said = {one.text for one in cockpit.elements()}
    assert {f"Missed call from {WHO}", f"New message from {WHO}"} <= said


def test_without_network_a_message_waits_and_a_call_does_not_come(make: Make, around: Surroundings) -> None:
    cockpit = make(arrivals=[Arrival("call", 2.0, WHO), Arrival("message", 3.0, WHO, "Hello")])
    unread = cockpit.signals[CALL.UNREAD]
    drive(cockpit, around, 0, 8, connectivity=OFFLINE)
    assert (cockpit.signals[CALL.RINGING], cockpit.signals[CALL.UNREAD]) == ("", unread)
    drive(cockpit, around, 8, 9)
    assert (cockpit.signals[CALL.RINGING], cockpit.signals[CALL.UNREAD]) == ("", unread + 1)


def test_without_the_phone_nothing_comes_in_or_goes_out(make: Make, around: Surroundings) -> None:
    cockpit = make(arrivals=[Arrival("call", 2.0, WHO), Arrival("message", 3.0, WHO, "Hello")])
    cockpit.inject(LINK.BLUETOOTH.path, False)
    drive(cockpit, around, 0, 5)
    assert "call.incoming" not in keys(cockpit)
    cockpit.visit("thread")
    assert press(cockpit, "thread.answer.0") is FeedbackCode.REFUSED
    assert cockpit.commands()["messages.sent"] == []


def test_what_is_left_open_is_drawn_from_the_seed(make: Make, around: Surroundings) -> None:
    plans = [Arrival("call", 4.0), Arrival("message", 2.0)]
    heard = []
    for seed in (1, 1, 2):
        cockpit = make(seed, arrivals=plans)
        drive(cockpit, around, 0, 4)
        heard.append((cockpit.signals[CALL.RINGING], cockpit.screenshot().tobytes()))
    assert heard[0] == heard[1] != heard[2]


def test_arrivals_leave_the_rest_of_the_car_as_it_is(make: Make) -> None:
    assert make(arrivals=[Arrival("call", 4.0)]).elements() == make().elements()


@pytest.mark.parametrize(
    ("arrival", "says"),
    [
        (Arrival("fax", 1.0), "'call' or 'message'"),  # type: ignore[arg-type]
        (Arrival("call", -1.0), "0 or more"),
        (Arrival("call", float("nan")), "0 or more"),
        (Arrival("call", 1.0, WHO, "Hello"), "only a message"),
        (Arrival("message", 1.0, WHO, "x" * 161), "160"),
        (Arrival("message", 1.0, WHO, "two\nlines"), "one line"),
    ],
    ids=["kind", "early", "no time", "call with text", "long", "lines"],
)
def test_an_arrival_that_cannot_be_is_refused(make: Make, arrival: Arrival, says: str) -> None:
    with pytest.raises(UserError, match=says):
        make(arrivals=[arrival])


def test_a_search_survives_a_call(make: Callable[..., Cockpit], around: Surroundings) -> None:
    """And is gone after any other way off the screen."""
    still = replace(around, driving=replace(around.driving, speed_mps=0.0))
    cockpit = make(surroundings=still, arrivals=[Arrival("call", 5.0, "Tilda Lindqvist")])
    press(cockpit, "open map; map.search")
    cockpit.type_text("rue")
    cockpit.sense(replace(still, driving=replace(still.driving, time_s=still.driving.time_s + 6.0)), 6.0)
    press(cockpit, "call.reply")
    assert cockpit.screen == "thread"
    cockpit.back()
    assert (cockpit.screen, find(cockpit, "map.search").text) == ("map", "rue")
    press(cockpit, "call.decline; open media; open map")
    assert find(cockpit, "map.search").text == ""
