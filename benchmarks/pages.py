"""The speed of the pages in headless Chromium, which draws without a graphics card.

    pip install 'automotive-cosim[browser]'       # and the system's chromium
    python benchmarks/pages.py [TAPS]

Prints the frames per second of an empty page and of a replay with 400 vehicles and 3,000 lanes, near and far,
how long a whole frame of the cockpit (1280 x 720) takes from the request until it can be drawn, and how long a tap
takes from the finger's rise until a frame shows what it did, over TAPS taps (60) on a running episode.
"""

from __future__ import annotations

import gzip
import json
import math
import os
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright

LANES, VEHICLES, SECONDS = 3000, 400, 40
COUNT_MS = 5000
FRAMES = """(span) => new Promise((done) => {
  let [count, begun] = [0, null];
  const next = (now) => {
    begun ??= now;
    if (now - begun < span) { count += 1; requestAnimationFrame(next); } else done(1000 * count / (now - begun));
  };
  requestAnimationFrame(next);
})"""
SCREEN = """async () => {
  const begun = performance.now();
  const answer = await fetch(`/api/play/screen?seen=${Math.random()}`);
  await createImageBitmap(await answer.blob());
  return performance.now() - begun;
}"""
TAP = """async ([across, down, wait]) => {
  const [screen, frame] = [".screen", ".frame"].map((each) => document.querySelector(each));
  const small = Object.assign(document.createElement("canvas"), { width: 64, height: 36 });
  const context = small.getContext("2d", { willReadFrequently: true });
  const seen = () => { context.drawImage(screen, 0, 0, 64, 36); return context.getImageData(0, 0, 64, 36).data; };
  await new Promise((done) => setTimeout(done, wait));
  const before = seen();
  const box = screen.getBoundingClientRect();
  const at = { clientX: box.left + across * box.width, clientY: box.top + down * box.height, pointerId: 1 };
  frame.setPointerCapture = () => {};
  frame.dispatchEvent(new PointerEvent("pointerdown", { ...at, bubbles: true }));
  const begun = performance.now();
  frame.dispatchEvent(new PointerEvent("pointerup", { ...at, bubbles: true }));
  return await new Promise((done) => {
    const look = () => {
      const change = seen().reduce((sum, value, index) => sum + Math.abs(value - before[index]), 0);
      if (change / before.length > 3) { screen.removeEventListener("load", look); done(performance.now() - begun); }
    };
    screen.addEventListener("load", look);
    setTimeout(() => { screen.removeEventListener("load", look); done(null); }, 3000);
  });
}"""


def main() -> None:
    taps = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    print(f"{os.cpu_count()} cores, load average {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as name, sync_playwright() as driver:
        folder = Path(name)
        write_record(folder / "run")
        is_root = hasattr(os, "geteuid") and os.geteuid() == 0
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"] if is_root else []
        )
        with served(folder) as address:
            page = browser.new_page(viewport={"width": 1280, "height": 900})
            page.set_default_timeout(200_000)
            drawing(page, address)
            acting(page, address, taps)
        browser.close()
    print(f"load average {os.getloadavg()[0]:.1f}")


def drawing(page: Any, address: str) -> None:
    """Frames per second."""
    page.goto("about:blank")
    print(f"frames per second: empty page {page.evaluate(FRAMES, COUNT_MS):.0f}", end="")
    page.goto(address)
    page.get_by_role("link", name="crowd").click()
    page.get_by_role("button", name="Play", exact=True).click()
    print(f", replay {page.evaluate(FRAMES, COUNT_MS):.0f}", end="")
    page.get_by_role("button", name="All roads").click()
    print(f", all roads at once {page.evaluate(FRAMES, COUNT_MS):.0f}")


