"""A folder of tasks of one's own joins the catalogue, or is refused with file, line and reason."""

import re
import time
from pathlib import Path

import pytest

import automotive_cosim.tasks
from automotive_cosim.cockpit.signals import SEAT
from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.tasking.catalogue import Catalogue
from automotive_cosim.tasking.checks import AllOf, AppDataIs, SignalIs
from automotive_cosim.tasking.decoding import several
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.reading import moves
from automotive_cosim.tasking.task import Dimension, Task
from tests.laws import over

OWN = """
from automotive_cosim.tasking.checks import SignalIs
from automotive_cosim.cockpit.signals import HVAC
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import driving, Trigger

TASKS = (
    Task(
        "own_sync",
        Module.HVAC,
        Dimension.EXPLICIT_CONTROL,
        ("Sync off.", "One side each.", "Split the zones.", "Separate temperatures."),
        Half(
            Start("paris_centre", "centre"), Trigger(driving(), 3.0, 60.0), SignalIs(HVAC.SYNC, (False,)),
            (Open("climate"), Tap("hvac.sync")), Deadline(30.0, "a wish"), Basis.WISH,
        ),
    ),
)
"""
DATA = """[default]
module = "hvac"
dimension = "driving_alignment"
trigger = ["driving", 3, 60]
deadline = "comfort"

[own_pair]
parameters.seat = { of = ["my", "her"], signal = ["SEAT.DRIVER_HEATING", "SEAT.PASSENGER_HEATING"] }
parameters.level = [50.0, 100.0]
templates = "Warm {seat} seat. / Heat {seat} seat. / {seat} seat is cold. / Seat heating: {seat}."
difference = "place: here, or there"
start = { like = "paris_centre", weather = [11, 98, 0, 45, 100, 120, 4], signals = "SEAT.DRIVER_HEATING = 0" }
goal = '{seat.signal} = {level} and phone.do_not_disturb = true'
moves = '''open climate; tap hvac.driver_seat_heating x2;
    tap phone.quiet'''
slips = "first 1; last 1 / first 2"
second = { start = { origin = [9.9, 50.5] }, basis = "law: DE.rear_fog", declares = "infeasible: law" }
"""


def read(folder: Path, text: str, name: str = "own.toml") -> Catalogue:
    (folder / name).write_text(text)
    catalogue = Catalogue()
    catalogue.add_folder(folder)
    return catalogue


FAMILY = DATA.replace("[own_pair]", "[own]").replace(
    "second = {",
    "each.north.start.origin = [2.5, 50]\neach.south = { goal = 'phone.do_not_disturb = true' }\nsecond = {",
)


def test_a_family_is_a_task_for_each_of_its_members(tmp_path):
    family = read(tmp_path, FAMILY)
    assert list(family) == ["own_north", "own_south"]
    north, south = family.values()
    assert (north.templates, north.second) == (south.templates, south.second)
    assert north.first.start.origin == (2.5, 50)
    assert south.first.start.origin is None
    assert north.first.goal != south.first.goal
    with pytest.raises(UserError, match=r"own.toml line 18 \[own\]: each.south.gaol"):
        read(tmp_path, FAMILY.replace("south = { goal", "south = { gaol"))


def test_a_folder_joins(tmp_path):
    assert read(tmp_path, OWN, "own.py")["own_sync"].optimal_steps == 3
    assert list(read(tmp_path, DATA)) == ["own_sync", "own_pair"]


def test_a_pair_of_ten_lines_is_a_task(tmp_path):
    pair: Task = read(tmp_path, DATA)["own_pair"]
    assert pair.dimension is Dimension.DRIVING_ALIGNMENT
    assert pair.templates[2] == "{seat} seat is cold."
    first, second = pair.first, pair.second
    assert second is not None
    heated, quiet = first.goal.checks
    assert isinstance(first.goal, AllOf)
    assert isinstance(heated, SignalIs)
    assert heated.signal.means == {"my": SEAT.DRIVER_HEATING, "her": SEAT.PASSENGER_HEATING}
    assert quiet == AppDataIs("phone.do_not_disturb", (True,))
    assert first.moves == (Open("climate"), Tap("hvac.driver_seat_heating", 2), Tap("phone.quiet"))
    assert first.slips == ((Open("climate"), Tap("phone.quiet")), first.moves[:2])
    assert (second.rule, second.reasons, second.moves) == ("DE.rear_fog", {"law"}, ())
    assert second.start.weather == first.start.weather
    assert (first.start.origin, second.start.origin) == (None, (9.9, 50.5))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("TASKS = (", r"own.py, line 1: '\(' was never closed"),
        ("\n\nTASKS = (undefined,)", r"own.py, line 3: NameError"),
        ("TASKS = (1, 2)", r"own.py has no TASKS"),
        ("raise SystemExit(0)", r"own.py, line 1: SystemExit"),
        ("def f(): f()\nf()", r"own.py, line 1: RecursionError"),
        (OWN.replace('"Sync off.", ', ""), r"own.py, line 10: .* has 3 phrasings"),
        (OWN.replace("Sync off.", "Sync {how}."), r"own.py, line 10: .* does not declare: how"),
        (OWN.replace("    ),\n)", "    ),\n) * 2"), r"own.py, line 10: .* occurs twice"),
    ],
    ids=["syntax", "name", "no tasks", "exit", "recursion", "phrasings", "parameter", "twice"],
)
def test_a_broken_file_is_refused_with_its_line(tmp_path, text, said):
    with pytest.raises(UserError, match=said):
        read(tmp_path, text, "own.py")


