"""Covers and cameras: drawn from what is there, the same every time, and named alone in the list."""

from collections.abc import Callable
from dataclasses import replace

from automotive_cosim.cockpit.apps.media.commands import Skip
from automotive_cosim.cockpit.camera import camera, scene
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.covers import cover
from automotive_cosim.contracts import Element, OtherVehicle, Surroundings
from automotive_cosim.contracts.ids import key_of
from tests.cockpit.fingers import find


def found(cockpit: Cockpit, key: str) -> Element:
    return find(cockpit, key)


def test_a_cover_is_made_from_the_name_alone() -> None:
    assert cover("Last Gravity, Carla Girard", 100).tobytes() == cover("Last Gravity, Carla Girard", 100).tobytes()
    assert len({cover(f"Track {number}", 64).tobytes() for number in range(40)}) > 30


def test_another_track_has_another_cover_and_the_same_element(cockpit: Cockpit) -> None:
    cockpit.open_app("media")
    before = found(cockpit, "media.cover")
    box = before.bbox_pixels
    drawn = cockpit.screenshot()[box.y_min : box.y_max, box.x_min : box.x_max].tobytes()
    cockpit._perform(Skip(1))
    assert found(cockpit, "media.cover") == before
    assert (before.text, before.content_description) == ("", "Cover")
    assert cockpit.screenshot()[box.y_min : box.y_max, box.x_min : box.x_max].tobytes() != drawn


def test_who_is_behind_is_on_the_cameras_picture_and_not_in_the_list(
    make: Callable[..., Cockpit], around: Surroundings
) -> None:
    def seen(**others: OtherVehicle | None) -> tuple[bytes, list[Element]]:
        driving = replace(around.driving, around=replace(around.driving.around, **others))
        cockpit = make(surroundings=replace(around, driving=driving))
        cockpit.visit("mirrors")
        shown = [each for each in cockpit.elements() if key_of(each.resource_id).startswith("camera.")]
        box = shown[0].bbox_pixels
        return cockpit.screenshot()[box.y_min : box.y_max, box.x_min : box.x_max].tobytes(), shown

    near, far = (OtherVehicle("other", gap_m, 14.0, None) for gap_m in (6.0, 40.0))
    pictures, lists = zip(*(seen(follower=each) for each in (None, near, far)), strict=True)
    assert len({*pictures, seen(emergency_behind=near)[0]}) == 4
    assert lists[0] == lists[1] == lists[2]
    assert [each.content_description for each in lists[0]] == ["Rear camera", "Door camera"]


def test_cameras_draw_any_gap_and_no_road(around: Surroundings) -> None:
    for gap_m in (0.0, 0.4, 159.9, 5000.0):
        others = replace(around.driving.around, follower=OtherVehicle("other", gap_m, 0.0, None))
        view = scene(replace(around.driving, around=others), night=True, beside=False, left_hand=True)
        assert camera(view, 200, 90).size == (200, 90)
    assert camera(scene(None, night=False, beside=True, left_hand=False), 200, 90).size == (200, 90)
