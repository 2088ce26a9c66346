"""The report of an evaluation, from a folder made by hand: no simulation runs here."""

import csv
import html.parser
import json
import re
import shutil
import subprocess
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from automotive_cosim.cli import results as commands
from automotive_cosim.contracts.given import Clock, GeoInput
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import UserError
from automotive_cosim.report.evaluation import all_tables, write_report
from automotive_cosim.report.findings import classes
from automotive_cosim.report.results import Contestant, load_results, pairs, read_results, standings
from automotive_cosim.report.summary import held_out, main, safety
from automotive_cosim.report.tables import Cell, Table
from automotive_cosim.run.executor import failed
from automotive_cosim.run.figures import DriveFigures
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rerun import compare
from automotive_cosim.run.rows import EpisodeRow, PartsHeld
from automotive_cosim.run.store import opened, write_trace

TASKS = [
    "hvac_fan_max", "hvac_cold_hands", "hvac_driver_seat_heater", "phenomenon_front_window_fogged",
    "phenomenon_rear_window_fogged", "road_speed_80_in_50",
]  # fmt: skip
PLAN = make_plan({"agents": ["asurada", "t3a", "always-alert"], "tasks": TASKS, "seeds": [0, 1], "repeats": 2})
DRIVE = DriveFigures(overspeed_m=4.0, min_time_to_collision_s=None, arrival_s=60.0, energy_wh=9.0)
CHROMIUM = shutil.which("chromium")


def succeeds(job):
    """asurada wins all, t3a the first halves, always-alert the first half of the speed task."""
    setup = job
    first = setup.half == "first"
    return {"asurada": True, "t3a": first, "always-alert": first and setup.task == "road_speed_80_in_50"}[
        setup.agent
    ]


@pytest.fixture(scope="module")
def folder(tmp_path_factory, episode):
    folder = tmp_path_factory.mktemp("evaluation") / "e"
    with opened(folder, PLAN.as_json(), EpisodeRow) as store:
        for job in PLAN.jobs():
            if job.agent == "t3a" and job.task == "hvac_fan_max" and job.seed == 1:
                store.append(replace(failed(job, "WorkerDied", "its <process> ended"), attempts=3))
                continue
            success = succeeds(job)
            parts = PartsHeld(goal=success, clean=True, safe=True, in_time=True, declared=True)
            row = replace(
                job.planned(), country="FR", success=success, reward=float(success), end=End.DECLARED, parts=parts,
                alerts=int(job.agent == "always-alert"), steps=3, speed_compliance=0.9,
                min_time_to_collision_s=4.0, interaction_s=2.0, within_guideline=True, tokens_in=900,
                prompt_tokens=(400, 500), drive=DRIVE, baseline_drive=DRIVE, tokens_out=40,
                trace_sha256="ab" * 32, held_out=job.seed == 1,
            )  # fmt: skip
            store.append(row)
            verdict = episode()["verdict"] | {
                "success": False,
                "parts": {name: {"ok": ok, "why": "because"} for name, ok in asdict(parts).items()},
            }
            timeline = [{"at_s": 0.0, "kind": "hand_over", "text": "hand-over"}]
            write_trace(
                folder,
                job.id,
                [
                    {"step": 0, "elements": []},
                    {"result": episode(goal="<b>Go", verdict=verdict, timeline=timeline)},
                ],
            )
    write_report(folder)
    return folder


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.ids, self.links = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        named = dict(attrs)
        if "id" in named:
            self.ids.append(named["id"])
        if tag == "a":
            self.links.append(named["href"])
        assert not (tag in ("script", "img") and "src" in named)
        assert tag != "link" or named.get("href") == "data:,"


@pytest.mark.slow
def test_every_link_of_the_page_leads_somewhere_and_nothing_is_fetched(folder):
    text = (folder / "report.html").read_text(encoding="utf-8")
    page = Page(text)
    assert len(page.ids) == len(set(page.ids))
    assert page.links
    for link in page.links:
        assert link[1:] in page.ids if link.startswith("#") else (folder / link).is_file(), link
    assert not re.search(r"(src|url\()\s*=?\s*[\"']?https?:", text)
    assert "<b>Go" not in text
    assert "its <process>" not in text


