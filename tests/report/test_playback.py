"""A record played back."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image

from automotive_cosim.errors import UserError
from automotive_cosim.report.playback import frames, write_film

ACTIONS = (None, {"action_type": "click", "index": 7}, {"action_type": "wait"})


@pytest.fixture
def record_of_three(tmp_path: Path) -> Path:
    (tmp_path / "screenshots").mkdir()
    lines = []
    for number, action in enumerate(ACTIONS):
        Image.new("RGB", (64, 36), (80 * number, 0, 0)).save(tmp_path / "screenshots" / f"step_{number:03d}.jpg")
        step = {
            "step": number,
            "at_s": 2.0 * number,
            "words": "",
            "speed_kmh": 36.0,
            "picture": number,
            "action": action,
            "feedback": {"code": "ok", "text": "done"},
        }
        lines.append(json.dumps(step))
    (tmp_path / "steps.jsonl").write_text("\n".join(lines) + '\n{"step": 3, "ti', encoding="utf-8")
    return tmp_path


def test_steps_are_told_in_their_order_and_a_cut_line_ends_them(record_of_three: Path) -> None:
    shown = list(frames(record_of_three))
    assert [frame.since_s for frame in shown] == [0.0, 2.0, 4.0]
    assert "hand-over" in shown[0].words
    assert "click index 7: done" in shown[1].words
    assert "36 km/h" in shown[2].words


def test_the_film_has_a_picture_a_step_for_as_long_as_it_stood(record_of_three: Path) -> None:
    film = record_of_three / "film.webp"
    write_film(list(frames(record_of_three)), film, speed=2.0)
    with Image.open(film) as played:
        assert played.n_frames == 3
        stood = []
        for number in range(3):
            played.seek(number)
            played.load()
            stood.append(played.info["duration"])
    assert stood[:2] == [1000, 1000]


def test_what_is_no_record_is_refused(tmp_path: Path, record_of_three: Path) -> None:
    with pytest.raises(UserError, match="has no steps"):
        list(frames(tmp_path / "nowhere"))
    (record_of_three / "screenshots" / "step_001.jpg").unlink()
    with pytest.raises(UserError, match="is missing"):
        write_film(list(frames(record_of_three)), record_of_three / "film.webp", 1.0)
