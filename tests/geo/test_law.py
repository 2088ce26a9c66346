"""What the law's own text says, statement by statement: every rule marked verified gives the answer it should."""

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.contracts import Json
from automotive_cosim.geo.applied import OWN_LAW, limits
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.place import LAW_OF, Place
from automotive_cosim.geo.rulefacts import RuleFacts
from automotive_cosim.geo.rules import Rule, Status
from tests.laws import over

UTC = ZoneInfo("UTC")
SITUATIONS: Mapping[str, Mapping[str, object]] = {
    "fog": {"phenomena": frozenset({"fog"}), "visibility_m": 300.0},
    "dense": {"phenomena": frozenset({"fog"}), "visibility_m": 49.0},
    "rain": {"phenomena": frozenset({"rain", "precipitation"}), "visibility_m": 5000.0},
    "heavy": {"phenomena": frozenset({"rain", "heavy_rain", "precipitation"}), "visibility_m": 40.0},
    "snow": {"phenomena": frozenset({"snow", "precipitation"}), "visibility_m": 500.0},
    "blizzard": {"phenomena": frozenset({"snow", "heavy_snow", "precipitation"}), "visibility_m": 40.0},
    "night": {"after_sunset": True},
    "town": {"built_up": True},
    "motorway": {"motorway": True, "dual_carriageway": True, "road_class": "motorway", "lanes": 2},
    "trailer": {"trailer": True},
}
"""By the words of ``statements.toml``; of two, the later says what it has."""
MOTORWAY, RAIN, TOWN = (SITUATIONS[name] for name in ("motorway", "rain", "town"))
STATEMENTS = tomllib.loads(Path(__file__).with_name("statements.toml").read_text(encoding="utf-8"))["statements"]


@pytest.fixture(scope="module")
def rules(geo: Geo) -> dict[str, Rule]:
    return {
        rule.id: rule
        for code in {name[:2] for name in geo.atlas.codes()}
        for entry in geo.atlas.country(code)
        for rule in entry.rules
    }


@over([(said,) for said in STATEMENTS])
def test_verified_statement(said: Json, rules: dict[str, Rule], facts: Callable[..., RuleFacts]) -> None:
    rule = rules[said["rule"]]
    assert rule.status is Status.VERIFIED
    assert said["law"] in rule.law
    assert rule.answer(facts(**_facts(said))) == (said.get("answer"), True)


def _facts(said: Json) -> Json:
    """All that a statement says of place, road, sky and time."""
    found: Json = {}
    for each in (*(SITUATIONS[name] for name in said.get("when", ())), said.get("facts", {})):
        found |= each
    if at := found.get("local_time"):
        found["local_time"] = at.replace(tzinfo=UTC)
    return found


def test_every_verified_rule_has_a_statement_here(rules: dict[str, Rule]) -> None:
    verified = {rule.id for rule in rules.values() if rule.status is Status.VERIFIED}
    assert verified == {said["rule"] for said in STATEMENTS}


@pytest.mark.parametrize(
    "rule_id",
    [
        "FR.low_emission",
        "FR-paris.low_emission",
        "FR-paris.limit.axes_in_part",
        "IT-bologna.limit",
        "CH-zurich.limit",
        "ES.alcohol",
        "DE-munich.low_emission",
    ],
)
def test_what_is_open_is_marked_so(rules: dict[str, Rule], rule_id: str) -> None:
    assert rules[rule_id].status is Status.UNCERTAIN


PARIS = (48.873, 2.285)
TOKYO, BEAUCE, CARDIFF, BRUSSELS, BEIJING = (
    (35.68, 139.76),
    (48.2, 1.8),
    (51.48, -3.18),
    (50.846, 4.352),
    (39.9, 116.4),
)
BELFAST = (54.6, -5.93)
LONDON, NEW_YORK, SEATTLE, HONOLULU = (51.6, -0.2), (40.75, -73.98), (47.61, -122.33), (21.31, -157.86)