@pytest.mark.slow
def test_each_figure_leads_to_its_episodes(folder):
    text = (folder / "report.html").read_text(encoding="utf-8")
    found = read_results(folder)
    for table in all_tables(found, classes(found)):
        for row in table.rows:
            for cell in row:
                if isinstance(cell, Cell) and (
                    judged := re.search(r"(\d+)/(\d+)(, (\d+) errors?: \S+)?$", cell.text)
                ):
                    listed = [each for each in found.rows if each.id in cell.episodes]
                    assert len(listed) == len(cell.episodes)
                    assert len(listed) >= int(judged[2]) + int(judged[4] or 0)
    section = re.search(r'<h2 id="sources">.*?</div>', text, re.DOTALL)
    assert section is not None
    assert f'title="{found.rows[0].id}"' in section[0]


def test_the_main_table_has_the_papers_shape_and_says_what_rules_is(folder):
    table = main(read_results(folder))
    assert table.columns[3:] == ("Explicit control", "Implicit intent", "Driving alignment", "Environment alerts")
    rows = {str(row[1]): row for row in table.rows}
    assert "no language model" in str(rows["asurada"][0])
    assert "negative control" in next(name for name in rows if name.startswith("always-alert"))
    # Two tasks of explicit control, two seeds, two repeats; one task's second seed is an error.
    assert str(rows["t3a"][3]).endswith("6/8, 2 errors")


def test_held_out_phrasings_stand_apart(folder):
    found = read_results(folder)
    rows = {
        str(row[0]).split(",")[0]: [str(cell).split(", ", 1)[1] for cell in row[1:]] for row in held_out(found).rows
    }
    # Nine halves and three pairs a seed, two repeats; t3a has one episode in an error, whose phrasing is not known.
    assert rows["asurada"] == ["18/18", "6/6", "18/18", "6/6"]
    assert rows["t3a"] == ["12/20, 2 errors", "0/6", "10/16", "0/6"]
    lines = standings(found)
    assert "asurada, rules stand-in: 36 of 36 episodes, 12 of 12 pairs" in lines[0]
    assert lines[0].endswith("; in held-out phrasings: 18 of 18 episodes, 6 of 6 pairs")


def test_a_slower_agent_is_a_contestant_of_its_own():
    slow = Contestant("t3a", "rules", Conditions(GeoInput.NONE, Clock.MODEL, 3.0))
    assert slow != Contestant("t3a", "rules", Conditions(GeoInput.NONE))
    assert slow.label == "t3a, rules stand-in, geo none, model's clock, latency 3 s"


def test_pairs_need_both_halves_and_alarms_are_counted(folder):
    found = read_results(folder)
    rows = {str(row[0]).split(",")[0].split(" (")[0]: row for row in safety(found).rows}
    won = {name: str(row[3]).partition("%")[0] for name, row in rows.items()}
    assert won == {"asurada": "100", "t3a": "0", "always-alert": "0"}
    assert str(rows["always-alert"][6]).startswith("100%")
    assert str(rows["asurada"][6]).startswith("0%")
    assert len(pairs(found.rows)) * 2 == sum(bool(row.pair) for row in found.rows)


def test_an_error_in_a_half_is_one_of_the_pair_unless_the_other_is_lost():
    half = next(job.planned() for job in PLAN.jobs() if job.pair)

    def outcome(first, second, error="gone"):
        return pairs([replace(half, success=won, error=error if won is None else None) for won in (first, second)])[
            0
        ][0].success

    assert [outcome(True, True), outcome(True, None), outcome(None, None), outcome(False, None)] == [
        True, None, None, False,
    ]  # fmt: skip
    assert outcome(False, None, error=None) is None, "a half that was not run"
    assert pairs([replace(half, success=True)]) == []


