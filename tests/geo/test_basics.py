"""Every place on earth has its basics: side of the road, units, emergency numbers, and the rules met daily."""

from collections.abc import Callable
from importlib.resources import files

import pytest
import tzfpy

from automotive_cosim.geo import sensor
from automotive_cosim.geo.basics import Basics, basics_of, rows
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.place import LAW_OF, Atlas, country_at
from automotive_cosim.geo.rules import Status
from automotive_cosim.osm.country import LEFT_HAND
from tests.laws import over

CODES = sorted(
    line.split("\t")[0]
    for line in (files("tzdata") / "zoneinfo" / "iso3166.tab").read_text(encoding="utf-8").splitlines()
    if line and not line.startswith("#")
)
WITHOUT_ROADS = frozenset(("AQ", "BV", "HM", "TF"))
"""Antarctica, Bouvet Island, Heard and McDonald Islands, French Southern Territories: they have no public roads."""

COUNTRIES = [code for code in CODES if code not in WITHOUT_ROADS]

LEFT = """
AG AI AU BB BD BM BN BS BT BW CC CK CX CY DM FJ FK GB GD GG GS GY HK ID IE IM IN JE JM JP KE KI KN KY LC LK LS
MO MS MT MU MV MW MY MZ NA NF NP NR NU NZ PG PK PN SB SC SG SH SR SZ TC TH TK TL TO TT TV TZ UG VC VG VI WS ZA
ZM ZW
"""
"""Where traffic keeps left."""
MILES = """
AG AI AS BS BZ DM FK FM GB GD GG GS GU GY IM IO JE KN KY LC LR MH MM MP MS PN PR PW SH TC UM US VC VG VI WS
"""
"""Where signs count miles per hour."""

LACKING = {"US": {"limit", "phone"}, **{code: {"limit"} for code in ("GS", "IO", "MP", "SO", "UM")}}
"""What is not known of a country as a whole: in the United States, that is for the states to say."""

