"""What the law's own text says, statement by statement: every rule marked verified gives the answer it should."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from datetime import datetime
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.geo.applied import OWN_LAW, limits
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.place import LAW_OF, Place
from automotive_cosim.geo.rulefacts import RuleFacts
from automotive_cosim.geo.rules import Rule, Status
from tests.laws import over

UTC = ZoneInfo("UTC")
FOG = {"phenomena": frozenset({"fog"}), "visibility_m": 300.0}
DENSE = {"phenomena": frozenset({"fog"}), "visibility_m": 49.0}
RAIN = {"phenomena": frozenset({"rain", "precipitation"}), "visibility_m": 5000.0}
HEAVY = {"phenomena": frozenset({"rain", "heavy_rain", "precipitation"}), "visibility_m": 40.0}
SNOW = {"phenomena": frozenset({"snow", "precipitation"}), "visibility_m": 500.0}
BLIZZARD = {"phenomena": frozenset({"snow", "heavy_snow", "precipitation"}), "visibility_m": 40.0}
NIGHT = {"after_sunset": True}
TOWN = {"built_up": True}
MOTORWAY = {"motorway": True, "dual_carriageway": True, "road_class": "motorway", "lanes": 2}

TRAILER = {"trailer": True}


def _on(month: int, day: int, hour: int = 12, year: int = 2026) -> dict[str, object]:
    return {"local_time": datetime(year, month, day, hour, tzinfo=UTC)}


@pytest.fixture(scope="module")
def rules(geo: Geo) -> dict[str, Rule]:
    return {
        rule.id: rule
        for code in {name[:2] for name in geo.atlas.codes()}
        for entry in geo.atlas.country(code)
        for rule in entry.rules
    }


STATEMENTS: list[tuple[str, str, Mapping[str, object], object]] = [
    # a car with a trailer
    ("DE.limit.trailer", "§18(5)", MOTORWAY | TRAILER, 80),
    ("DE.limit.trailer", "§18(5)", MOTORWAY, None),
    ("AT.limit.trailer", "§58", MOTORWAY | TRAILER, 100),
    ("ES.limit.trailer.motorway", "48", MOTORWAY | TRAILER, 90),
    ("ES.limit.trailer", "48", TRAILER, 80),
    ("SE.limit.trailer", "4:20", MOTORWAY | TRAILER, 80),
    # France
    ("FR.limit.motorway", "R413-2", MOTORWAY, 130),
    ("FR.limit.motorway.rain", "R413-2", MOTORWAY | RAIN, 110),
    ("FR.limit.motorway.rain", "R413-2", MOTORWAY, None),
    ("FR.limit.dual", "R413-2", {"dual_carriageway": True}, 110),
    ("FR.limit.dual.rain", "R413-2", {"dual_carriageway": True} | RAIN, 100),
    ("FR.limit.two_lanes", "R413-2", {"lanes": 2}, 90),
    ("FR.limit.two_lanes", "R413-2", {"lanes": 1}, None),
    ("FR.limit.two_lanes.rain", "R413-2", {"lanes": 2} | RAIN, 80),
    ("FR.limit.rural", "R413-2", {}, 80),
    ("FR.limit.built_up", "R413-3", TOWN, 50),
    ("FR.limit.living_street", "R110-2", TOWN | {"road_class": "living_street"}, 20),
    ("FR.limit.living_street", "R110-2", TOWN, None),
    ("CH.limit.living_street", "22b", TOWN | {"road_class": "living_street"}, 20),
    ("CH.limit.living_street", "22b", TOWN, None),
    ("FR.limit.peripherique", "R413-3", {"street": "Boulevard Périphérique Extérieur"}, 70),
    (
        "FR.limit.peripherique",
        "R413-3",
        {"street": "Boulevard Périphérique", "lat_deg": 49.18, "lon_deg": -0.36},
        None,
    ),
    ("FR.limit.visibility", "R413-4", DENSE, 50),
    ("FR.limit.visibility", "R413-4", MOTORWAY | DENSE, 50),
    ("FR.limit.visibility", "R413-4", {"visibility_m": 50.0}, None),
    ("FR.limit.novice.motorway", "R413-5", MOTORWAY, 110),
    ("FR.limit.novice.dual", "R413-5", {"dual_carriageway": True}, 100),
    ("FR.limit.novice.rural", "R413-5", {}, 80),
    ("FR.daytime_lamps", "R416-17", {}, "not_required"),
    ("FR.daytime_lamps.motorcycle", "R416-17", {}, "required"),
    ("FR.high_beam", "R416-6", NIGHT, "allowed"),
    ("FR.high_beam", "R416-6", NIGHT | {"oncoming_m": 150.0}, "forbidden"),
    ("FR.high_beam", "R416-6", NIGHT | {"leader_m": 40.0}, "forbidden"),
    ("FR.high_beam", "R416-6", NIGHT | TOWN | {"lit": True}, "forbidden"),
    ("FR.high_beam", "R416-6", NIGHT | {"lit": True}, "forbidden"),
    ("FR.high_beam", "R416-6", NIGHT | FOG, "forbidden"),
    ("FR.front_fog", "R416-7", FOG, "allowed"),
    ("FR.front_fog", "R416-7", SNOW, "allowed"),
    ("FR.front_fog", "R416-7", HEAVY, "allowed"),
    ("FR.front_fog", "R416-7", RAIN, "forbidden"),
    ("FR.front_fog", "R416-7", {}, "forbidden"),
    ("FR.rear_fog", "R416-7", FOG, "allowed"),
    ("FR.rear_fog", "R416-7", SNOW, "allowed"),
    ("FR.rear_fog", "R416-7", HEAVY, "forbidden"),
    ("FR.rear_fog", "R416-7", {}, "forbidden"),
    ("FR.horn", "R416-1, R416-2", TOWN, "forbidden"),
    ("FR.horn", "R416-1, R416-2", NIGHT, "forbidden"),
    ("FR.horn", "R416-1, R416-2", {}, "allowed"),
    ("FR.following_distance", "R412-12", {}, 2),
    ("FR.following_distance.truck", "R412-12", {}, 50),
    ("FR.following_distance.truck", "R412-12", TOWN, None),
    ("FR.phone", "R412-6-1", {}, "forbidden"),
    ("FR.screens", "R412-6-2", {}, "forbidden"),
    ("FR.camera_warner", "R413-15", {}, "forbidden"),
    ("FR.yield_emergency", "R415-12", {}, "required"),
    ("FR.move_over", "R412-11-1", {}, "required"),
    ("FR.bus_lane", "R412-7", {}, "forbidden"),
    ("FR.winter_tyres", "D314-8", _on(1, 10), "applies"),
    ("FR.studs", "R413-7", _on(1, 10), 90),
    ("FR.alcohol", "R234-1", {}, 0.5),
    ("FR.alcohol.novice", "R234-1", {}, 0.2),
    # Germany
    ("DE.limit.motorway", "§3(3)", MOTORWAY, "none"),
    ("DE.limit.built_up", "§3(3)", TOWN, 50),
    ("DE.limit.dual", "§3(3)", {"dual_carriageway": True}, "none"),
    ("DE.limit.two_lanes", "§3(3)", {"lanes": 2}, "none"),
    ("DE.limit.two_lanes", "§3(3)", {"lanes": 1}, None),
    ("DE.limit.rural", "§3(3)", {}, 100),
    ("DE.limit.visibility", "§3(1)", DENSE, 50),
    ("DE.limit.visibility", "§3(1)", BLIZZARD, 50),
    ("DE.limit.visibility", "§3(1)", FOG, None),
    ("DE.advisory_limit", "Richtgeschwindigkeits", MOTORWAY, 130),
    ("DE.dipped_beam", "§17", {"tunnel": True}, "required"),
    ("DE.dipped_beam", "§17", FOG, "required"),
    ("DE.dipped_beam", "§17", NIGHT, "required"),
    ("DE.dipped_beam", "§17", {}, "not_required"),
    ("DE.high_beam", "§17(2)", NIGHT | {"lit": True}, "forbidden"),
    ("DE.high_beam", "§17(2)", NIGHT | {"oncoming_m": 150.0}, "forbidden"),
    ("DE.high_beam", "§17(2)", NIGHT | {"leader_m": 50.0}, "forbidden"),
    ("DE.high_beam", "§17(2)", NIGHT, "allowed"),
    ("DE.front_fog", "§17(3)", FOG, "allowed"),
    ("DE.front_fog", "§17(3)", {}, "forbidden"),
    ("DE.rear_fog", "§17(3)", DENSE, "allowed"),
    ("DE.rear_fog", "§17(3)", FOG, "forbidden"),
    ("DE.rear_fog", "§17(3)", HEAVY, "forbidden"),
    ("DE.rear_fog", "§17(3)", BLIZZARD, "forbidden"),
    ("DE.horn", "§16", TOWN, "forbidden"),
    ("DE.horn", "§16", {}, "allowed"),
    ("DE.following_distance", "§4", {}, "applies"),
    ("DE.following_distance.truck", "§4", MOTORWAY | {"speed_kmh": 80.0}, 50),
    ("DE.following_distance.truck", "§4", MOTORWAY | {"speed_kmh": 50.0}, None),
    ("DE.phone", "§23(1a)", {}, "forbidden"),
    ("DE.screens", "§23(1a)", {}, "applies"),
    ("DE.camera_warner", "§23(1c)", {}, "forbidden"),
    ("DE.emergency_corridor", "§11(2)", MOTORWAY, "required"),
    ("DE.emergency_corridor", "§11(2)", TOWN | {"lanes": 2}, None),
    ("DE.emergency_corridor", "§11(2)", {"lanes": 1}, None),
    ("DE.low_emission", "270.1", {}, "applies"),
    ("DE.winter_tyres", "§2(3a)", {}, "required"),
    ("DE.idling", "§30", {}, "forbidden"),
    # Great Britain
    ("GB-WLS.limit.built_up", "Wales", TOWN, 20),
    ("GB-WLS.limit.built_up", "Wales", TOWN | _on(9, 16, year=2023), None),
    ("GB.dipped_beam", "HC 226", {"visibility_m": 99.0}, "required"),
    ("GB.dipped_beam", "HC 226", {}, "not_required"),
    ("GB.front_fog", "HC 226", {"visibility_m": 99.0}, "allowed"),
    ("GB.front_fog", "HC 226", {"visibility_m": 101.0}, "forbidden"),
    ("GB.rear_fog", "HC 226", {"visibility_m": 99.0}, "allowed"),
    ("GB.rear_fog", "HC 226", FOG, "forbidden"),
    ("GB.horn", "CUR reg. 99", {"standing": True}, "forbidden"),
    ("GB.horn", "CUR reg. 99", TOWN | _on(5, 5, 6), "forbidden"),
    ("GB.horn", "CUR reg. 99", _on(5, 5, 6), "allowed"),
    ("GB.horn", "CUR reg. 99", TOWN | _on(5, 5, 7), "allowed"),
    ("GB.idling", "CUR reg. 98", {}, "forbidden"),
    # Italy
    ("IT.tunnel_lamps", "art. 153", {"tunnel": True}, "required"),
    ("IT.high_beam", "art. 153", NIGHT | TOWN, "forbidden"),
    ("IT.high_beam", "art. 153", NIGHT | {"lit": True}, "forbidden"),
    ("IT.high_beam", "art. 153", NIGHT, "allowed"),
    ("IT.front_fog", "art. 153", FOG, "allowed"),
    ("IT.front_fog", "art. 153", {}, "forbidden"),
    # Japan
    ("JP.limit.no_centre_line", "Order 11", {"centre_line": False}, 30),
    ("JP.limit.no_centre_line", "Order 11", {"centre_line": False} | _on(8, 31), None),
    ("JP.limit.no_centre_line", "Order 11", {"centre_line": True}, None),
    ("JP.dipped_beam", "Order 19", {"tunnel": True}, "required"),
    ("JP.dipped_beam", "Order 19", MOTORWAY | {"visibility_m": 199.0}, "required"),
    ("JP.dipped_beam", "Order 19", {"visibility_m": 199.0}, "not_required"),
    ("JP.dipped_beam", "Order 19", {"visibility_m": 49.0}, "required"),
    ("JP.high_beam", "52", NIGHT, "applies"),
    ("JP.high_beam", "52", NIGHT | {"oncoming_m": 150.0}, "forbidden"),
    ("JP.front_fog", "Order 20", {}, "allowed"),
    # Austria and the Netherlands
    ("AT.limit.motorway", "20(2)", MOTORWAY, 130),
    ("AT.limit.built_up", "20(2)", TOWN, 50),
    ("AT.limit.rural", "20(2)", {}, 100),
    ("NL.limit.motorway", "21", MOTORWAY, 130),
    ("NL.limit.built_up", "20", TOWN, 50),
    ("NL.limit.expressway", "21", {"expressway": True}, 100),
    ("NL.limit.rural", "21", {}, 80),
    # Switzerland
    ("CH.limit.built_up", "Art. 4a", TOWN, 50),
    ("CH.limit.rural", "Art. 4a", {}, 80),
    ("CH.limit.expressway", "Art. 4a", {"expressway": True}, 100),
    ("CH.limit.motorway", "Art. 4a", MOTORWAY, 120),
    ("CH.daytime_lamps", "Art. 30", {}, "required"),
    ("CH.dipped_beam", "Art. 30", {}, "not_required"),
    ("CH.dipped_beam", "Art. 30", NIGHT, "required"),
    ("CH.dipped_beam", "Art. 30", {"tunnel": True}, "required"),
    ("CH.high_beam", "Art. 30", NIGHT | TOWN, "forbidden"),
    ("CH.high_beam", "Art. 30", NIGHT | {"oncoming_m": 150.0}, "forbidden"),
    ("CH.front_fog", "Art. 30", HEAVY, "allowed"),
    ("CH.rear_fog", "Art. 30", HEAVY, "allowed"),
    ("CH.rear_fog", "Art. 30", RAIN, "forbidden"),
    ("CH.horn", "Art. 29", NIGHT, "forbidden"),
    ("CH.horn", "Art. 29", {}, "allowed"),
    ("CH.following_distance", "Art. 12", {}, "applies"),
    ("CH.phone", "Art. 3", {}, "forbidden"),
    ("CH.screens", "Art. 3", {}, "forbidden"),
    ("CH.winter_tyres", "VRV", {}, "not_required"),
    ("CH.studs", "VRV", MOTORWAY, "forbidden"),
    ("CH.studs", "VRV", {}, None),
    ("CH.idling", "Art. 34", {}, "forbidden"),
    # Sweden and Norway
    ("SE.daytime_lamps", "3:68", {}, "required"),
    ("SE.dipped_beam", "3:68", NIGHT, "required"),
    ("SE.dipped_beam", "3:68", FOG, "required"),
    ("SE.high_beam", "3:70", NIGHT | {"lit": True}, "forbidden"),
    ("SE.high_beam", "3:70", NIGHT | {"oncoming_m": 150.0}, "forbidden"),
    ("SE.high_beam", "3:70", NIGHT | {"leader_m": 50.0}, "forbidden"),
    ("SE.front_fog", "3:71", FOG, "allowed"),
    ("SE.front_fog", "3:71", RAIN, "forbidden"),
    ("SE.rear_fog", "3:72", HEAVY, "allowed"),
    ("SE.rear_fog", "3:72", {}, "forbidden"),
    ("SE.horn", "3:64", {}, "forbidden"),
    ("SE.winter_tyres", "TF", _on(12, 1), "required"),
    ("SE.winter_tyres", "TF", _on(3, 31), "required"),
    ("SE.winter_tyres", "TF", _on(4, 1), None),
    ("SE-stockholm.studs", "Stockholm", {"street": "Hornsgatan"}, "forbidden"),
    ("SE-stockholm.studs", "Stockholm", {"street": "Fleminggatan"}, "forbidden"),
    ("SE-stockholm.studs", "Stockholm", {"street": "Sveavägen"}, None),
    ("SE-stockholm.studs.kungsgatan", "Stockholm", {"street": "Kungsgatan"}, "forbidden"),
    ("NO.limit.built_up", "§6", TOWN, 50),
    ("NO.limit.rural", "§6", {}, 80),
    ("NO.camera_warner", "§13a", {}, "forbidden"),
    ("NO.alcohol", "§22", {}, 0.2),
    # China
    ("CN.limit.visibility_200", "81", MOTORWAY | {"visibility_m": 199.0}, 60),
    ("CN.limit.visibility_200", "81", {"visibility_m": 199.0}, None),
    ("CN.limit.visibility_100", "81", MOTORWAY | {"visibility_m": 99.0}, 40),
    ("CN.limit.visibility_50", "81", MOTORWAY | {"visibility_m": 49.0}, 20),
    ("CN.dipped_beam", "81", MOTORWAY | {"visibility_m": 199.0}, "required"),
    ("CN.front_fog", "58", FOG, "required"),
    ("CN.front_fog", "81", MOTORWAY | {"visibility_m": 199.0}, "required"),
    ("CN.hazard_lights", "58", FOG, "required"),
    ("CN.hazard_lights", "81", MOTORWAY | {"visibility_m": 99.0}, "required"),
    ("CN.hazard_lights", "81", MOTORWAY | {"visibility_m": 199.0}, "not_required"),
    ("CN.following_distance.visibility", "81", MOTORWAY | {"visibility_m": 199.0}, 100),
    ("CN.following_distance.visibility", "81", MOTORWAY | {"visibility_m": 99.0}, 50),
    ("CN.following_distance.visibility", "81", MOTORWAY | {"visibility_m": 201.0}, None),
    ("CN.high_beam", "58", NIGHT | {"leader_m": 50.0}, "forbidden"),
    # South Africa
    ("ZA.dipped_beam", "157", {"visibility_m": 149.0}, "required"),
    ("ZA.dipped_beam", "157", {"visibility_m": 151.0}, "not_required"),
    ("ZA.daytime_lamps.motorcycle", "157", {}, "required"),
    ("ZA.high_beam", "157", NIGHT | {"oncoming_m": 150.0}, "forbidden"),
    # Default limits, of other countries and territories
    ("DE.limit.cycle_street", "244.1", TOWN | {"road_class": "cycle_street"}, 30),
    ("DE.limit.cycle_street", "244.1", TOWN, None),
    ("IT.limit.motorway", "142(1)", MOTORWAY, 130),
    ("IT.limit.motorway.rain", "142(1)", MOTORWAY | RAIN, 110),
    ("IT.limit.motorway.rain", "142(1)", MOTORWAY, None),
    ("IT.limit.dual", "142(1)", {"dual_carriageway": True}, 110),
    ("IT.limit.dual.rain", "142(1)", {"dual_carriageway": True} | RAIN, 90),
    ("IT.limit.dual.rain", "142(1)", {"dual_carriageway": True}, None),
    ("IT.limit.rural", "142(1)", {}, 90),
    ("IT.limit.built_up", "142(1)", TOWN, 50),
    ("ES.limit.motorway", "48", MOTORWAY, 120),
    ("ES.limit.rural", "48", {}, 90),
    ("AU.limit.motorway", "r25", MOTORWAY, 100),
    ("AU.limit.built_up", "r25", TOWN, 50),
    ("AU.limit.rural", "r25", {}, 100),
    ("MC.limit.general", "art. 11", TOWN, 50),
    ("MO.limit.general", "art. 20", TOWN, 60),
    ("SG.limit.general", "para. 2", TOWN, 50),
    ("PF.limit.built_up", "313-2", TOWN, 60),
    ("GB-NIR.limit.built_up", "art. 36", TOWN, 30),
    # The United States
    ("US-AZ.limit.built_up", "28-701", TOWN, 25),
    ("US-AZ.limit.rural", "28-701", {}, 65),
    ("US-CO.limit.motorway", "42-4-1101", MOTORWAY, 65),
    ("US-GA.limit.built_up", "40-6-181", TOWN, 30),
    ("US-GA.limit.rural", "40-6-181", {}, 55),
    ("US-IL.limit.built_up", "11-601", TOWN, 30),
    ("US-IN.limit.built_up", "9-21-5-2", TOWN, 30),
    ("US-IN.limit.motorway", "9-21-5-2", MOTORWAY, 70),
    ("US-IN.limit.motorway", "9-21-5-2", MOTORWAY | TOWN, None),
    ("US-IN.limit.rural", "9-21-5-2", {}, 55),
    ("US-MD.limit.built_up", "21-801.1", TOWN, 30),
    ("US-MD.limit.dual", "21-801.1", {"dual_carriageway": True}, 55),
    ("US-MD.limit.rural", "21-801.1", {}, 50),
    ("US-MN.limit.built_up", "169.14", TOWN, 30),
    ("US-MN.limit.rural", "169.14", {}, 55),
    ("US-MO.limit.motorway", "304.010", MOTORWAY, 70),
    ("US-MO.limit.motorway.urban", "304.010", MOTORWAY | TOWN, 60),
    ("US-NC.limit.built_up", "20-141", TOWN, 35),
    ("US-NC.limit.rural", "20-141", {}, 55),
    ("US-NJ.limit.rural", "39:4-98", {}, 50),
    ("US-PA.limit.residential", "3362", TOWN | {"road_class": "residential"}, 25),
    ("US-PA.limit.residential", "3362", TOWN, None),
    ("US-PA.limit.built_up", "3362", TOWN, 35),
    ("US-PA.limit.rural", "3362", {}, 55),
    ("US-SC.limit.built_up", "56-5-1520", TOWN, 30),
    ("US-SC.limit.rural", "56-5-1520", {}, 55),
    ("US-VA.limit.residential", "46.2-874", TOWN | {"road_class": "residential"}, 25),
    ("US-VA.limit.rural", "46.2-870", {}, 55),
    ("US-WI.limit.motorway", "346.57", MOTORWAY, 70),
    ("US-WI.limit.expressway", "346.57", {"expressway": True}, 65),
]


@over(STATEMENTS)
def test_verified_statement(
    rule_id: str,
    article: str,
    changes: Mapping[str, object],
    value: object,
    rules: dict[str, Rule],
    facts: Callable[..., RuleFacts],
) -> None:
    rule = rules[rule_id]
    assert rule.status is Status.VERIFIED
    assert article in rule.law
    assert rule.answer(facts(**changes)) == (value, True)


def test_every_verified_rule_has_a_statement_here(rules: dict[str, Rule]) -> None:
    verified = {rule.id for rule in rules.values() if rule.status is Status.VERIFIED}
    assert verified == {rule_id for rule_id, *_ in STATEMENTS}


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
    code: str,
    geo: Geo,
    facts: Callable[..., RuleFacts],
) -> None:
    place = Place(country=code, layers=tuple(e for e in geo.atlas.country(code) if e.kind == "country"))
    for road_class in OWN_LAW:
        for found in limits(place, facts(road_class=road_class, built_up=True)):
            classes = [test.argument for test in found.rule.tests if test.word == "road_classes"]
            assert found.certain is any(road_class in named for named in classes) or not found.rule.fixed


@over([code for code in Geo().atlas.codes() if "-" in code])
def test_a_region_sets_no_limit_on_motorways_by_a_rule_about_country_roads(
    code: str,
    geo: Geo,
    facts: Callable[..., RuleFacts],
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
def test_a_city_or_region_overrides_with_a_date(
    code: str,
    geo: Geo,
    rules: dict[str, Rule],
) -> None:
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