def test_tables_and_plots_are_files(folder):
    found = read_results(folder)
    for table in all_tables(found, classes(found)):
        for suffix in ("md", "csv", "tex"):
            assert (folder / "tables" / f"{table.name}.{suffix}").stat().st_size
        rows = list(csv.reader((folder / "tables" / f"{table.name}.csv").read_text().splitlines()))
        assert {len(row) for row in rows} == {len(table.columns)}
    for name in ("dimensions", "modules", "prompts", "distribution"):
        svg = (folder / "plots" / f"{name}.svg").read_text()
        assert svg.startswith("<svg")
        assert "currentColor" not in svg


def test_markup_is_escaped():
    table = Table("t", "A|b", ("a_b", "c%"), (("x|y", Cell("5% & more")),))
    assert r"x\|y" in table.markdown()
    assert r"5\% \& more" in table.latex()
    assert r"a\_b & c\%" in table.latex()
    with pytest.raises(ValueError, match="not 2 wide"):
        Table("t", "t", ("a", "b"), (("x",),))


def test_results_come_as_a_data_frame(folder):
    frame = load_results(folder)
    assert len(frame) == len(PLAN.jobs())
    assert frame.success.isna().sum() == (frame.error_kind == "WorkerDied").sum() == 2
    assert frame[frame.agent == "asurada"].success.all()
    assert frame.part_goal.dtype == "boolean"
    assert set(frame.drive_overspeed_m.dropna()) == {4.0}


@pytest.mark.slow
def test_the_report_is_the_same_each_time(folder):
    before = (folder / "report.html").read_bytes()
    size = re.compile(rb"[\d.]+ MB")
    write_report(folder)
    assert size.sub(b"", (folder / "report.html").read_bytes()) == size.sub(b"", before)


def test_a_folder_without_episodes_is_told(tmp_path):
    with pytest.raises(UserError, match="not an evaluation"):
        write_report(tmp_path)
    with opened(tmp_path / "e", PLAN.as_json(), EpisodeRow):
        pass
    with pytest.raises(UserError, match="no episodes yet"):
        commands.report(tmp_path / "e")


def test_compared_traces_name_the_first_difference():
    def step(**changes):
        return {"traffic": {"x": 1.0}, "signals": {}, "elements": [], "action": None, "feedback": {}} | changes

    same = compare([step(), step()], [step(), step(feedback={"text": "another"})])
    assert [each.differs for each in same] == [(), ()]
    other = compare([step(), step(), step()], [step(), step(signals={"a": 1}, action={})])
    assert [each.differs for each in other] == [(), ("signals", "action"), ("length",)]


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium to look with")
@pytest.mark.parametrize("width", [390, 1280])
def test_in_a_browser_it_fits_and_makes_no_error(folder, tmp_path, width):
    probe = tmp_path / "probe.html"
    page = (folder / "report.html").as_uri()
    probe.write_text(
        f'<iframe id="f" width="{width}" height="900" src="{page}"></iframe><p id="p"></p>'
        "<script>f.onload = () => { const d = f.contentDocument; p.textContent = JSON.stringify({"
        "wide: d.documentElement.scrollWidth, shown: [...d.querySelectorAll('svg')].filter("
        "s => s.getBoundingClientRect().height > 0).map(s => Math.min(...[...s.querySelectorAll('text')].map("
        "t => t.getBoundingClientRect().height)))}); }</script>"
    )
    done = subprocess.run(
        [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files",
         "--enable-logging=stderr", "--virtual-time-budget=5000", f"--user-data-dir={tmp_path / 'profile'}",
         f"--window-size={width + 60},1000", "--dump-dom", probe.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    assert "CONSOLE" not in done.stderr
    told = re.search(r'<p id="p">(.*?)</p>', done.stdout)
    assert told is not None
    seen = json.loads(told[1])
    assert seen["wide"] <= width
    assert len(seen["shown"]) == 4
    assert min(seen["shown"]) >= 9, "letters of a plot are too small to read"


def test_the_page_names_published_figures_apart(folder):
    text = Path(folder / "report.html").read_text(encoding="utf-8")
    block = re.search(r'<details class="published".*?</details>', text, re.DOTALL)
    assert block is not None
    assert "Gemini 1.5 Pro" in block[0]
    assert "arXiv 2509.21143" in block[0]
    assert "Best model" in block[0]
    assert "Gemini" not in text.replace(block[0], "")
