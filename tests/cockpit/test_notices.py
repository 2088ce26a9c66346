"""What one screen says of the car, no other contradicts."""

import pytest

from automotive_cosim.cockpit.signals import ENERGY, GLASS, TYRE
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.contracts.ids import resource_id as shown_id

SOFT = {TYRE.FRONT_LEFT.path: 170.0}
EMPTY = {ENERGY.LEVEL.path: 8.0}


def badge(cockpit) -> int:
    (told,) = (
        each.content_description
        for each in cockpit.elements()
        if each.resource_id == shown_id("status.notifications")
    )
    return int(told.removeprefix("Notifications: "))


def listed(cockpit) -> int:
    cockpit.open_app("notifications")
    return sum(key_of(each.resource_id).removeprefix("notifications.").isdigit() for each in cockpit.elements())


@pytest.mark.parametrize("signals", [{}, SOFT, EMPTY, SOFT | EMPTY])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_badge_counts_what_the_list_shows(make, signals, seed):
    cockpit = make(seed=seed, signals=signals)
    told = badge(cockpit)
    assert told == listed(cockpit) == badge(cockpit)
    assert told >= len(signals)


@pytest.mark.parametrize("fog", [0.0, 0.12, 0.19, 0.2, 0.5])
def test_fogged_glass_is_told_everywhere_or_nowhere(cockpit, fog):
    cockpit.inject(GLASS.WINDSHIELD_FOG.path, fog)
    texts = {key_of(each.resource_id): each.text for each in cockpit.elements()}
    is_told = texts["home.cabin_note"] == "Windows fogging"
    assert is_told == (fog >= 0.2)
    assert not (is_told and texts["home.outside.value"] == "All clear")
    before = badge(cockpit)
    cockpit.inject(GLASS.WINDSHIELD_FOG.path, 0.0)
    assert before - badge(cockpit) == is_told
