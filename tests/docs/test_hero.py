"""The README's picture is of a run that goes as its caption says.

After a change to it: ``automotive-cosim run --pair --seed 3 --out FOLDER``, and copy its ``pair.webp`` and
``pair.json`` to ``docs/images``, and the sentence to the README.
"""

import json
import re
from pathlib import Path

import pytest
from PIL import Image

from automotive_cosim.report.pair import FIGURES, FILM, PAGE

TOP = Path(__file__).parents[2]
IMAGES = TOP / "docs/images"
MOST_BYTES = 1_000_000
"""What a README should load."""


def test_the_caption_is_the_result_on_record():
    readme = re.sub(r"\s+", " ", (TOP / "README.md").read_text(encoding="utf-8"))
    assert f"(docs/images/{FILM})" in readme
    assert json.loads((IMAGES / FIGURES).read_text(encoding="utf-8"))["sentence"] in readme
    assert (IMAGES / FILM).stat().st_size < MOST_BYTES


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [("--scenario", "grid", "--task", "hvac_fan_max"), pytest.param(("--seed", "3"), marks=pytest.mark.proof)],
)
def test_the_picture_is_of_a_run_of_today(cli, warm, tmp_path, words):
    """In another place, as far as a picture is like another."""
    folder, is_elsewhere = tmp_path / "pair", "--scenario" in words
    told = cli("run", "--pair", "--out", str(folder), "--json", *words)
    assert [each["success"] for each in json.loads(told.out)["pair"]] == [True, is_elsewhere]
    figures, shown_figures = (json.loads((path / FIGURES).read_text()) for path in (folder, IMAGES))
    with Image.open(folder / FILM) as film, Image.open(IMAGES / FILM) as shown:
        if is_elsewhere:
            assert (film.size, figures.keys()) == (shown.size, shown_figures.keys())
        else:
            assert (film.size, film.n_frames, figures) == (shown.size, shown.n_frames, shown_figures)
    page = (folder / PAGE).read_text()
    assert "with_place/summary.html" in page
    assert (folder / "without_place" / "summary.html").is_file()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--agent", "t3a"], "t3a is never told"),
        (["--geo", "none"], "omit --geo none"),
        (["--agent", "human"], "omit it with human"),
    ],
)
def test_what_cannot_be_a_pair_is_said(cli, options, words):
    told = cli("run", "--pair", *options)
    assert told.code == 2
    assert words in told.err