def acting(page: Any, address: str, taps: int) -> None:
    """A frame of the cockpit, and taps that change it."""
    page.goto(f"{address.partition('?')[0]}#/play?task=hvac_fan_max")
    draws = random.Random(0)
    took_ms, frames_ms = list[float](), list[float]()
    while len(took_ms) < taps:
        page.reload()
        page.get_by_label("Your code name").fill("bench")
        page.get_by_role("button", name="Begin").click()
        page.locator(".said").wait_for()
        if not frames_ms:
            frames_ms = [page.evaluate(SCREEN) for _ in range(30)]
        frame = page.locator(".frame").bounding_box()
        places = []
        for name in ("Climate", "Home"):
            box = page.locator(".elements").get_by_role("button", name=name, exact=True).first.bounding_box()
            places.append(
                (
                    (box["x"] + box["width"] / 2 - frame["x"]) / frame["width"],
                    (box["y"] + box["height"] / 2 - frame["y"]) / frame["height"],
                )
            )
        for number in range(min(60, taps - len(took_ms))):  # an episode ends after two minutes
            took_ms.append(page.evaluate(TAP, [*places[number % 2], draws.uniform(600, 1700)]) or 3000.0)
        page.get_by_role("button", name="Leave").click()
        page.get_by_text("The episode is over").wait_for()
    print(f"a frame of the cockpit: {told(frames_ms)}")
    print(f"a tap: {told(took_ms)}, over 100 ms {sum(each > 100 for each in took_ms)} of {len(took_ms)}")


def told(values_ms: Sequence[float]) -> str:
    """Median and 95th percentile."""
    return f"median {statistics.median(values_ms):.0f} ms, p95 {statistics.quantiles(values_ms, n=20)[-1]:.0f} ms"


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """The address of a server in a separate process."""
    words = [sys.executable, "-c", "from automotive_cosim_main import main; main()", "serve", str(folder), "--play"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        assert process.stdout is not None
        try:
            yield next(line.split()[-1] for line in process.stdout if "http://" in line)
        finally:
            process.terminate()


def write_record(folder: Path) -> None:
    """A recorded episode on a crowded road."""
    draws = random.Random(0)
    lanes = []
    for _ in range(LANES):
        x, y, turn = draws.uniform(-1500, 1500), draws.uniform(-1500, 1500), draws.uniform(0, math.tau)
        line = [
            round(part, 1)
            for piece in range(5)
            for part in (
                x + 25 * piece * math.cos(turn + piece / 20),
                y + 25 * piece * math.sin(turn + piece / 20),
            )
        ]
        lanes.append(["road", 3.2, line, [["light", 0]]])
    about = {"task": "crowd", "scenario": "drawn", "agent": "nobody", "model": "none", "seed": 0, "goal": ""}
    names = ["ego", *(f"v{number}" for number in range(1, VEHICLES + 1))]
    places = [(draws.uniform(-400, 400), draws.uniform(-400, 400), draws.uniform(0, 360)) for _ in names]
    lines: list[dict[str, Any]] = [
        {"format": 1, "radius_m": 800, "left_hand": False, "has_place": True, **about},
        {"lanes": lanes, "junctions": []},
        {"vehicles": [[number, name, "passenger", 5, 1.8] for number, name in enumerate(names)]},
    ]
    for second in range(SECONDS):
        seen = [
            [
                number,
                round(x + 10 * second * math.sin(math.radians(heading)), 2),
                round(y + 10 * second * math.cos(math.radians(heading)), 2),
                round(heading, 1),
                10,
                8,
            ]
            for number, (x, y, heading) in enumerate(places)
        ]
        told_ = {"speed_kmh": 36, "limit_kmh": 50, "road": "Street", "local_time": "2026-11-17T08:16:00+01:00"}
        sky = {"sun_deg": 20.0, "weather_code": 0, "incidents": [], "events": []}
        lines.append({"at_s": float(second), "seen": seen, "lights": {"light": "r"}, **told_, **sky})
    folder.mkdir()
    (folder / "steps.jsonl").touch()
    (folder / "road.jsonl.gz").write_bytes(
        gzip.compress("".join(json.dumps(each) + "\n" for each in lines).encode())
    )


if __name__ == "__main__":
    main()
