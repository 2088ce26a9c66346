"""The film of two episodes tells the whole reason why one failed."""

from types import SimpleNamespace
from typing import Any, cast

import pytest
from PIL import Image

from automotive_cosim.cockpit.drawing import Canvas, fit
from automotive_cosim.cockpit.theme import Type
from automotive_cosim.report import pair


@pytest.mark.parametrize("count", [1, 14])
def test_a_long_reason_takes_the_place_of_the_view(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    words = "clean: also changed: " + ", ".join(f"seat heating {each} is on, was off" for each in range(count))
    drawn: list[tuple[str, bool]] = []

    def text(canvas: Canvas, box: Any, words: str, style: Type, *_: Any, lines: int = 1) -> None:
        drawn.append((words, fit(words, style, box.width, lines, box.height)[2]))

    monkeypatch.setattr(Canvas, "text", text)
    canvas = Canvas.plain(960, 894, pair.SCALE, (0, 0, 0))
    side = SimpleNamespace(row=SimpleNamespace(success=False, end="declared"), title="without place")
    view, cockpit = Image.new("RGB", (400, 200), (0, 255, 0)), Image.new("RGB", pair.screen_size())
    frame = SimpleNamespace(title="Not solved", words=words, view=view, cockpit=cockpit)
    here = SimpleNamespace(speed_kmh=50.0, speed_unit="km/h")
    told = cast("tuple[Any, Any, Any]", (side, frame, here))
    pair._draw_side(canvas, pair.SIDES[0], *told, pair.COLOURS[0])
    assert (words, False) in drawn
    colours = canvas.image.getcolors(1 << 20) or ()
    assert any(colour == (0, 255, 0) for _, colour in colours) is (count == 1)
