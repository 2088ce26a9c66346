"""Nothing that a hostile evaluation holds reaches a terminal as a control, or a page as markup."""

import json
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.formats.files import read_unpacked
from automotive_cosim.formats.plain import plain

from .test_cost import renewed

MARKUP = "<img src=x onerror=alert(1)><script>alert(1)</script>"
EVIL = MARKUP + r"$\frac{$" + "\x1b[2J\x1b]0;owned\x07\x9b1A\r\u202e"
CASES = {
    "names": (("episodes.jsonl", "manifest.json"), {"agent", "agents", "model", "models"}),
    "errors and starts": (
        ("episodes.jsonl", "manifest.json"),
        {"error", "error_kind", "agent_error", "failed_attempts"}
        | {"started", "python", "automotive-cosim", "platform", "commit"},
    ),
    "plan": (("manifest.json",), {"tasks", "scenarios", "split"}),
    "places and traces": (
        ("episodes.jsonl", "traces/*.gz"),
        {"scenario", "country", "traffic_seed"} | {"goal", "why", "text", "road", "rule", "thought", "context"},
    ),
}


def hostile(value: Any, names: frozenset[str], name: str = "") -> Any:
    """The value with a hostile end at every text of some fields."""
    match value:
        case dict():
            return {key: hostile(each, names, key) for key, each in value.items()}
        case list():
            return [hostile(each, names, name) for each in value]
        case str() if name in names:
            return value + EVIL
    return value


def rewritten(path: Path, names: frozenset[str]) -> None:
    """Every text of these fields in a file of JSON is hostile."""
    text = read_unpacked(path).decode()
    lines = text.splitlines() if path.suffix != ".json" else [text]
    text = "".join(json.dumps(hostile(json.loads(line), names)) + "\n" for line in lines)
    path.write_bytes(text.encode())


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_names_and_texts_stay_texts(case, folder, unpacked, tmp_path, cli):
    patterns, names = CASES[case]
    for where in (folder, unpacked):
        for path in (path for pattern in patterns for path in where.glob(pattern)):
            rewritten(path, frozenset(names))
    shelf = tmp_path / "shelf"
    shelf.mkdir()
    renewed(unpacked, shelf / f"{EVIL.replace('/', '')}.bundle")
    shown = [
        cli("report", folder),
        cli("publish", "regrade", folder),
        cli("publish", "verify", folder, "--replay", "0"),
        cli("publish", "bundle", folder, "--out", tmp_path / "again.bundle"),
        cli("publish", "leaderboard", shelf, "--out", tmp_path / "page.html"),
    ]
    for ran in shown:
        assert plain(ran.out + ran.err) == ran.out + ran.err
        assert ran.code in (0, 1, 2), ran.err
        assert "Traceback" not in ran.err
    pages = [path.read_text("utf-8") for path in (*folder.glob("*.html"), *tmp_path.glob("*.html"))]
    assert pages, shown
    for page in pages:
        assert MARKUP not in page
        assert "<script>alert" not in page
        assert not set("\x1b\x07\x9b\u202e") & set(page)
