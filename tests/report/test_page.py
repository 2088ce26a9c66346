import json
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.report import hearing
from automotive_cosim.report.page import write_page
from automotive_cosim.voice.engines import as_wav

VOID = {"meta", "img", "br", "hr", "link", "input"}


class Tags(HTMLParser):
    """Every opened tag is closed in order; collects tags with their attributes."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[tuple[str, dict[str, str | None]]] = []

    def handle_starttag(self, tag, attrs):
        self.seen.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.seen.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def _tags(page: Path) -> Tags:
    tags = Tags()
    tags.feed(page.read_text(encoding="utf-8"))
    tags.close()
    return tags


def test_the_page_is_well_formed_and_needs_nothing_beside_it(record):
    tags = _tags(write_page(record()))
    assert not tags.open
    for tag, attributes in tags.seen:
        assert tag not in ("script", "iframe")
        for name in ("src", "href"):
            value = attributes.get(name)
            assert value is None or value.startswith("data:"), f"<{tag} {name}={value[:60]}> lies outside the page"


def test_every_step_has_its_picture_and_its_action_in_words(record):
    page = write_page(record())
    pictures = [tag for tag, attributes in _tags(page).seen if tag == "img" and "loading" in attributes]
    text = page.read_text(encoding="utf-8")
    assert len(pictures) == 3
    assert "taps “Warn &lt;driver&gt; &amp; co”" in text
    assert "declares complete" in text


def test_the_page_shows_what_was_true(record, episode):
    text = write_page(record()).read_text(encoding="utf-8")
    told = episode()
    assert told["trace_sha256"] in text
    for entry in told["timeline"]:
        assert entry["text"] in text
    assert "Success" in text
    assert "Not solved" not in text


@pytest.mark.parametrize(("end", "error"), [("interrupted", None), ("error", "the simulation died <here>")])
def test_an_episode_without_verdict_says_so(record, end, error):
    text = write_page(record(success=None, verdict=None, end=end, error=error)).read_text(encoding="utf-8")
    assert f"No verdict: {end}" in text
    assert "Success" not in text
    if error:
        assert "the simulation died &lt;here&gt;" in text


def test_writing_the_page_again_changes_nothing(record):
    folder = record()
    first = write_page(folder).read_bytes()
    assert write_page(folder).read_bytes() == first
    assert not list(folder.glob(".*")), "a draft was left"


def test_text_colours_can_be_read_by_day_and_by_night(record):
    """WCAG 2.2, 1.4.3: 4.5:1, of every text colour on page and card."""
    text = write_page(record()).read_text(encoding="utf-8")
    for palette in re.findall(r":root \{(.*?)\}", text, re.DOTALL):
        colours = {name: _rgb(value) for name, value in re.findall(r"--([\w-]+): (#\w+);", palette)}
        pairs = [(ink, paper) for ink in ("text", "muted", "good", "bad", "accent") for paper in ("page", "card")]
        pairs += [("good", "good-soft"), ("bad", "bad-soft"), ("wait", "wait-soft")]
        for ink, paper in pairs:
            assert _contrast(colours[ink], colours[paper]) >= 4.5, (ink, paper)


def _rgb(code: str) -> tuple[float, ...]:
    digits = code[1:] if len(code) == 7 else "".join(c * 2 for c in code[1:])
    return tuple(int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4))


def _contrast(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    def luminance(rgb: tuple[float, ...]) -> float:
        r, g, b = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb)
        return 0.2126 * r + 0.7152 * g + 0.0722 * b

    lighter, darker = sorted((luminance(one), luminance(other)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


def test_a_trial_that_has_not_ended_has_no_page(record):
    folder = record()
    (folder / "trial.json").write_text('{"manifest": {"setup": {}}}', encoding="utf-8")
    with pytest.raises(UserError, match="has not ended"):
        write_page(folder)


SPOKEN = {0: {"heard": ["Wash my peat."], "cabin_db": 71.5}, 1: {"cabin_db": 64.0}}
SPOKEN |= {
    2: {"said": ["Still too fast?", "Slower."], "heard": ["Steel two fast?", "[inaudible]"], "cabin_db": 83.0}
}
WAV = as_wav(np.linspace(-1, 1, 1600, dtype=np.float32))


def _no_voice(words: str, snr_db: float) -> bytes:
    raise SetupError("piper is not installed")


@pytest.mark.parametrize(
    ("voice", "kept", "audible", "told"),
    [
        (lambda words, snr_db: WAV, WAV, 3, ""),
        (_no_voice, None, 0, "<code>pip install "),
        (_no_voice, WAV, 1, "<code>pip install "),
        (lambda words, snr_db: WAV, b"not a sound", 2, "No sound: step_000_0.wav is no WAV file"),
    ],
)
def test_the_page_plays_what_was_heard_and_says_in_a_line_why_not(record, monkeypatch, voice, kept, audible, told):
    monkeypatch.setattr(hearing, "sounding", voice)
    folder = record()
    assert "In the cabin" not in write_page(folder).read_text(encoding="utf-8")
    lines = [json.loads(line) for line in (folder / "steps.jsonl").read_text(encoding="utf-8").splitlines()]
    lines = [line | SPOKEN[line["step"]] for line in lines]
    (folder / "steps.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    if kept is not None:
        (folder / "sounds").mkdir()
        (folder / "sounds" / "step_000_0.wav").write_bytes(kept)
    tags, text = _tags(page := write_page(folder)), page.read_text(encoding="utf-8")
    players = [attributes["src"] for tag, attributes in tags.seen if tag == "audio"]
    assert len(players) == audible
    assert all(src.startswith("data:audio/wav;base64,") for src in players)
    for words, reached in zip(("Slower.", "Still too fast?"), ("[inaudible]", "Steel two fast?"), strict=True):
        assert re.search(f"“{re.escape(words)}”</b> reaches the agent as “{re.escape(reached)}”, in 83 dB", text)
    assert "In the cabin" in text
    assert told in text
    assert ('class="muted note"' in text) == bool(told)
    before = page.read_bytes()
    assert write_page(folder).read_bytes() == before
