"""All screens on one picture."""

import numpy as np
import pytest

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.contracts import LimitSource, Road, RoadNetwork
from automotive_cosim.report.contactsheet import contact_sheet, pictures


@pytest.mark.slow
def test_every_screen_stands_on_the_sheet_by_day_and_by_night() -> None:
    road = Road("a", "Street", "primary", 1, 100.0, 13.9, LimitSource.POSTED, False, ((0.0, 0.0), (100.0, 0.0)))
    network = RoadNetwork((road,), (0, 0, 100, 100), None, (0, 0), False)
    cockpit = Cockpit(network, rng=np.random.default_rng(1))
    shown = dict(pictures(cockpit))
    assert set(shown) == {f"{name}, {light}" for name in pages() for light in ("day", "night")}
    for name in pages():
        assert np.mean(np.asarray(shown[f"{name}, day"])) > np.mean(np.asarray(shown[f"{name}, night"]))
    assert contact_sheet(cockpit, 160).width > 6 * 160
    assert cockpit.screen == "home"
