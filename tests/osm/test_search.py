"""The search for traffic that flows, on figures made up instead of simulated."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.geo.place import Place
from automotive_cosim.osm import importer
from automotive_cosim.osm.importer import HALTED_SHARE_AIM, SCALE_MIN, SHORT_TRIAL_S, TRIALS
from automotive_cosim.osm.settings import ImportOptions
from automotive_cosim.traffic.stability import Stability, Stuck

OWN_STEP_S = 0.1
FLOWS = Stability(1.0, 0, 1.0, 600.0, 0.05, 0.02, 80.0, 99, 500, 0, 0, 0, 0.0)
Judge = Callable[[float, float, int], Stability]
"""Scale, step length and number of trips -> figures."""


class _Searched:
    """A search whose trials are judged by a function."""

    def __init__(self, judge: Judge, monkeypatch: pytest.MonkeyPatch, options: ImportOptions) -> None:
        self.trials: list[tuple[float, float, float]] = []
        self.trips = 0

        def measure(_: object, *, scale: float, step_length_s: float, observe_s: float, **__: object) -> Stability:
            self.trials.append((scale, step_length_s, observe_s))
            return replace(judge(scale, step_length_s, self.trips), scale=scale, step_length_s=step_length_s)

        def write(journeys: list[Any], _: Path) -> None:
            self.trips = len(journeys)

        scenario = SimpleNamespace(sumo=SimpleNamespace(step_length_s=OWN_STEP_S))
        monkeypatch.setattr(importer, "measure", measure)
        monkeypatch.setattr(importer, "_write", lambda *_, **__: scenario)
        monkeypatch.setattr(importer.demand, "write", write)
        monkeypatch.setattr(importer.trips, "pick", lambda *_: ())
        drawn: Any = SimpleNamespace(journeys=list(range(1000)), routes=())
        rng = np.random.default_rng(0)
        self.search = importer._Search(Path("x"), options, Place(), drawn, rng, lambda *_: None, edges=1000)


def jams_above(scale_max: float) -> Judge:
    def judge(scale: float, _: float, __: int) -> Stability:
        share = HALTED_SHARE_AIM * min(4.0, scale / scale_max)
        return replace(FLOWS, halted_share_max=share) if scale > scale_max else FLOWS

    return judge


@pytest.mark.parametrize("scale_max", [1.0, 0.7, 0.3, 0.06, SCALE_MIN])
def test_the_search_is_bounded_and_ends_near_the_answer(scale_max: float, monkeypatch: pytest.MonkeyPatch) -> None:
    searched = _Searched(jams_above(scale_max), monkeypatch, ImportOptions(name="x"))
    flow, journeys, stuck = searched.search.run()
    assert 0.4 * scale_max <= flow.scale <= scale_max
    assert flow.step_length_s == OWN_STEP_S
    assert len(searched.trials) <= TRIALS
    assert searched.trials[-1] == (flow.scale, OWN_STEP_S, SHORT_TRIAL_S)
    assert (flow.scale, 1.0, 60 * ImportOptions().stable_for_min) in searched.trials, "half an hour, in long steps"
    assert (len(journeys), stuck) == (1000, ())


def test_what_never_flows_is_refused_in_bounded_time(monkeypatch: pytest.MonkeyPatch) -> None:
    searched = _Searched(jams_above(0.01), monkeypatch, ImportOptions(name="x"))
    with pytest.raises(UserError, match=r"even at a scale of 0\.05 .*halted"):
        searched.search.run()
    assert len(searched.trials) <= TRIALS


def test_a_quick_import_tries_modest_traffic_in_long_steps_only(monkeypatch: pytest.MonkeyPatch) -> None:
    searched = _Searched(jams_above(1.0), monkeypatch, ImportOptions(name="x", quick=True))
    flow, _, _ = searched.search.run()
    assert searched.trials == [(0.5, 1.0, 600.0)]
    assert flow.scale == 0.5


def test_trips_that_stand_for_good_are_left_out_and_the_rest_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def judge(_: float, step_length_s: float, trips: int) -> Stability:
        left = 1000 - trips
        if step_length_s == 1.0 and left < 3:
            return replace(FLOWS, teleports=1, stuck=(Stuck(str(left), "12#0_1", "wrong lane"),))
        return FLOWS

    searched = _Searched(judge, monkeypatch, ImportOptions(name="x"))
    flow, journeys, stuck = searched.search.run()
    assert flow.scale == 1.0, "the demand of all others stays"
    assert len(journeys) == 997
    assert len(stuck) == 3


def test_a_map_in_which_many_stand_is_not_thinned_out(monkeypatch: pytest.MonkeyPatch) -> None:
    crowd = tuple(Stuck(str(number), "12#0_1", "jam") for number in range(11))

    def judge(scale: float, _: float, __: int) -> Stability:
        return replace(FLOWS, teleports=11, stuck=crowd) if scale > 0.5 else FLOWS

    flow, journeys, stuck = _Searched(judge, monkeypatch, ImportOptions(name="x")).search.run()
    assert (len(journeys), stuck) == (1000, ())
    assert flow.scale <= 0.5
