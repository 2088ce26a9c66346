"""Plots: numbers along axes are written out, legends fit, and each is a file for everybody."""

import re
import warnings

import pytest

from automotive_cosim.report.charts import NARROW_IN, WIDE_IN, Chart, charted, drawn, legend


@pytest.mark.parametrize(
    ("least", "most", "scale"), [(0, 3_400_000, "linear"), (0.00002, 0.00009, "linear"), (40, 90_000, "log")]
)
def test_axes_have_no_powers_of_ten(least: float, most: float, scale: str) -> None:
    def draw(axes):
        axes.plot([least, most], [0, 1])
        axes.set_xscale(scale)

    texts = re.findall(r">([^<>\n]+)</text>", drawn("plot", (3.0, draw), 9.6))
    numbers = [float(text.replace(",", "").replace("−", "-")) for text in texts]
    assert len([each for each in numbers if least <= each <= most]) >= 3
    assert all("e" not in text for text in texts)


def test_a_plot_is_a_file_for_the_web_for_papers_and_for_slides() -> None:
    def draw(axes):
        axes.plot([0, 1], [0, 1])
        axes.set_title("外堀通り")

    with warnings.catch_warnings(record=True) as complaints:
        warnings.simplefilter("always")
        files = dict(Chart.of("plot", "A plot", (3.0, draw)).files())
        again = dict(Chart.of("plot", "A plot", (3.0, draw)).files())
    assert files == again, "the same plot gives the same bytes"
    assert files.keys() == {"svg", "pdf", "png"}
    assert files["svg"].startswith(b"<svg")
    assert b"currentColor" not in files["svg"]
    assert files["pdf"].startswith(b"%PDF")
    assert b"CJK" in files["pdf"], "it brings the letters along"
    assert files["png"].startswith(b"\x89PNG")
    assert not complaints


def test_a_plot_without_anything_to_show_is_left_out_and_a_narrow_page_may_have_its_own() -> None:
    def told(words):
        return 3.0, lambda axes: axes.set_title(words)

    made = charted({"one": ("One", told("wide")), "none": ("None", None)}, {"one": told("narrow")})
    assert list(made) == ["one"]
    assert ">wide<" in made["one"].wide
    assert ">narrow<" in made["one"].narrow


@pytest.mark.parametrize(("width_in", "lines"), [(WIDE_IN, 1), (NARROW_IN, 2)])
def test_a_legend_is_no_wider_than_its_plot(width_in: float, lines: int) -> None:
    def draw(axes):
        axes.plot([0, 1], [0, 1], label="advice to 50 % of the cars, 80 % follow, news 300 s old")
        legend(axes)

    texts = re.findall(r">([^<>\n]+)</text>", drawn("plot", (3.0, draw), width_in))
    assert len([text for text in texts if re.search("advice|old", text)]) == lines