@over(
    [
        ("SEAT.DRIVER_HEATING = 0", "SEAT.DRIVER_HEATNG = 0", 12, "did you mean 'SEAT.DRIVER_HEATING'"),
        ("SEAT.DRIVER_HEATING = 0", "SEAT.DRIVER_HEATING = 101", 12, "-100 to 100"),
        ("[11, 98, 0, 45, 100, 120, 4]", "[11, 98, 0, 45, 100, 120]", 12, "lacks 'wind_speed_10m'"),
        ('"paris_centre"', '"paris_center"', 12, "did you mean 'paris_centre'"),
        ("origin = [9.9, 50.5]", "origin = [9.9]", 17, "it must have 2"),
        ("origin = [9.9, 50.5]", "origin = [50.5, 99.9]", 17, "it must be at most 90"),
        ("origin = [9.9, 50.5]", 'start = "16.06.2026"', 17, "it must be a local date and time"),
        ("origin = [9.9, 50.5]", 'start = "2026-06-16T12:30:00Z"', 17, "it must be a local date and time"),
        ("DE.rear_fog", "DE.rear_fogg", 17, "did you mean 'DE.rear_fog'"),
        ('deadline = "comfort"', 'deadline = [-10, "soon"]', 5, "it must be above 0"),
        ('["driving", 3, 60]', '["driving", -3, 60]', 4, "it must be at least 0"),
        ("basis = ", "base = ", 17, "did you mean 'basis'"),
        ("tap hvac", "tab hvac", 14, "did you mean 'tap'"),
        ("open climate", "open climat", 14, "did you mean 'climate'"),
        ("seat_heating x2", "seat_heating twice", 14, "expected ';'"),
        ("first 1", "first 4", 16, "the solution has 3 moves"),
        ("{seat.signal}", "{seat.signl}", 13, "did you mean 'signal'"),
        ("= {level}", "= {levl}", 13, "did you mean 'level'"),
        ("and phone", "und phone", 13, "expected 'and' or 'or'"),
        ("phone.do_not_disturb", "phone.do_not_distrub", 13, "did you mean 'phone.do_not_disturb'"),
        ('"her"]', '"her", "his"]', 8, "3 values and 2"),
        ("infeasible: law", "infeasible: lav", 17, "did you mean 'law'"),
        ("difference", "differnce", 11, "did you mean 'difference'"),
        ('module = "hvac"', 'module = "hvca"', 2, "did you mean 'hvac'"),
        ('["driving", 3, 60]', '["drivin", 3, 60]', 4, "did you mean 'driving'"),
        ('["driving", 3, 60]', '["driving", "3", 60]', 4, "it must be a number"),
        (" / {seat} seat is cold.", "", 7, "has 3 phrasings"),
        ('driving_alignment"', "driving_alignment", 3, "not TOML"),
    ]
)
def test_a_broken_table_is_refused_with_its_line(right, wrong, line, said, tmp_path):
    assert right in DATA
    with pytest.raises(UserError, match=re.escape(said)) as caught:
        read(tmp_path, DATA.replace(right, wrong, 1))
    assert f"line {line}" in str(caught.value)
    assert "\n" not in str(caught.value)


SELF = "[names]\nround = { like = 'round' }\n"
DOUBLING = "[names]\na30 = {}\n" + "".join(
    f"a{n} = {{ like = 'a{n + 1}', start = {{ like = 'a{n + 1}' }} }}\n" for n in range(30)
)
BRACES = "(" * 3000 + ")" * 3000
SPACES = " " * 9000