@pytest.mark.parametrize(
    ("place", "changes", "rule_id", "value", "unit"),
    [
        (PARIS, {"road_class": "tertiary", "name": "Rue de Longchamp"}, "FR-paris.limit", 30, "km/h"),
        (PARIS, {"name": "Avenue Foch"}, "FR-paris.limit.axes", 50, "km/h"),
        (PARIS, {"name": "avenue de la Grande Armee"}, "FR-paris.limit.axes", 50, "km/h"),
        (PARIS, {"name": "Boulevard Lannes"}, "FR-paris.limit.boulevards_des_marechaux", 50, "km/h"),
        (
            PARIS,
            {"name": "Boulevard Périphérique Intérieur", "road_class": "trunk"},
            "FR-paris.limit.peripherique",
            50,
            "km/h",
        ),
        (BEAUCE, {"built_up": False}, "FR.limit.rural", 80, "km/h"),
        (BEAUCE, {"built_up": True}, "FR.limit.built_up", 50, "km/h"),
        (BEAUCE, {"road_class": "motorway"}, "FR.limit.motorway", 130, "km/h"),
        (CARDIFF, {"built_up": True}, "GB-WLS.limit.built_up", 20, "mph"),
        (LONDON, {"built_up": True}, "GB.limit.built_up", 30, "mph"),
        (BRUSSELS, {"built_up": True}, "BE-brussels.limit", 30, "km/h"),
        (NEW_YORK, {"built_up": True}, "US-new_york.limit", 25, "mph"),
        (SEATTLE, {"built_up": True}, "US-WA.limit.built_up", 25, "mph"),
        ((38.9, -77.03), {"built_up": True}, "US-DC.limit.streets", 20, "mph"),
        ((33.75, -84.39), {"built_up": True}, "US-GA.limit.built_up", 30, "mph"),
        (BELFAST, {"built_up": True}, "GB-NIR.limit.built_up", 30, "mph"),
        (BELFAST, {"built_up": False}, "GB-NIR.limit.rural", 60, "mph"),
        (TOKYO, {"centre_line": False}, "JP.limit.no_centre_line", 30, "km/h"),
        (TOKYO, {"centre_line": True}, "JP.limit.general", 60, "km/h"),
    ],
)
def test_the_innermost_layer_with_a_limit_for_this_road_wins(
    locate: Callable[..., GeoContext],
    place: tuple[float, float],
    changes: dict[str, object],
    rule_id: str,
    value: float,
    unit: str,
) -> None:
    found = locate(*place, **changes).default_limit
    assert found is not None
    assert (found.rule.id, found.value, found.rule.unit) == (rule_id, value, unit)


ZURICH, MUNICH, OSLO, ROME = (47.375, 8.54), (48.14, 11.57), (59.91, 10.75), (41.90, 12.50)


@pytest.mark.parametrize(
    ("place", "kmh", "status"),
    [
        (PARIS, 20, Status.VERIFIED),
        (BEAUCE, 20, Status.VERIFIED),
        (ZURICH, 20, Status.VERIFIED),
        (MUNICH, 7, Status.SECONDARY),
        (OSLO, 7, Status.KNOWLEDGE),
    ],
)
def test_a_living_street_has_the_limit_of_its_own_sign(
    locate: Callable[..., GeoContext], place: tuple[float, float], kmh: float, status: Status
) -> None:
    """Before that of its country's towns, and before that of its city."""
    (found,) = locate(*place, road_class="living_street").default_limits
    assert (found.value, found.rule.status, found.certain) == (kmh, status, True)


@over([code for code in Geo().atlas.codes() if len(code) == 2])
def test_no_general_rule_is_certain_of_a_street_with_a_law_of_its_own(
    code: str, geo: Geo, facts: Callable[..., RuleFacts]
) -> None:
    place = Place(country=code, layers=tuple(e for e in geo.atlas.country(code) if e.kind == "country"))
    for road_class in OWN_LAW:
        for found in limits(place, facts(road_class=road_class, built_up=True)):
            classes = [test.argument for test in found.rule.tests if test.word == "road_classes"]
            assert found.certain is any(road_class in named for named in classes) or not found.rule.fixed


@over([code for code in Geo().atlas.codes() if "-" in code])
def test_a_region_sets_no_limit_on_motorways_by_a_rule_about_country_roads(
    code: str, geo: Geo, facts: Callable[..., RuleFacts]
) -> None:
    """Where the country has a limit of motorways, it stands unless the region or city names motorways."""
    layers = tuple(entry for entry in geo.atlas.country(code[:2]) if entry.code in (code, code[:2]))
    of_country = [rule for rule in layers[-1].by_topic.get("limit", ()) if rule.may_apply(facts(**MOTORWAY))]
    fixed = [rule for rule in of_country if rule.fixed]
    if any(test.word == "motorway" for rule in fixed for test in rule.tests) and code[:2] not in ("AU", "US"):
        found = [one for one in limits(Place(code[:2], layers=layers), facts(**MOTORWAY)) if one.rule.fixed]
        assert any(test.word in ("motorway", "road_classes") for test in found[0].rule.tests)


