"""Signs in a network that was moved: the round figures of the country where it lies."""

from dataclasses import replace

import pytest

from automotive_cosim.contracts import KMH_PER_MPS, MPH_PER_MPS, NO_LIMIT, Limit, LimitSource
from automotive_cosim.geo.place import shipped
from automotive_cosim.geo.signs import signs_of
from tests.laws import over

PER_MPS = {"km/h": KMH_PER_MPS, "mph": MPH_PER_MPS}
UNITS = {"DE": "km/h", "US": "mph", "GB": "mph"}
SIGNS = [*((kmh, KMH_PER_MPS) for kmh in range(10, 140, 10)), *((mph, MPH_PER_MPS) for mph in range(10, 90, 5))]


def signs(country):
    return signs_of(shipped().country(country)[-1])


def seen(country, drive, limit, **road):
    state = drive(limit=limit, **road)
    return signs(country).on(replace(state, ahead=replace(state.ahead, next_limit=limit)))


@over([(country, *sign) for country in UNITS for sign in SIGNS])
def test_a_sign_shows_a_round_figure_of_the_country(country, figure, per_mps, drive):
    unit = UNITS[country]
    limit = Limit(figure / per_mps, LimitSource.POSTED)
    state = seen(country, drive, limit)
    shown = state.road.limit.posted_mps * PER_MPS[unit]
    own = PER_MPS[unit] == per_mps
    assert state.ahead.next_limit == state.road.limit
    assert shown / 5 == pytest.approx(round(shown / 5), abs=0.02)
    if limit.kmh >= 50:
        assert state.road.limit.mps == pytest.approx(limit.mps, rel=1 / 12)
    if own:
        assert state.road.limit == limit, "the same drive at home and there"


@pytest.mark.parametrize("source", [LimitSource.ASSUMED, LimitSource.LAW])
def test_what_the_map_assumed_elsewhere_is_not_known_here(drive, source):
    assert seen("DE", drive, Limit(80 / KMH_PER_MPS, source)).road.limit == Limit(None, source)


def test_no_limit_stays_none(drive):
    for limit in (NO_LIMIT, Limit(None, LimitSource.POSTED)):
        assert seen("US", drive, limit).road.limit == limit


def test_posted_hours_are_translated_with_their_figure(drive):
    state = seen("GB", drive, NO_LIMIT, limit_hours="50 km/h Mo-Fr 08:00-09:30, 14:30-16:00")
    assert state.road.limit_hours == "30 mph Mo-Fr 08:00-09:30, 14:30-16:00"


def test_where_no_law_is_known_signs_are_read_as_they_are():
    assert signs_of(None) is None