@over(
    [
        ('["my", "her"]', '["{level.__class__}", "her"]', "in braces"),
        ('"Warm {seat} seat.', '"Warm {seat.__class__} seat.', "'seat.__class__' in braces"),
        ('"Warm {seat} seat.', '"Warm {seat[0]} seat.', "'seat[0]' in braces"),
        ('"Warm {seat} seat.', '"Warm {seat:>99} seat.', "'seat' in braces, and more"),
        ('"Warm {seat} seat.', '"Warm seat} seat.', "Single '}'"),
        ('"Warm {seat} seat.', '"Warm {seat!r} seat.', "'seat' in braces, and more"),
        ("tap phone.quiet", "wait 99999999999", "from 1 to 10,000 s"),
        ("tap phone.quiet", "wait 9000; wait 9000", "more than 1,000 moves"),
        ("first 1; ", "first -1; ", "the solution has 3 moves"),
        ("phone.do_not_disturb = true", BRACES, "nested too deeply"),
        ("tap phone.quiet", "tap " + SPACES * 2, "longer than 10,000 characters"),
        ("difference = ", "only_english = 'x'\nde = { templates = ['a'] }\ndifference = ", "1 in German"),
        ("difference = ", "de = { words = {} }\ndifference = ", "lacks 'templates'"),
        ("difference = ", "de = { templates = ['a'], lines = { a = '{:>99}' } }\ndifference = ", "in both"),
        (
            "difference = ",
            "de = { templates = ['a'], lines = { '{}{}{}{}' = 'a' } }\ndifference = ",
            "up to 3 times",
        ),
        ("own_pair", "'../own_pair'", "up to 100 letters"),
        ("own_pair", '"own\\u001b[31m\\npair"', "up to 100 letters"),
        ("own_pair", "o" * 101, "up to 100 letters"),
        ("[50.0, 100.0]", "[]", "texts or numbers"),
        ("[50.0, 100.0]", "[[50.0], [100.0]]", "texts or numbers"),
        (
            "[50.0, 100.0]",
            f"[50.0]\nparameters.some = {[*range(1000)]}\nparameters.more = {[*range(1000)]}",
            "2e+06 sets",
        ),
        ("weather = [", f"origin = [1{'0' * 400}, 0], weather = [", "cannot be read"),
        ('"paris_centre",', f"'round' }}\n{SELF}#", "like itself"),
        ('"paris_centre",', f"'a0' }}\n{DOUBLING}#", "values and characters"),
        ('"paris_centre",', f'"paris_centre", scenario = "{"a" * 5000}",', "no scenario named"),
        ("parameters.level", "parameters.some = 3\nparameters.level", "it must be a list"),
        ("[default]", "names = 3\n[default]", "it must be a table"),
        ("slips = ", "slips = 3 # ", "it must be a list"),
        ("goal = ", "goal = { param = [] } # ", "another kind of value"),
        ("goal = ", "goal = 3 # ", "it must be a text"),
    ]
)
def test_a_table_that_means_harm_is_refused_in_a_line_and_at_once(right, wrong, said, tmp_path, monkeypatch):
    assert right in DATA
    monkeypatch.setattr(bounds, "TASK_COST", 200_000)
    begun = time.process_time()
    with pytest.raises(UserError, match=re.escape(said)) as caught:
        read(tmp_path, DATA.replace(right, wrong, 1))
    assert time.process_time() - begun < 20
    assert len(str(caught.value)) < 1000 + len(str(tmp_path))
    assert str(caught.value).isprintable()


def test_no_task_takes_the_name_of_a_shipped_one(tmp_path):
    (tmp_path / "own.toml").write_text(DATA.replace("own_pair", "hvac_fan_max"))
    with pytest.raises(UserError, match=r"line 7: .*occurs twice"):
        Catalogue(Path(automotive_cosim.tasks.__file__).parent).add_folder(tmp_path)


def test_reading_what_goes_on_over_lines_costs_no_more_than_its_length():
    told = "tap\n" + " " * 200_000 + "a"
    begun = time.process_time()
    assert moves(told) == (Tap("a"),)
    assert several(told + " / b") == ("tap a", "b")
    assert time.process_time() - begun < 5


@pytest.mark.slow
@pytest.mark.parametrize(("text", "name"), [(OWN, "own.py"), (DATA, "own.toml")])
def test_a_file_cut_off_anywhere_is_read_or_refused(tmp_path, text, name):
    for end in range(0, len(text), 7):
        try:
            read(tmp_path, text[:end], name)
        except UserError as error:
            assert "\n" not in str(error)


@pytest.mark.parametrize("where", ["nowhere", "."])
def test_a_folder_without_tasks_is_refused(tmp_path, where):
    with pytest.raises(UserError, match="--tasks-from"):
        Catalogue().add_folder(tmp_path / where)