def test_rain_slows_an_italian_dual_carriageway_and_a_town_a_spanish_motorway(
    rules: dict[str, Rule], facts: Callable[..., RuleFacts]
) -> None:
    wet = facts(dual_carriageway=True, **RAIN)
    assert rules["IT.limit.dual.rain"].answer(wet) == (90, True)
    assert rules["IT.limit.dual.rain"].answer(facts(dual_carriageway=True))[0] is None
    urban = facts(**(MOTORWAY | TOWN))
    assert rules["ES.limit.motorway.built_up"].answer(urban) == (80, True)


def test_where_the_network_does_not_tell_every_possible_limit_stands(locate: Callable[..., GeoContext]) -> None:
    found = locate(*BEAUCE)
    assert found.default_limit is None
    assert [limit.rule.id for limit in found.default_limits] == ["FR.limit.built_up", "FR.limit.rural"]
    assert not any(limit.certain for limit in found.default_limits)


def test_a_state_whose_law_names_no_default_limit_has_none(locate: Callable[..., GeoContext]) -> None:
    """In Hawaii the counties set every limit, by sign."""
    assert locate(*HONOLULU, built_up=True).default_limits == ()
    assert "Default limit: unknown" in locate(*HONOLULU, built_up=True).text()


@pytest.mark.parametrize(
    ("place", "kmh", "status"),
    [(MUNICH, 30, Status.VERIFIED), (BRUSSELS, 30, Status.SECONDARY), (BEAUCE, None, None)],
)
def test_a_cycle_street_has_the_limit_of_its_own_sign(
    locate: Callable[..., GeoContext], place: tuple[float, float], kmh: float | None, status: Status | None
) -> None:
    """Before that of towns, and of the city; where the law has no such sign, no limit is certain."""
    found = locate(*place, road_class="cycle_street", built_up=True).default_limits
    certain = [(limit.value, limit.rule.status) for limit in found if limit.certain]
    assert certain == ([(kmh, status)] if kmh else [])


TERRITORIES = {
    "PR": (18.4, -66.06, 25, "mph"),
    "GU": (13.47, 144.75, 35, "mph"),
    "VI": (18.34, -64.93, 20, "mph"),
    "AS": (-14.33, -170.72, 15, "mph"),
    "MP": (15.19, 145.75, None, ""),
    "NC": (-22.27, 166.45, 50, "km/h"),
    "PF": (-17.55, -149.56, 60, "km/h"),
    "BL": (17.9, -62.83, 45, "km/h"),
    "RE": (-20.88, 55.45, 50, "km/h"),
    "PM": (46.78, -56.18, 50, "km/h"),
}
"""Latitude, longitude, and the default limit in town."""


@pytest.mark.parametrize("code", TERRITORIES)
def test_a_territory_has_its_own_law_or_that_of_its_country(locate: Callable[..., GeoContext], code: str) -> None:
    lat, lon, limit, unit = TERRITORIES[code]
    context = locate(lat, lon, built_up=True)
    assert context.place.country == code
    assert context.place.law is not None
    assert context.place.law.code == ("FR" if code in LAW_OF else code)
    found = context.default_limit
    assert (found and found.value, found.rule.unit if found else "") == (limit, unit)


def test_the_fog_ladder_stands_whole_on_chinese_motorways(locate: Callable[..., GeoContext]) -> None:
    ladder = [limit.rule.cases[0].value for limit in locate(*BEIJING, road_class="motorway").reduced_limits]
    assert ladder == [20, 40, 60]


def test_right_on_red_is_the_citys_before_the_countrys(locate: Callable[..., GeoContext]) -> None:
    topics = [(place, locate(*place).rule("turn_on_red")) for place in (NEW_YORK, SEATTLE, PARIS)]
    assert [found.value for _, found in topics if found] == ["forbidden", "allowed", "forbidden"]


