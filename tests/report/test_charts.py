"""Plots: numbers along axes are written out."""

from __future__ import annotations

import re

import pytest

from automotive_cosim.report.charts import drawn


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
