"""How a day is corrected, and what is read off the counted road."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.osm import ImportReport, fit
from automotive_cosim.traffic.network import read_network

Imported = tuple[Path, ImportReport]


def test_what_is_short_is_made_up_and_a_full_road_is_not_flooded() -> None:
    hour = fit.Hour(8, 1000.0, 500.0, 18.3, None, 0.1, 1000, 0, 1.0, 0.0, 0)
    assert fit._next(1000.0, hour) == 2000.0
    assert fit._next(2000.0, hour) == 2000.0, "never more than twice what was counted"
    assert fit._next(1000.0, replace(hour, simulated_per_h=1250.0)) == 800.0
    assert fit._next(1000.0, replace(hour, simulated_per_h=9000.0)) == 500.0
    assert fit._next(0.0, replace(hour, counted_per_h=0.0, simulated_per_h=0.0)) == 0.0


def test_flow_and_occupancy_are_those_of_all_edges_in_a_row(imported: Imported, tmp_path: Path) -> None:
    """360 vehicles in an hour over 100 m of one lane and 50 m of two; each covers 5 m of lane all the time."""
    edge = next(iter(read_network(next(imported[0].glob("*.net.xml.gz"))).edges.values()))
    edges = (
        replace(edge, edge_id="a", length_m=100.0, lane_ids=("a_0",)),
        replace(edge, edge_id="b", length_m=50.0, lane_ids=("b_0", "b_1")),
    )
    file = tmp_path / "counted.xml"
    file.write_text(
        '<meandata><interval begin="0" end="3600">'
        '<edge id="a" sampledSeconds="3600" speed="10" occupancy="5"/>'
        '<edge id="b" sampledSeconds="1800" speed="10" occupancy="2.5"/></interval>'
        '<interval begin="3600" end="7200"><edge id="a" sampledSeconds="0"/></interval></meandata>',
        encoding="utf-8",
    )
    (flow, occupancy), empty = fit._read_measured(file, edges, 3600.0)
    assert flow == pytest.approx(360)
    assert occupancy == pytest.approx(7.5 / 200)
    assert empty == (0, 0)
    assert fit._read_measured(file, edges, 1800.0)[0][0] == pytest.approx(720)
