"""A picture of each page, for the documentation.

    python -m tests.serve.pictures                                    # renews docs/images
    python -m tests.serve.pictures --to /tmp/look --size 1024x768 --dark --touch   # another screen, to look at
    python -m tests.serve.pictures --only task,results

Records what the pages show first, into ``runs/pictures`` or another folder, unless it is there: some minutes.
"""

import argparse
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PIL import Image, ImageSequence
from playwright.sync_api import sync_playwright

from automotive_cosim.report.frames import STEP_MS
from automotive_cosim.serve.dealing import PeoplePlan
from automotive_cosim.serve.play import Game
from automotive_cosim.serve.server import WebServer
from automotive_cosim.serve.study import PeopleStudy

IMAGES = Path(__file__).parents[2] / "docs" / "images"
QUALITY = 72
PATIENCE_MS = 240_000
SETTLED_MS = 700
"""After which pictures within a page are there."""
TASK = "road_speed_80_in_50"
RECORDS = {
    "agents": f"eval --agents oracle,asurada --tasks {TASK},hvac_cold_hands,hvac_fan_max,media_forever --seeds 0"
    " --pictures all --workers 1",
    "drive": "drive grid_june",
    "run": "run",
}
STUDY = "study reroute --seeds 0 --departures 0 --trips centre,tunnel --trajectories --workers 1"
START = "from automotive_cosim_main import main; main()"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.serve.pictures", description="A picture of each page.")
    parser.add_argument("--records", type=Path, default=Path("runs/pictures"), help="folder of what is shown")
    parser.add_argument("--to", type=Path, default=IMAGES, help="folder of the pictures")
    parser.add_argument("--size", default="1280x900", help="of the browser's window")
    parser.add_argument("--dark", action="store_true", help="in dark colours")
    parser.add_argument("--touch", action="store_true", help="as on a tablet")
    parser.add_argument("--only", default="", help="names, separated by commas")
    asked = parser.parse_args()
    for folder in (asked.to, asked.records):
        folder.mkdir(parents=True, exist_ok=True)
    for name, words in RECORDS.items():
        if not (asked.records / name).exists():
            begin(*words.split(), "--out", asked.records / name).wait()
    wide, high = map(int, asked.size.split("x"))
    colours = "dark" if asked.dark else "light"
    window = {"viewport": {"width": wide, "height": high}, "color_scheme": colours, "has_touch": asked.touch}
    kept = [name for name in PICTURES if asked.to != IMAGES or (IMAGES / f"{name}.webp").exists()]
    wanted = asked.only.split(",") if asked.only else kept
    with opened(asked.records, window) as studio:
        for name in wanted:
            shown = PICTURES[name](studio)
            if shown is not None:
                image = shown if isinstance(shown, Image.Image) else taken(shown)
                image.convert("RGB").save(asked.to / f"{name}.webp", quality=QUALITY, method=6)
            print(name, flush=True)


def taken(page: Any) -> Image.Image:
    """A picture of a page, which is then closed."""
    page.wait_for_timeout(SETTLED_MS)
    image = Image.open(io.BytesIO(page.screenshot()))
    page.context.close()
    return image


def begin(*words: object) -> subprocess.Popen[bytes]:
    """Starts ``automotive-cosim``."""
    return subprocess.Popen([sys.executable, "-c", START, *map(str, words)])


@dataclass
class _Studio:
    """A server that shows records, and a browser."""

    server: WebServer
    browser: Any
    window: dict[str, Any]
    records: Path
    running: subprocess.Popen[bytes] | None = None
    """The study, while it runs."""

    def open(self, page: str, address: str = "") -> Any:
        """A page in a window of its own."""
        tab = self.browser.new_context(**self.window).new_page()
        tab.set_default_timeout(PATIENCE_MS)
        tab.goto(address or self.server.address)
        tab.goto(f"http://127.0.0.1:{self.server.server_port}/{page}")
        tab.get_by_role("heading", level=1).wait_for()
        return tab

    def record(self, name: str) -> str:
        """The id of a record."""
        tab = self.open("#/")
        records = tab.evaluate("fetch('/api/runs').then((answer) => answer.json())")["records"]
        tab.context.close()
        return str(next(each["id"] for each in records if each["name"] == name))

    def study(self) -> str:
        """The id of the study, once it is over."""
        if not (self.records / "study").exists():
            self.running = begin(*STUDY.split(), "--out", self.records / "study")
        if self.running is not None:
            self.running.wait()
        return self.record("study")

    def episode(self, agent: str) -> str:
        """Where an agent's episode is among the runs."""
        text = (self.records / "agents" / "episodes.jsonl").read_text(encoding="utf-8")
        rows = map(json.loads, text.splitlines())
        wanted = agent, TASK, "first"
        name = next(row["id"] for row in rows if (row["agent"], row["task"], row["half"]) == wanted)
        return f"{self.record('agents')}/{name}"


