"""The pages in a real browser: Chromium, without a network. Skipped where Playwright or Chromium is missing."""

from __future__ import annotations

import gzip
import json
import os
import re
import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.contracts import Action, ActionType, BoundingBox
from automotive_cosim.episode.episode import Episode
from automotive_cosim.formats.writing import is_being_written, mark_as_written
from automotive_cosim.run.trial import Shot, TrialObserver
from automotive_cosim.run.trial_folder import shown
from automotive_cosim.serve.dealing import PeoplePlan
from automotive_cosim.serve.play import Game
from automotive_cosim.serve.study import PeopleStudy
from automotive_cosim.tasking.task import Module
from automotive_cosim.traffic.fork import Simulations

from .conftest import (
    HOSTILE,
    Browser,
    result,
    road,
    step,
    write_adoption,
    write_drive,
    write_evaluation,
    write_live_drive,
    write_record,
    write_study,
)

playwright = pytest.importorskip("playwright.sync_api", reason="pip install playwright")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: apt-get install chromium"),
]

Serving = Callable[..., Browser]
expect = playwright.expect
PATIENCE_MS = 20_000


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        arguments = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=arguments)
        yield browser
        browser.close()


@pytest.fixture
def opened(chromium: Any) -> Iterator[Callable[..., Any]]:
    """Opens a server's address and goes to a page; at the end, nothing may have gone wrong or elsewhere."""
    contexts, wrong = [], list[str]()

    def open_(browser: Browser, page: str = "#/", address: str = "", **options: Any) -> Any:
        context = chromium.new_context(**({"viewport": {"width": 1280, "height": 900}} | options))
        contexts.append(context)
        tab = context.new_page()
        tab.set_default_timeout(PATIENCE_MS)
        tab.on("pageerror", lambda error: wrong.append(str(error)))
        tab.on("console", lambda said: wrong.append(said.text) if "Content Security" in said.text else None)
        tab.on("request", lambda asked: None if "//127.0.0.1:" in asked.url else wrong.append(asked.url))
        tab.goto(address or browser.server.address)
        tab.goto(f"http://127.0.0.1:{browser.server.server_port}/{page}")
        return tab

    yield open_
    for context in contexts:
        context.close()
    assert not wrong


def run_page(browser: Browser) -> str:
    return f"#/run/{browser('/api/runs').json['records'][0]['id']}"