POINTS = """
AR -34.60 -58.38   AR -31.42 -64.18   TH 13.75 100.50   TH 18.79 98.98   TR 41.01 28.95   TR 39.93 32.86
EG 30.04 31.24   EG 31.20 29.92   NZ -36.85 174.76   NZ -43.53 172.63   KE -1.29 36.82   KE -4.05 39.67
CL -33.45 -70.66   PE -12.05 -77.04   CO 4.71 -74.07   VE 10.49 -66.88   EC -0.18 -78.47   BO -16.50 -68.13
PY -25.28 -57.63   UY -34.90 -56.16   BR -15.79 -47.88   BR -8.05 -34.90   GY 6.80 -58.16   SR 5.85 -55.20
MX 19.43 -99.13   MX 20.67 -103.35   GT 14.63 -90.51   SV 13.69 -89.19   HN 14.08 -87.20   NI 12.13 -86.25
CR 9.93 -84.08   PA 8.98 -79.52   BZ 17.50 -88.20   CU 23.11 -82.37   JM 18.00 -76.79   HT 18.54 -72.34
DO 18.48 -69.93   PR 18.40 -66.06   BS 25.06 -77.34   BB 13.10 -59.61   TT 10.65 -61.51   LC 14.01 -60.99
GD 12.05 -61.75   VC 13.16 -61.22   AG 17.12 -61.85   DM 15.30 -61.39   KN 17.30 -62.72   VG 18.42 -64.62
VI 18.34 -64.93   KY 19.29 -81.38   TC 21.77 -72.27   BM 32.29 -64.78   AI 18.22 -63.06   AW 12.52 -70.03
CW 12.11 -68.93   US 38.90 -77.04   US 47.61 -122.33   CA 43.65 -79.38   CA 49.28 -123.12   GL 64.18 -51.72
GB 51.51 -0.13   GB 54.60 -5.93   IE 53.35 -6.26   IM 54.15 -4.48   JE 49.19 -2.11   GG 49.46 -2.54
FR 48.86 2.35   DE 52.52 13.40   ES 40.42 -3.70   PT 38.72 -9.14   IT 41.89 12.48   GR 37.98 23.73
MT 35.90 14.51   CY 35.16 33.36   AL 41.33 19.82   BA 43.86 18.41   RS 44.79 20.45   ME 42.44 19.26
MK 42.00 21.43   HR 45.81 15.98   BG 42.70 23.32   RO 44.43 26.10   MD 47.01 28.86   UA 50.45 30.52
BY 53.90 27.57   RU 55.75 37.62   RU 56.01 92.87   LT 54.69 25.28   LV 56.95 24.11   EE 59.44 24.75
FI 60.17 24.94   IS 64.15 -21.94   FO 62.01 -6.77   SK 48.15 17.11   CZ 50.08 14.44   HU 47.50 19.04
SM 43.94 12.45   GI 36.14 -5.35   GE 41.72 44.79   AM 40.18 44.51   AZ 40.41 49.87   IL 31.77 35.20
JO 31.95 35.93   LB 33.89 35.50   SY 33.51 36.29   IQ 33.31 44.36   IR 35.69 51.39   KW 29.37 47.98
SA 24.71 46.68   BH 26.22 50.58   QA 25.29 51.53   AE 25.20 55.27   OM 23.59 58.38   YE 15.37 44.19
AF 34.53 69.17   PK 24.86 67.01   PK 31.55 74.34   IN 28.61 77.21   IN 12.97 77.59   NP 27.72 85.32
BT 27.47 89.64   BD 23.81 90.41   LK 6.93 79.86   MV 4.17 73.51   KZ 43.24 76.89   UZ 41.30 69.24
TM 37.95 58.38   KG 42.87 74.59   TJ 38.56 68.77   MN 47.92 106.92   CN 39.90 116.40   CN 29.56 106.55
HK 22.30 114.17   MO 22.20 113.54   TW 25.03 121.57   KP 39.02 125.75   KR 37.57 126.98   JP 35.68 139.76
MM 16.84 96.17   LA 17.97 102.63   KH 11.56 104.92   VN 21.03 105.85   VN 18.67 105.69   VN 10.78 106.70
TH 17.39 104.78   TH 15.24 104.86   TH 19.91 99.83   LA 19.89 102.13   VN 21.39 103.02   MY 3.14 101.69
SG 1.30 103.85   BN 4.90 114.94   ID -6.21 106.85   ID -8.65 115.22   PH 14.60 120.98   TL -8.56 125.56
AU -33.87 151.21   AU -42.88 147.33   PG -9.44 147.18   FJ -18.14 178.44   SB -9.43 159.96   VU -17.74 168.32
NC -22.27 166.45
WS -13.83 -171.76   AS -14.28 -170.70   TO -21.14 -175.20   KI 1.33 172.98   MH 7.10 171.38   FM 6.92 158.16
PW 7.34 134.48   GU 13.47 144.75   MP 15.19 145.75   NR -0.53 166.92   TV -8.52 179.20   CK -21.21 -159.78
NU -19.06 -169.92   PF -17.54 -149.57   MA 33.57 -7.59   EH 27.15 -13.20   DZ 36.75 3.06   TN 36.81 10.18
LY 32.89 13.19   SD 15.50 32.56   SS 4.85 31.60   ET 9.03 38.74   ER 15.33 38.93   DJ 11.59 43.15
SO 2.04 45.34   UG 0.35 32.58   RW -1.94 30.06   BI -3.38 29.36   TZ -6.79 39.21   MZ -25.97 32.58
MW -13.96 33.79   ZM -15.39 28.32   ZW -17.83 31.05   BW -24.65 25.91   NA -22.56 17.08   ZA -33.92 18.42
LS -29.31 27.48   SZ -26.32 31.13   MG -18.88 47.51   MU -20.16 57.50   SC -4.62 55.45   KM -11.70 43.26
RE -20.88 55.45   AO -8.84 13.23   CD -4.32 15.31   CG -4.27 15.28   GA 0.39 9.45   GQ 3.75 8.78
CM 4.05 9.70   CF 4.36 18.56   TD 12.11 15.04   NE 13.51 2.11   NG 6.52 3.38   NG 9.06 7.49
BJ 6.37 2.42   TG 6.13 1.22   GH 5.60 -0.19   CI 5.36 -4.01   BF 12.37 -1.52   ML 12.64 -8.00
SN 14.69 -17.45   GM 13.45 -16.58   GW 11.86 -15.60   GN 9.54 -13.68   SL 8.48 -13.23   LR 6.30 -10.80
MR 18.08 -15.98   CV 14.92 -23.51   ST 0.34 6.73   SH -15.93 -5.72   FK -51.69 -57.86   SJ 78.22 15.65
"""
"""Towns on all continents: country, latitude, longitude."""


def _points() -> list[tuple[str, float, float]]:
    words = POINTS.split()
    return [
        (code, float(lat), float(lon)) for code, lat, lon in zip(words[::3], words[1::3], words[2::3], strict=True)
    ]


def _row(code: str) -> Basics:
    row = basics_of(code)
    assert row is not None
    return row


@over(COUNTRIES)
def test_every_country_has_side_units_number_and_rules(code: str) -> None:
    law = Atlas().country(LAW_OF.get(code, code))[-1]
    assert law.kind == "country"
    assert law.name
    assert law.driving_side == ("left" if code in LEFT.split() else "right")
    assert law.speed_unit == ("mph" if code in MILES.split() else "km/h")
    assert law.temperature_unit in ("C", "F")
    assert law.emergency
    assert all(number.isdigit() and 2 <= len(number) <= 5 for number in law.emergency)
    lacking = {"limit", "seat_belts", "phone", "daytime_lamps", "alcohol"} - set(law.by_topic)
    assert lacking == LACKING.get(code, set())


def test_maps_are_imported_for_the_side_of_their_country() -> None:
    assert set(LEFT.split()) == LEFT_HAND