@contextmanager
def opened(records: Path, window: dict[str, Any]) -> Iterator[_Studio]:
    """A studio, in which people can play."""
    played = Path(tempfile.mkdtemp())
    people = PeoplePlan(("heron", "fox", "owl", "otter"), ("hvac_fan_max", "hvac_fan_percent"), scenario="grid")
    game, study = Game(played, scenario="grid"), PeopleStudy(people, played / "summer")
    server = WebServer([records, played], game=game, study=study)
    threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True).start()
    is_root = hasattr(os, "geteuid") and os.geteuid() == 0
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(
                executable_path=shutil.which("chromium"), args=["--no-sandbox"] if is_root else []
            )
            yield _Studio(server, browser, window, records)
            browser.close()
    finally:
        server.shutdown()
        server.server_close()
        shutil.rmtree(played, ignore_errors=True)


def live(studio: _Studio) -> Any:
    """A study while it runs; begun here, unless it is there already."""
    if (studio.records / "study").exists():
        return None
    studio.running = begin(*STUDY.split(), "--out", studio.records / "study")
    while not (studio.records / "study" / "live" / "watched").exists():
        time.sleep(0.5)
    page = studio.open(f"#/live/{studio.record('study')}")
    page.get_by_role("button", name="saves").first.wait_for()
    page.get_by_role("button", name="decision 1:").click()
    return page


def decision(studio: _Studio) -> Any:
    page = studio.open(f"#/decisions/{studio.study()}?show=better")
    page.locator("tbody a").first.click()
    page.get_by_label("Seconds since the decision").fill("420")
    return page


def play(studio: _Studio) -> Any:
    page = studio.open("#/play?task=hvac_fan_max")
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="Begin").click()
    page.locator(".said").wait_for()
    page.get_by_role("button", name="Climate", exact=True).first.focus()
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Max: Fan at full speed").wait_for(state="attached")
    page.evaluate("document.activeElement.blur()")
    page.wait_for_timeout(1500)
    return page


def people(studio: _Studio) -> Any:
    page = studio.open("#/study", studio.server.people_address)
    page.get_by_label("Your code name").select_option("heron")
    page.get_by_role("button", name="Take part").click()
    page.get_by_role("button", name="Begin the next episode").click()
    page.get_by_role("button", name="Not needed").click()
    page.get_by_text("About what you just did").wait_for()
    for box in page.locator("fieldset").all()[:2]:
        box.get_by_label("mostly").check()
    return page


def episode(studio: _Studio) -> Image.Image:
    """The main job's film when the driver has just been warned: three actions after the hand-over."""
    film = Image.open(studio.records / "run" / "episode.webp")
    shown_ms = []
    for frame in ImageSequence.Iterator(film):
        frame.load()
        shown_ms.append(frame.info["duration"])
    film.seek(shown_ms.index(STEP_MS) + 3)
    return film


def compare(studio: _Studio) -> Any:
    run = studio.record("agents")
    return studio.open(f"#/compare/{run}/{run}")


PICTURES: dict[str, Callable[[_Studio], Any]] = {
    "main_job": episode,
    "runs": lambda studio: studio.open("#/"),
    "replay": lambda studio: studio.open(f"#/run/{studio.episode('oracle')}?at=2"),
    "beside": lambda studio: studio.open(f"#/beside/{studio.episode('oracle')}/{studio.episode('asurada')}?at=3"),
    "drive": lambda studio: studio.open(f"#/run/{studio.record('drive')}?at=200"),
    "results": lambda studio: studio.open(f"#/results/{studio.record('agents')}"),
    "compare": compare,
    "task": lambda studio: studio.open(f"#/tasks/{TASK}"),
    "scenarios": lambda studio: studio.open("#/scenarios"),
    "live": live,
    "decisions": lambda studio: studio.open(f"#/decisions/{studio.study()}"),
    "decision": decision,
    "play": play,
    "people": people,
}

if __name__ == "__main__":
    main()