def test_replay_by_mouse_and_keyboard_and_a_link_to_an_instant(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    write_record(tmp_path / "run")
    page = opened(serving(tmp_path))
    page.get_by_role("link", name="road_speed_80_in_50").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("road_speed_80_in_50")
    expect(page.get_by_text("✓ Goal")).to_be_visible()
    page.locator(".steps button").nth(2).click()
    expect(page.locator(".clock")).to_have_text("+4 s")
    expect(page.locator(".screen")).to_have_attribute("src", re.compile(r"/pictures/2$"))
    expect(page.locator(".target")).to_be_visible()
    expect(page).to_have_url(re.compile(r"\?at=4$"))
    page.reload()
    expect(page.locator(".clock")).to_have_text("+4 s")
    page.locator("body").press(".")
    expect(page.locator(".clock")).to_have_text("+6 s")
    expect(page.get_by_role("heading", name="Step 3: taps “Warn driver”")).to_be_visible()
    expect(page.locator(".about")).to_contain_text("72 km/h limit 50 · Rue")
    expect(page.locator(".about")).to_contain_text("1 other vehicle in sight")
    page.get_by_label("Time in the drive").press("Home")
    expect(page.locator(".clock")).to_have_text("−2 s")
    page.locator("h1").press(" ")
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    expect(page.locator(".clock")).not_to_have_text("−2 s")


def test_a_vehicle_can_be_picked_and_its_name_is_text(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    write_record(tmp_path / "run", goal=HOSTILE, task=HOSTILE)
    browser = serving(tmp_path)
    page = opened(browser, run_page(browser))
    expect(page.get_by_role("heading", level=1)).to_have_text(HOSTILE)
    canvas = page.locator("canvas")
    box = canvas.bounding_box()
    middle_of_the_bus = {"x": box["width"] / 2 - 5 * 3.2, "y": box["height"] * 0.66 - 36 * 3.2}
    canvas.click(position=middle_of_the_bus)
    expect(page.locator(".vehicle")).to_contain_text(HOSTILE)
    expect(page.locator(".vehicle")).to_contain_text("hazard lights")
    page.get_by_role("button", name="Follow", exact=True).click()
    expect(page.get_by_role("button", name="Follow the car")).to_have_attribute("aria-pressed", "false")
    canvas.press("f")
    expect(page.get_by_role("button", name="Follow the car")).to_have_attribute("aria-pressed", "true")
    assert page.locator("img[onerror]").count() == 0
    assert "broken" not in page.title().partition(" · ")[2]


def test_a_running_episode_grows_and_a_lost_connection_comes_back(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    run = write_record(tmp_path / "run", steps=1, finished=False)
    with (run / "road.jsonl.gz").open("wb") as raw:
        mark_as_written(raw)
        with gzip.GzipFile(fileobj=raw, mode="wb") as file:

            def write(lines: list[dict[str, Any]]) -> None:
                file.write("".join(json.dumps(line) + "\n" for line in lines).encode())
                file.flush()
                raw.flush()

            write(road(range(-2, 1)))
            browser = serving(tmp_path)
            page = opened(browser, run_page(browser))
            expect(page.locator(".pill")).to_have_text("Running")
            expect(page.locator(".steps button")).to_have_count(1)
            with (run / "steps.jsonl").open("a", encoding="utf-8") as steps:
                steps.write(json.dumps(shown([step(0), step(1)])[1]) + "\n")
            write(road(range(1, 3))[3:])
            expect(page.locator(".steps button")).to_have_count(2)

            page.context.set_offline(True)
            expect(page.locator(".warning")).to_contain_text("does not answer")
            write(road(range(3, 8))[3:])
            page.context.set_offline(False)
            expect(page.locator(".warning")).to_be_hidden()
            expect(page.get_by_label("Time in the drive")).to_have_attribute("max", "7")
    (run / "trial.json").write_text(json.dumps({"result": result()}), encoding="utf-8")
    expect(page.locator(".pill")).to_have_text("Success")
    expect(page.get_by_text("✓ Goal")).to_be_visible()


def test_results_are_filtered_down_to_a_step(serving: Serving, opened: Callable[..., Any], tmp_path: Path) -> None:
    page = opened(serving(write_evaluation(tmp_path / "mine")))
    page.get_by_role("link", name="mine").click()
    expect(page.locator("tbody tr")).to_have_count(2)
    page.get_by_label("Failed part").select_option("goal")
    expect(page.locator("tbody tr")).to_have_count(1)
    expect(page).to_have_url(re.compile("missing=goal"))
    page.reload()
    expect(page.locator("tbody tr")).to_have_count(1)
    page.get_by_label("Failed part").select_option("")
    page.locator("tbody a").first.click()
    expect(page.locator(".about")).to_contain_text("other vehicles were not recorded")
    page.locator(".steps button").nth(1).click()
    expect(page.get_by_role("heading", name="Step 1: taps “Warn driver”")).to_be_visible()


PLAYED = {
    Module.MAPS: "maps_voice_off",
    Module.HVAC: "hvac_fan_max",
    Module.ROAD: "road_heavy_foot",
    Module.PHENOMENON: "phenomenon_wiper_pace",
    Module.MEDIA: "media_forever",
    Module.APPS: "apps_reset_trip",
    Module.SYSTEM: "system_brightness",
    Module.COMMS: "comms_leave_me_alone",
}
"""A task of each module, which runs in the small scenario."""


class _Overseen(Game):
    """Knows the episode, so that a test can tell what would be right."""

    episode: Episode

    def begun(self, session: Episode, shot: Shot) -> None:
        self.episode = session
        super().begun(session, shot)

    @property
    def acts(self) -> int:
        """Acts so far, without the seconds that went by."""
        actions = (step.action for step in self.episode.steps[1:])
        return sum(action is not None and action.action_type is not ActionType.WAIT for action in actions)


@pytest.fixture
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    """A played second takes a fifth of one."""
    monkeypatch.setattr("automotive_cosim.serve.person.TICK_S", 0.2)


def boxes(game: _Overseen) -> dict[str, BoundingBox]:
    """What can be tapped, by its text."""
    return {each.text: each.bbox_pixels for each in game.episode.elements if each.is_clickable and each.text}


def until(page: Any, holds: Callable[[], bool]) -> None:
    """Lets the page live until something holds."""
    for _ in range(1000):
        if holds():
            return
        page.wait_for_timeout(20)
    raise AssertionError("it never came true")


def perform(page: Any, action: Action, game: _Overseen) -> int:
    """An action by hand; returns how many acts it takes."""
    if action.action_type is ActionType.OPEN_APP:  # by the dock, or by a tile
        app = str(action.app_name).capitalize()
        taps = [app] if app in boxes(game) else ["Apps", app]
        for name in taps:
            until(page, lambda name=name: name in boxes(game))
            box = boxes(game)[name]
            x, y = (box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2
            perform(page, Action(ActionType.CLICK, x=x, y=y), game)
        return len(taps)
    frame = page.locator(".frame").bounding_box()

    def at(x: float, y: float) -> tuple[float, float]:
        return frame["x"] + x / 1280 * frame["width"], frame["y"] + y / 720 * frame["height"]

    match action.action_type:
        case ActionType.CLICK:
            page.mouse.click(*at(action.x or 0, action.y or 0))
        case ActionType.INPUT_TEXT:
            page.mouse.click(*at(action.x or 0, action.y or 0))
            page.get_by_label("Type into").fill(action.text)
            page.get_by_role("button", name="Enter text").click()
        case ActionType.SWIPE:
            across, down = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}[str(action.direction)]
            far, (x, y) = action.distance_px or 300, (action.x or 0, action.y or 0)
            page.mouse.move(*at(x, y))
            page.mouse.down()
            page.mouse.move(*at(x + across * far, y + down * far), steps=3)
            page.mouse.up()
        case ActionType.SCROLL:
            page.mouse.move(*at(640, 400))
            page.mouse.wheel(0, 100 if action.direction == "down" else -100)
        case ActionType.STATUS:
            page.get_by_label("Reason for declining").select_option(str(action.reason or "none"))
            names = {"complete": "Done", "not_needed": "Not needed", "infeasible": "Can't or not allowed"}
            page.get_by_role("button", name=names[str(action.goal_status)]).click()
        case _:
            raise AssertionError(f"no hand for {action}")
    return 1


@pytest.mark.usefixtures("hasty")
def test_the_reference_solution_of_a_task_of_each_module_succeeds_by_hand(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path, simulations: Simulations
) -> None:
    assert set(PLAYED) == set(Module)
    game = _Overseen(tmp_path, "grid", simulations)
    page = opened(serving(tmp_path, game=game))
    for task in PLAYED.values():
        page.get_by_role("link", name="Play").click()
        page.get_by_label("Task or drive").select_option(task)
        page.get_by_label("Your code name").fill("blue heron")
        page.get_by_label("Seed").fill("0")
        page.get_by_role("button", name="Begin").click()
        expect(page.locator(".said")).to_be_visible(timeout=60_000)
        episode, oracle = game.episode, Oracle()
        oracle.brief(episode.instance, drawn=episode.world.cockpit.drawn)
        page.locator(".frame").scroll_into_view_if_needed()
        while game.scene().state == "acting":
            action, before = oracle.act(replace(episode.observation, elements=None)), game.acts
            hands = perform(page, action, game)
            until(page, lambda wanted=before + hands: game.acts >= wanted)
            if action.action_type is ActionType.STATUS:
                break
        page.get_by_role("link", name="See the verdict").click(timeout=60_000)
        expect(page.locator(".pill")).to_have_text("Success")
        expect(page.locator(".head")).to_contain_text("human · blue heron")


@pytest.mark.usefixtures("hasty")
def test_a_person_practises_by_keyboard_alone(
    serving: Serving,
    opened: Callable[..., Any],
    tmp_path: Path,
    simulations: Simulations,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("automotive_cosim.serve.play.Film", lambda folder: TrialObserver())  # it takes seconds
    page = opened(serving(tmp_path, game=Game(tmp_path, "grid", simulations)), "#/play?task=hvac_fan_max")
    page.get_by_role("checkbox").focus()
    page.keyboard.press("Space")
    page.get_by_role("button", name="Begin").focus()
    page.keyboard.press("Enter")
    expect(page.locator(".said")).to_be_visible(timeout=60_000)
    page.get_by_role("button", name="Pause").focus()
    page.keyboard.press("Enter")
    expect(page.locator(".playing [role=status]")).to_contain_text("clock stopped")
    page.get_by_role("button", name="Resume").focus()
    page.keyboard.press("Enter")
    page.context.set_offline(True)
    expect(page.get_by_role("alert")).to_contain_text("does not answer")
    page.context.set_offline(False)
    expect(page.get_by_role("alert")).to_be_hidden()
    page.get_by_role("button", name="Climate", exact=True).first.focus()
    page.keyboard.press("Enter")
    fan = page.get_by_role("button", name="Max: Fan at full speed")
    expect(fan).to_have_count(1)
    fan.focus()
    page.keyboard.press("Enter")
    expect(page.locator(".playing [role=status]")).to_contain_text("Max: done")
    page.keyboard.press("Escape")
    expect(fan).to_have_count(0)
    page.get_by_role("button", name="Done").focus()
    page.keyboard.press("Enter")
    page.get_by_role("link", name="See the verdict").click(timeout=60_000)
    expect(page.locator(".pill")).to_have_text("Success")


@pytest.mark.usefixtures("hasty")
def test_two_people_take_part_in_a_study_at_once_and_a_new_server_goes_on(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path, simulations: Simulations
) -> None:
    plan = PeoplePlan(("heron", "fox"), ("hvac_fan_max", "hvac_fan_percent"), scenario="grid")
    folder = tmp_path / "mine"

    def sit_down(browser: Browser, name: str) -> Any:
        page = opened(browser, "#/study", address=browser.server.people_address)
        expect(page.get_by_role("link", name="Tasks")).to_be_hidden()
        page.get_by_label("Your code name").select_option(name)
        page.get_by_role("button", name="Take part").click()
        return page

    def answer(page: Any) -> None:
        for box in page.locator("fieldset").all():
            box.get_by_label("mostly").check()
        page.get_by_role("button", name="Continue").click()

    first = PeopleStudy(plan, folder, simulations)
    browser = serving(tmp_path, study=first)
    pages = [sit_down(browser, name) for name in plan.people]
    for page in pages:
        page.get_by_role("button", name="Begin the next episode").click()
    for page in pages:
        expect(page.locator(".said")).to_be_visible(timeout=60_000)
    for page in pages:
        page.get_by_role("button", name="Not needed").click()
    for page in pages:
        expect(page.get_by_text("About what you just did")).to_be_visible(timeout=60_000)
        expect(page.get_by_text(re.compile("success|not solved"))).to_have_count(0)
    answer(pages[0])
    expect(pages[0].get_by_text("1 of 2 episodes done.")).to_be_visible()
    pages[0].get_by_role("button", name="Begin the next episode").click()
    expect(pages[0].locator(".said")).to_be_visible(timeout=60_000)
    first.close()  # as the server ends, in the middle of an episode

    second = PeopleStudy(plan, folder, simulations)
    browser = serving(tmp_path, study=second)
    pages = [sit_down(browser, name) for name in plan.people]
    answer(pages[1])
    for page in pages:
        expect(page.get_by_text("1 of 2 episodes done.")).to_be_visible()
    page = pages[0]
    page.get_by_role("button", name="Begin the next episode").click()
    expect(page.locator(".said")).to_be_visible(timeout=60_000)
    page.get_by_role("button", name="Give up").click()
    expect(page.get_by_text("About what you just did")).to_be_visible(timeout=60_000)
    answer(page)
    expect(page.locator("tbody tr")).to_have_count(2)
    expect(page.locator("tbody")).to_contain_text("not solved")
    lines = [line for line in second.export() if line["person"] == "heron"]
    assert [line["times_begun"] for line in lines] == [1, 2]
    assert [line["understood"] for line in lines] == [4, 4]
    owner = opened(browser, "#/study")
    expect(owner.get_by_text("heron: 2 of 2")).to_be_visible()
    expect(owner.get_by_text("fox: 1 of 2")).to_be_visible()


HEARS = """window.SpeechRecognition = class {
  start() { setTimeout(() => this.end("a bit warmer"), 50); }
  end(transcript) { this.onresult({ results: [[{ transcript }]] }); this.onend(); }
};"""
QUICK = {"every_ms": [900, 1000], "shown_ms": 800, "valid_ms": [100, 850]}


def test_a_dot_is_answered_with_a_key_and_words_are_spoken_where_the_browser_can(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = {"goal": "Warm my hands.", "said": [], "time_s": 0.0, "feedback": ["ok", ""], "context": "",
            "readings": {}, "elements": []}  # fmt: skip
    monkeypatch.setattr("automotive_cosim.serve.study.TOLD", QUICK)
    monkeypatch.setattr(Game, "begin", lambda game, *rest: game._tell(state="acting", told=told))
    study = PeopleStudy(
        PeoplePlan(("fox",), ("hvac_fan_max", "hvac_fan_percent"), detection=True), tmp_path / "mine"
    )
    browser = serving(tmp_path, study=study)
    page = opened(browser, "#/study", address=browser.server.people_address)
    for has_recogniser in (False, True):
        if has_recogniser:
            page.context.add_init_script(HEARS)
        page.reload()
        if not has_recogniser:
            page.evaluate("delete window.webkitSpeechRecognition; delete window.SpeechRecognition")
            page.get_by_label("Your code name").select_option("fox")
            page.get_by_role("button", name="Take part").click()
            page.get_by_role("button", name="Begin the next episode").click()
        expect(page.locator(".said")).to_contain_text("Warm my hands.")
        expect(page.get_by_role("button", name="Speak")).to_have_count(int(has_recogniser))
    page.get_by_role("button", name="Speak").click()
    expect(page.get_by_label("Say to the driver, ask, or look up")).to_have_value("a bit warmer")
    expect(page.get_by_text("some browsers send the sound to their maker")).to_be_visible()
    page.locator(".dot").wait_for()
    page.wait_for_timeout(150)
    page.keyboard.press("Control")
    until(page, lambda: study.seen()["fox"]["task"]["hits"] == 1)
    until(page, lambda: study.seen()["fox"]["task"]["stimuli"] > 1)
    owner = opened(browser, "#/study")
    expect(owner.locator("tbody")).to_contain_text(re.compile(r"foxtask1 of \d+\d{3} ms"))


def test_a_drive_is_replayed_with_its_events_on_the_slider(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    write_drive(tmp_path / "drive")
    page = opened(serving(tmp_path))
    expect(page.locator(".pill")).to_have_text("Score 50")
    page.get_by_role("link", name="grid_june").click()
    expect(page.locator(".pill")).to_have_text("Score 50 · 1 of 2 events met")
    expect(page.locator(".marks .span")).to_have_count(3)
    page.get_by_role("button", name="limit: limit").click()
    expect(page.locator(".clock")).to_have_text("+1 s")
    page.get_by_role("button", name="deadline of limit").click()
    expect(page.locator(".clock")).to_have_text("+5 s")
    expect(page.locator(".ghost")).to_be_visible()
    expect(page.locator(".screen")).to_have_attribute("src", re.compile(r"/pictures/1$"))
    expect(page.get_by_role("heading", name="Step 2")).to_be_visible()


def test_the_ways_of_a_decision_are_on_one_road(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    write_study(tmp_path / "reroute")
    page = opened(serving(tmp_path))
    page.get_by_role("link", name="reroute").click()
    expect(page.locator("tbody tr")).to_have_count(2)
    page.get_by_label("Which decisions").select_option("worse")
    expect(page.locator("tbody tr")).to_have_count(0)
    page.get_by_label("Which decisions").select_option("better")
    page.locator("tbody a").nth(1).click()
    expect(page.get_by_role("heading", level=1)).to_have_text("avenue at 950 s")
    expect(page.get_by_text("Traffic news: 100 s on the current route")).to_be_visible()
    expect(page.locator(".way")).to_have_count(2)
    assert page.locator(".street").count() > 20
    page.get_by_label("Seconds since the decision").fill("12")
    expect(page.get_by_role("status")).to_have_text("+12 s · alternative 1: arrives after 10 s")
    expect(page.locator(".car")).to_have_count(2)
    expect(page.locator("tbody tr").nth(1)).to_contain_text("alternative 1+30 s")
    expect(page.locator("tbody tr").nth(1)).to_contain_text("−4 s1always")
    page.go_back()
    page.locator("tbody a").first.click()
    expect(page.get_by_text("before routes were recorded")).to_be_visible()


def test_a_running_study_is_watched_drive_after_drive(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    study = write_study(tmp_path / "reroute")
    first = write_live_drive(study, "first")
    with ExitStack() as stack:
        for path in (study / "lock", first / "road.jsonl.gz"):
            mark_as_written(stack.enter_context(path.open("ab")))
        page = opened(serving(tmp_path))
        page.get_by_role("link", name="Watch live").click()
        expect(page.get_by_role("heading", level=1)).to_have_text("avenue")
        expect(page.locator(".about")).to_contain_text("1 other vehicle in sight")
        page.get_by_role("button", name="decision 1: 70 s of delay ahead").click()
        expect(page.get_by_text("alternative 1: always")).to_be_visible()
        expect(page.locator(".thought")).to_have_text(HOSTILE)
        assert is_being_written(study / "live" / "watched")
        page.get_by_label("Time in the drive").press("End")
        stack.close()
        with (study / "lock").open("ab") as lock:
            mark_as_written(lock)
            with (write_live_drive(study, "second") / "road.jsonl.gz").open("ab") as second:
                mark_as_written(second)
                expect(page.get_by_text("Showing drive second")).to_be_visible()
    expect(page.get_by_text("The study is not running.")).to_be_visible()
    page.get_by_role("link", name="See its decisions").click()
    expect(page.locator("tbody tr")).to_have_count(2)


def test_the_cars_of_a_fleet_are_on_one_map_and_each_opens(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    write_adoption(tmp_path / "town")
    browser = serving(tmp_path)
    page = opened(browser, f"#/fleet/{browser('/api/runs').json['records'][0]['id']}")
    expect(page.locator(".about")).to_contain_text("2 cars on the road")
    expect(page.locator("tbody tr")).to_have_count(2)
    expect(page.locator("tbody tr").first).to_contain_text(HOSTILE)
    expect(page.locator("tbody td.no")).to_have_text("ValueError: boom")
    page.get_by_role("link", name="ego").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("ego")
    expect(page.locator(".about")).to_contain_text("72 km/h")
    expect(page.locator(".events li")).to_have_count(1)
    expect(page.locator(".events")).to_contain_text("another way, which the driver takes")


def test_a_task_shows_its_reference_solution_as_pictures(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    write_record(tmp_path / "run")
    write_record(tmp_path / "lost", success=False, half="second")
    page = opened(serving(tmp_path), "#/tasks/road_speed_80_in_50")
    expect(page.locator(".film li")).to_have_count(4)
    expect(page.locator(".film li").nth(1)).to_contain_text("1  taps “Warn driver”")
    assert page.locator(".film img").first.evaluate("image => image.decode().then(() => image.naturalWidth)") == 320
    expect(page.get_by_text("--half second --agent oracle")).to_be_visible()
    page.get_by_role("link", name="See it on the road").click()
    expect(page.locator(".pill")).to_have_text("Success")


def test_a_person_and_an_agent_are_compared_down_to_a_step(
    serving: Serving, opened: Callable[..., Any], tmp_path: Path
) -> None:
    write_evaluation(tmp_path / "mine")
    write_evaluation(tmp_path / "yours", won=(False, True), agent="human", model="heron")
    page = opened(serving(tmp_path))
    page.get_by_role("link", name="mine").click()
    page.get_by_label("Compare with").select_option(label="yours")
    expect(page.get_by_role("heading", level=1)).to_have_text("mine and yours")
    expect(page.locator("thead")).to_contain_text("yours: human, heron")
    expect(page.get_by_role("status")).to_contain_text("only the first 1, only the second 1")
    page.get_by_label("Which episodes").select_option("worse")
    expect(page.locator("tbody tr")).to_have_count(1)
    expect(page).to_have_url(re.compile("show=worse"))
    page.get_by_role("link", name="step by step").click()
    expect(page.locator(".pill")).to_have_text(["Success", "Success"])
    page.get_by_role("button", name="Step ›").click()
    page.get_by_role("button", name="Step ›").click()
    expect(page.locator(".clock")).to_have_text("+4 s")
    expect(page.locator(".steps [aria-current]")).to_have_count(2)
    page.reload()
    expect(page.locator(".clock")).to_have_text("+4 s")


def test_every_page_fits_in_light_and_dark(serving: Serving, opened: Callable[..., Any], tmp_path: Path) -> None:
    write_record(tmp_path / "run", goal="x" * 300)
    write_evaluation(tmp_path / "mine")
    write_drive(tmp_path / "drive")
    write_study(tmp_path / "reroute")
    write_adoption(tmp_path / "town")
    study = PeopleStudy(PeoplePlan(("heron",), ("hvac_fan_max",)), tmp_path / "study")
    browser = serving(tmp_path, game=Game(tmp_path), study=study)
    records = [each for each in browser("/api/runs").json["records"] if each["name"] != "study"]
    run, mine, drive, reroute, town = (
        next(each["id"] for each in records if each["name"] == name)
        for name in ("run", "mine", "drive", "reroute", "town")
    )
    pages = (
        "#/",
        f"#/run/{run}",
        f"#/run/{drive}",
        f"#/results/{mine}",
        f"#/compare/{mine}/{mine}",
        f"#/beside/{mine}/one/{mine}/one",
        f"#/decisions/{reroute}",
        f"#/live/{reroute}",
        f"#/fleet/{town}",
        f"#/fleet/{town}/seed1-100/ego",
        f"#/decision/{reroute}/share0.6-seed0-at0-avenue-1",
        "#/tasks",
        "#/tasks/road_horn_abroad",
        "#/scenarios",
        "#/play",
        "#/study",
        "#/no",
    )
    for width, scheme in ((1400, "light"), (820, "dark"), (360, "light")):
        page = opened(browser, viewport={"width": width, "height": 900}, color_scheme=scheme)
        for name in pages:
            page.goto(f"http://127.0.0.1:{browser.server.server_port}/{name}")
            expect(page.get_by_role("heading", level=1)).to_have_count(1)
            expect(page.get_by_text("Loading …")).to_have_count(0)
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), f"{name} at {width}"
            unnamed = page.evaluate(
                "[...document.querySelectorAll('button, a, input, select, canvas, img')].filter((each) => "
                "!each.textContent.trim() && !each.getAttribute('aria-label') && each.getAttribute('alt') === null "
                "&& !each.querySelector('img[alt]') && !each.closest('label')?.textContent.trim())"
                ".length"
            )
            assert unnamed == 0, f"something on {name} has no name for a screen reader"