def test_places_without_roads_are_the_only_ones_without_law() -> None:
    assert {code for code in CODES if not Atlas().country(LAW_OF.get(code, code))} == WITHOUT_ROADS
    assert Atlas().place(166.67, -77.85).country == "AQ"


@over(_points())
def test_a_town_anywhere_is_in_its_country(code: str, lat: float, lon: float) -> None:
    assert country_at(tzfpy.get_tz(lon, lat), lon, lat) == code


@pytest.mark.slow
@over(_points()[::3])
def test_a_town_anywhere_has_its_basics(
    code: str, lat: float, lon: float, locate: Callable[..., GeoContext]
) -> None:
    context = locate(lat, lon, road_class="residential")
    law = context.place.law
    assert law is not None
    side = "left" if code in LEFT.split() else "right"
    assert len(context.text(60)) <= 4 * 60 + 1
    lines = context.text().splitlines()
    assert f"Country: traffic keeps {side}; emergency call {', '.join(law.emergency)}" in lines
    unit = "mph" if code in MILES.split() else "km/h"
    assert any(line.startswith("Speed: ") and f" {unit}, heading" in line for line in lines)
    topics = {found.rule.topic for found in context.rules} | {"limit" for _ in context.default_limits}
    assert {"limit", "seat_belts", "alcohol", "phone", "daytime_lamps"} - topics <= LACKING.get(code, set())


@over(sorted(rows()))
def test_nothing_in_the_table_is_verified(code: str) -> None:
    country = _row(code).country
    assert country.status is not Status.VERIFIED
    assert all(rule.status is not Status.VERIFIED for rule in country.rules)
    assert len({rule.id for rule in country.rules}) == len(country.rules)


@over(sorted(rows()))
def test_limits_of_the_table_are_plausible(code: str) -> None:
    """Multiples of five in the unit of the country, in town the lowest."""
    country = _row(code).country
    limits = {rule.id.rpartition(".")[2]: rule.cases[0].value for rule in country.by_topic.get("limit", ())}
    figures = [value for value in limits.values() if isinstance(value, float)]
    assert all(value % 5 == 0 for value in figures)
    low, high = (15, 75) if country.speed_unit == "mph" else (25, 140)
    assert all(low <= value <= high for value in figures)
    order = [limits[road] for road in ("built_up", "rural", "motorway") if isinstance(limits.get(road), float)]
    assert order == sorted(order)


@over(sorted(rows()))
def test_a_row_says_what_its_file_does_not(code: str) -> None:
    """A country with a file has nothing twice."""
    row = _row(code)
    if row.is_whole:
        assert f"{code}" not in Atlas().codes()
    else:
        (own,) = [entry for entry in Atlas().country(code) if entry.kind == "country"]
        told = {topic for topic, rules in own.by_topic.items() if not any(rule.on_request for rule in rules)}
        assert told.isdisjoint(row.country.by_topic)


@pytest.mark.parametrize(("lat", "lon"), [(48.86, 2.35), (53.8, -1.55), (13.75, 100.5), (-34.6, -58.38)])
def test_seat_belts_are_told_on_request_alone(lat: float, lon: float, locate: Callable[..., GeoContext]) -> None:
    context = locate(lat, lon)
    assert not any(line.startswith("Seat belts:") for line in context.text().splitlines())
    assert any(line.text.startswith("Seat belts: ") for line in context.lines)
    assert "seat_belts" in sensor._topics(frozenset({"belt"}))


@pytest.mark.parametrize(
    ("lat", "lon", "said"),
    [
        (
            41.01,
            28.95,
            "Default limit: 50 km/h in built-up areas (TR traffic law, on OpenStreetMap's wiki, secondary",
        ),
        (-1.29, 36.82, "Default limit: 50 km/h in built-up areas (KE"),
        (25.06, -77.34, "Default limit: 25 mph in built-up areas (BS"),
        (16.84, 96.17, "Default limit: 30 mph in built-up areas (MM"),
    ],
)
def test_the_default_limit_says_where_it_comes_from(
    lat: float, lon: float, said: str, locate: Callable[..., GeoContext]
) -> None:
    assert any(line.startswith(said) for line in locate(lat, lon, road_class="residential").text().splitlines())


@pytest.mark.parametrize(("lat", "lon"), [(54.60, -5.93), (55.0, -7.32), (54.18, -6.34)])
def test_northern_ireland_has_instruments_of_its_own(
    lat: float, lon: float, locate: Callable[..., GeoContext]
) -> None:
    """None of its lines cites Great Britain's; only what was read there is verified."""
    context = locate(lat, lon, weather=None, road_class="secondary", built_up=True, speed_mps=0.0)
    found = [*context.default_limits, *context.reduced_limits, *context.rules]
    legal = [one.rule for one in found if one.rule.law not in ("custom", "none known", "traffic law")]
    assert legal
    assert all(rule.id.startswith("GB-NIR.") for rule in legal)
    assert {rule.id for rule in legal if rule.status is Status.VERIFIED} == {"GB-NIR.limit.built_up"}
