import re
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.report.plot import Plot, SpeedAxis
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.job_row import from_json
from automotive_cosim.run.timeline import Sample

samples = st.lists(
    st.tuples(st.floats(0, 250), st.none() | st.sampled_from([30.0, 50.0, 80.0, 130.0])), min_size=1, max_size=60
)


def _plot(rows, width=960, height=300, timeline=()):
    path = [Sample(float(i - 5), speed, limit, "", 0.0, 0.0, 0.0) for i, (speed, limit) in enumerate(rows)]
    return Plot(path, timeline, width, height)


def _points(path):
    return [(float(x), float(y)) for x, y in re.findall(r"([-\d.e]+) ([-\d.e]+)", path)]


@given(samples, st.sampled_from([(960, 300), (420, 280)]))
def test_everything_drawn_lies_within_the_axes(rows, size):
    plot = _plot(rows, *size)
    drawn = [plot.speed, *plot.over, *plot.limits]
    for x, y in (point for path in drawn for point in _points(path)):
        assert plot.left - 0.1 <= x <= plot.right + 0.1
        assert plot.top - 0.1 <= y <= plot.bottom + 0.1


@given(samples)
def test_an_area_stands_only_where_the_speed_is_above_the_limit(rows):
    over = [limit is not None and speed > limit + 1 for speed, limit in rows]
    runs = sum(a and b and not c for c, a, b in zip([False, *over], over, over[1:], strict=False))
    assert len(_plot(rows).over) == runs


@given(samples)
def test_times_are_labelled_with_room_between_them(rows):
    plot = _plot(rows, 420, 280)
    at = [plot.x(time) for time in plot.times]
    assert all(b - a >= 40 for a, b in pairwise(at))


def test_no_limit_draws_no_limit():
    assert _plot([(50.0, None), (60.0, None)]).limits == ()


def test_the_first_event_of_a_kind_is_marked(episode):
    result = from_json(EpisodeResult, episode())
    plot = Plot(result.path, result.timeline, 960, 300)
    assert [kind for _, kind, _ in plot.marks] == ["alert", "declared", "limit"]
    assert plot.marks[0][0] == plot.x(1.0)


@given(samples, st.sampled_from([("km/h", 1.0), ("mph", 1.609344)]))
def test_the_axis_counts_in_the_unit_of_the_signs(rows, unit):
    name, kmh_per_unit = unit
    path = [Sample(float(i), speed, limit, "", 0.0, 0.0, 0.0, name) for i, (speed, limit) in enumerate(rows)]
    axis = SpeedAxis.of(path)
    assert axis.unit == name
    assert all(kmh == pytest.approx(figure * kmh_per_unit) for figure, kmh in axis.lines)
    assert axis.top_kmh >= max(max(speed, limit or 0.0) for speed, limit in rows)
    assert 2 <= len(axis.lines) <= 8
    assert axis.lines[-1][1] <= axis.top_kmh + 1e-9
