"""The film of an episode shows its drive, whatever came before."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from PIL import Image

from automotive_cosim.cockpit.drawing import Canvas, fit
from automotive_cosim.cockpit.theme import Type
from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.report import film, frames
from automotive_cosim.report.film import Film
from automotive_cosim.run.timeline import Sample

SCREEN = np.zeros((48, 80, 3), np.uint8)
NETWORK = RoadNetwork((), (0.0, 0.0, 1.0, 1.0), None, (0.0, 0.0), False)


def _film(
    folder: Path, moments_s: list[float], path_s: list[float], monkeypatch: pytest.MonkeyPatch
) -> list[float]:
    """Times of the frames of a film that was handed over at 100 s."""
    shown: list[float] = []

    def compose(self: Film, frame: frames.FilmFrame, path: Any, painter: Any) -> Image.Image:
        assert [sample for sample in path if sample.at_s <= frame.at_s + frames.SAME_TIME_S]
        shown.append(100.0 + frame.at_s)
        return Image.new("RGB", (8, 8))

    monkeypatch.setattr(Film, "_compose", compose)
    monkeypatch.setattr(frames, "outcome", lambda row: "")
    monkeypatch.setattr(frames, "why", lambda row, result: "")
    filmed = Film(folder)
    cockpit = cast("Any", SimpleNamespace(screenshot=lambda: SCREEN))
    for time_s in moments_s:
        filmed.moved(cast("Any", SimpleNamespace(time_s=time_s)), cockpit)
    world = SimpleNamespace(view=lambda: np.zeros((360, 640, 3), np.uint8))
    episode = SimpleNamespace(network=NETWORK, instance=SimpleNamespace(goal=""), world=world)
    step = SimpleNamespace(moment=SimpleNamespace(time_s=100.0))
    filmed.begun(cast("Any", episode), cast("Any", SimpleNamespace(step=step, screenshot=SCREEN)))
    path = tuple(Sample(at_s, 50.0, 50.0, "", 0.0, 0.0, 0.0) for at_s in path_s)
    filmed.finished(cast("Any", None), cast("Any", SimpleNamespace(path=path)))
    return shown


def test_frames_of_earlier_departures_are_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown = _film(tmp_path, [40.0, 60.0, 80.0, 97.0], [-3.0, 0.0], monkeypatch)
    assert shown == [97.0, 100.0]
    assert (tmp_path / "episode.webp").is_file()


def test_without_a_drive_there_is_no_film(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert _film(tmp_path, [97.0], [], monkeypatch) == []
    assert not (tmp_path / "episode.webp").exists()


@pytest.mark.parametrize(("milliseconds", "is_whole"), [(frames.LAST_MS, True), (frames.STEP_MS, False)])
def test_the_last_picture_has_a_long_reason_instead_of_the_speed(
    milliseconds: int, is_whole: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[tuple[str, bool]] = []

    def text(canvas: Canvas, box: Any, words: str, style: Type, *_: Any, lines: int = 1) -> None:
        drawn.append((words, fit(words, style, box.width, lines, box.height)[2]))

    monkeypatch.setattr(Canvas, "text", text)
    words = "clean: also changed: " + ", ".join(f"seat heating {each} is on, was off" for each in range(7))
    frame = frames.FilmFrame(3.0, Image.new("RGB", (8, 8)), "Not solved", words, milliseconds)
    film._info(Canvas.plain(960, 540, film.SCALE, (0, 0, 0)), frame, Sample(0.0, 50.0, 50.0, "", 0.0, 0.0, 0.0))
    assert (words, not is_whole) in drawn
    assert ("50" in dict(drawn)) is not is_whole