@pytest.mark.parametrize(
    ("rule_id", "said"),
    [
        ("FR.phone", "earphones"),
        ("FR.screens", "3 points"),
        ("FR.studs", "disc"),
        ("FR.rear_fog", "not in rain"),
        ("FR.following_distance", "2 s"),
        ("FR.yield_emergency", "way is given"),
        ("DE.dipped_beam", "tunnels"),
        ("DE.phone", "short glance"),
        ("DE.camera_warner", "app"),
        ("DE.emergency_corridor", "between the leftmost lane and the one beside it"),
        ("IT.front_fog", "replace dipped beam by day"),
        ("SE.front_fog", "instead of dipped beam, not together"),
        ("SE.rear_fog", "dazzles nobody"),
        ("SE-stockholm.studs.kungsgatan", "cross"),
        ("SE.winter_tyres", "wint"),
        ("JP.front_fog", "passing"),
        ("CH.idling", "short stops"),
        ("CH.horn", "emergency"),
        ("CN.limit.visibility_50", "next exit"),
        ("CN.limit.visibility_100", "50 m or more"),
        ("CN.limit.visibility_200", "100 m or more"),
        ("ZA.dipped_beam", "150 m"),
        ("GB.horn", "23:30 to 07:00"),
    ],
)
def test_the_words_of_a_verified_rule_hold_what_its_value_cannot(
    geo: Geo, rules: dict[str, Rule], rule_id: str, said: str
) -> None:
    rule = rules[rule_id]
    words = rule.text
    if len(rule.cases) == 1 and isinstance(rule.cases[0].value, float):
        words = f"{rule.cases[0].value:g} {rule.unit} {words}"
    assert said in words


def test_a_motorcycle_and_a_lorry_have_rules_that_a_car_does_not_read(locate: Callable[..., GeoContext]) -> None:
    context = locate(*BEAUCE, built_up=False)
    others = {rule.id for layer in context.place.layers for rule in layer.rules if rule.binds != "car"}
    assert others >= {"FR.daytime_lamps.motorcycle", "FR.following_distance.truck", "FR.limit.novice.rural"}
    assert not others & {line.source for line in context.lines}


@over([code for code in Geo().atlas.codes() if "-" in code])
def test_a_city_or_region_overrides_with_a_date(code: str, geo: Geo, rules: dict[str, Rule]) -> None:
    (entry,) = [entry for entry in geo.atlas.country(code[:2]) if entry.code == code]
    assert entry.rules
    assert entry.area is not None
    assert all(rule.law and rule.as_of.year >= 2000 for rule in entry.rules)


LEFT = {"GB", "IE", "JP", "AU", "IN", "ZA", "HK", "MO", "SG", "VI"}
US_AND_TERRITORIES = {"US", "AS", "GU", "MP", "PR", "VI"}
MILES = {"GB"} | US_AND_TERRITORIES


def test_the_side_of_the_road_the_units_and_the_emergency_number(geo: Geo) -> None:
    law = {code: geo.atlas.country(code)[-1] for code in geo.atlas.codes() if len(code) == 2}
    assert {code for code, entry in law.items() if entry.driving_side == "left"} == LEFT
    assert {code for code, entry in law.items() if entry.speed_unit == "mph"} == MILES
    assert {code for code, entry in law.items() if entry.temperature_unit == "F"} == US_AND_TERRITORIES
    first = {"CA": "911", "AE": "999", "AU": "000", "GB": "999", "BR": "190", "CN": "110", "JP": "110"}
    first |= dict.fromkeys(US_AND_TERRITORIES, "911") | {"HK": "999", "MO": "999", "SG": "999", "SA": "911"}
    assert {code: entry.emergency[0] for code, entry in law.items()} == {
        code: first.get(code, "112") for code in law
    }


def test_the_core_countries_and_their_neighbours_are_there(geo: Geo) -> None:
    core = set("FR DE GB US JP AU IT ES CH SE NO IN CN BR AE ZA AT NL BE KR".split())  # noqa: SIM905
    neighbours = set("IE PT LU DK PL CZ SI HU CA".split())  # noqa: SIM905
    assert {code for code in geo.atlas.codes() if len(code) == 2} >= core | neighbours


def test_headlights_with_the_wipers_in_23_states(rules: dict[str, Rule], locate: Callable[..., GeoContext]) -> None:
    states = "AL AR CA DE IL KS KY LA ME MD MA MO NE NJ NY NC OH OK PA RI SC TN VA".split()  # noqa: SIM905
    words = rules["US.dipped_beam"].text.replace(",", " ").replace(";", " ").split()
    assert [word for word in words if word.isupper() and len(word) == 2] == states
    assert "with the wipers in use" in locate(*SEATTLE).text()
