"""A picture of each page, for the documentation.

    python -m tests.serve.pictures                                    # renews docs/images
    python -m tests.serve.pictures --to /tmp/look --size 1024x768 --dark --touch   # another screen, to look at
    python -m tests.serve.pictures --only task,results

Records what the pages show first, into ``runs/pictures`` or another folder, unless it is there: some minutes.
"""

from __future__ import annotations

import argparse
import io
import json
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

from automotive_cosim.serve.dealing import PeoplePlan
from automotive_cosim.serve.play import Game
from automotive_cosim.serve.server import WebServer
from automotive_cosim.serve.study import PeopleStudy

IMAGES = Path(__file__).parents[2] / "docs" / "images"
QUALITY = 72
PATIENCE_MS = 240_000
TASK = "road_speed_80_in_50"
RECORDS = {
    "agents": f"eval --agents oracle,asurada --tasks {TASK},hvac_cold_hands,hvac_fan_max,media_forever --seeds 0"
    " --pictures all --workers 1",
    "drive": "drive grid_june",
}
STUDY = "study reroute --seeds 0 --departures 0 --trips centre,tunnel --trajectories --workers 1"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.serve.pictures", description=__doc__.splitlines()[0])
    parser.add_argument("--records", type=Path, default=Path("runs/pictures"), help="folder of what is shown")
    parser.add_argument("--to", type=Path, default=IMAGES, help="folder of the pictures")
    parser.add_argument("--size", default="1280x900", help="of the browser's window")
    parser.add_argument("--dark", action="store_true", help="in dark colours")
    parser.add_argument("--touch", action="store_true", help="as on a tablet")
    parser.add_argument("--only", default="", help="names, separated by commas")
    asked = parser.parse_args()
    asked.to.mkdir(parents=True, exist_ok=True)
    asked.records.mkdir(parents=True, exist_ok=True)
    for name, words in RECORDS.items():
        if not (asked.records / name).exists():
            command(*words.split(), "--out", asked.records / name).wait()
    wide, high = map(int, asked.size.split("x"))
    options = {
        "viewport": {"width": wide, "height": high},
        "color_scheme": "dark" if asked.dark else "light",
        "has_touch": asked.touch,
    }
    wanted = set(filter(None, asked.only.split(",")))
    with pages(asked.records, options) as (open_, server):
        for name, take in PICTURES.items():
            if not wanted or name in wanted:
                print(name, flush=True)
                take(lambda page, name=name: keep(page, asked.to / f"{name}.webp"), open_, server, asked.records)


def command(*words: object) -> subprocess.Popen[bytes]:
    """Starts ``automotive-cosim``."""
    return subprocess.Popen([sys.executable, "-c", START, *map(str, words)])


START = "from automotive_cosim_main import main; main()"


def keep(page: Any, path: Path) -> None:
    """What the window shows, once its pictures are there."""
    page.wait_for_timeout(700)
    Image.open(io.BytesIO(page.screenshot())).convert("RGB").save(path, quality=QUALITY, method=6)


Opened = Callable[..., Any]
Keep = Callable[[Any], None]


@contextmanager
def pages(records: Path, options: dict[str, Any]) -> Iterator[tuple[Opened, WebServer]]:
    """A server, and what opens a page of it."""
    played = Path(tempfile.mkdtemp())
    people = PeoplePlan(("heron", "fox", "owl", "otter"), ("hvac_fan_max", "hvac_fan_percent"), scenario="grid")
    study = PeopleStudy(people, played / "summer")
    server = WebServer([records, played], game=Game(played, scenario="grid"), study=study)
    threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True).start()
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])

            def open_(page: str, address: str = "") -> Any:
                tab = browser.new_context(**options).new_page()
                tab.set_default_timeout(PATIENCE_MS)
                tab.goto(address or server.address)
                tab.goto(f"http://127.0.0.1:{server.server_port}/{page}")
                tab.get_by_role("heading", level=1).wait_for()
                return tab

            yield open_, server
            browser.close()
    finally:
        server.shutdown()
        server.server_close()
        shutil.rmtree(played, ignore_errors=True)


def record(open_: Opened, name: str) -> str:
    """The id of a record."""
    tab = open_("#/")
    records = tab.evaluate("fetch('/api/runs').then((answer) => answer.json())")["records"]
    tab.context.close()
    return str(next(each["id"] for each in records if each["name"] == name))


def episode(records: Path, agent: str, task: str = TASK, half: str = "first") -> str:
    """The id of an episode of the evaluation."""
    rows = map(json.loads, (records / "agents" / "episodes.jsonl").read_text(encoding="utf-8").splitlines())
    return next(row["id"] for row in rows if (row["agent"], row["task"], row["half"]) == (agent, task, half))


# --- the pictures ---------------------------------------------------------------------------------------------


def replay(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    kept(open_(f"#/run/{record(open_, 'agents')}/{episode(records, 'oracle')}?at=2"))


def beside(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    run = record(open_, "agents")
    kept(open_(f"#/beside/{run}/{episode(records, 'oracle')}/{run}/{episode(records, 'asurada')}?at=3"))


def drive(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    kept(open_(f"#/run/{record(open_, 'drive')}?at=200"))


def task(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    kept(open_(f"#/tasks/{TASK}"))


def results(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    kept(open_(f"#/results/{record(open_, 'agents')}"))


def compare(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    run = record(open_, "agents")
    kept(open_(f"#/compare/{run}/{run}"))


def scenarios(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    kept(open_("#/scenarios"))


def runs(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    kept(open_("#/"))


def live(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    """A study while it runs; begun here, unless it is there already."""
    if (records / "study").exists():
        return
    running = command(*STUDY.split(), "--out", records / "study")
    while not (records / "study" / "live" / "watched").exists():
        threading.Event().wait(0.5)
    page = open_(f"#/live/{record(open_, 'study')}")
    page.get_by_role("button", name="saves").first.wait_for()
    page.get_by_role("button", name="decision 1:").click()
    kept(page)
    page.context.close()
    running.wait()


def decisions(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    kept(open_(f"#/decisions/{record(open_, 'study')}"))


def decision(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    page = open_(f"#/decisions/{record(open_, 'study')}?show=better")
    page.locator("tbody a").first.click()
    slider = page.get_by_label("Seconds since the decision")
    slider.fill("420")
    kept(page)


def play(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    page = open_("#/play?task=hvac_fan_max")
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="Begin").click()
    page.locator(".said").wait_for()
    page.get_by_role("button", name="Climate", exact=True).first.focus()
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Max: Fan at full speed").wait_for(state="attached")
    page.evaluate("document.activeElement.blur()")
    page.wait_for_timeout(1500)
    kept(page)
    page.get_by_role("button", name="Leave").click()
    page.get_by_text("The episode is over").wait_for()


def people(kept: Keep, open_: Opened, server: WebServer, records: Path) -> None:
    page = open_("#/study", server.people_address)
    page.get_by_label("Your code name").select_option("heron")
    page.get_by_role("button", name="Take part").click()
    page.get_by_role("button", name="Begin the next episode").click()
    page.locator(".said").wait_for()
    page.get_by_role("button", name="Not needed").click()
    page.get_by_text("About what you just did").wait_for()
    for box in page.locator("fieldset").all()[:2]:
        box.get_by_label("mostly").check()
    kept(page)


PICTURES = {
    each.__name__: each
    for each in (
        runs,
        replay,
        beside,
        drive,
        task,
        results,
        compare,
        scenarios,
        live,
        decisions,
        decision,
        play,
        people,
    )
}

if __name__ == "__main__":
    main()
