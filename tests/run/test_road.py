"""The recorded road of an episode."""

import gzip
import json
from types import SimpleNamespace

import numpy as np
import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.contracts import GroundArea, GroundKind, LaneShape, RoadNetwork, RoadShapes, RoadSnapshot
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import ROAD
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.road import SeenColumns, read_record, read_road
from automotive_cosim.run.road_recorder import RoadRecorder, RoadWriter, along
from automotive_cosim.run.trial import run_trial

from .conftest import Memory


@pytest.mark.sumo
def test_the_road_is_recorded_and_nothing_else_changes(tmp_path, simulations):
    setup = EpisodeSetup(task="hvac_fan_max", scenario="grid", agent="oracle", model="none")
    memory = Memory()
    blind = run_trial(setup, make_agent("oracle"), [memory], simulations=simulations)
    path = memory.told.path
    seeing = run_trial(setup, make_agent("oracle"), [RoadRecorder(tmp_path, setup.about)], simulations=simulations)
    assert seeing == blind, "the trace's hash included"
    record = read_record(tmp_path / ROAD)
    assert [second.at_s for second in record.seconds] == [sample.at_s for sample in path[1:]]
    for sample, second in zip(path[1:], record.seconds, strict=True):
        (ego,) = (each for each in second.vehicles if each.vehicle_id == "ego")
        assert (ego.x_m, ego.y_m) == pytest.approx((sample.x_m, sample.y_m), abs=0.006)
        assert (ego.heading_deg - sample.heading_deg) % 360 == pytest.approx(0.0, abs=0.06)
        assert ego.speed_mps * 3.6 == pytest.approx(sample.speed_kmh, abs=0.02)
    lights = {light for lane in record.shapes.lanes for light, _ in lane.links}
    assert lights
    assert lights == record.seconds[-1].lights.keys()
    assert max(len(second.vehicles) for second in record.seconds) > 1
    (baseline,) = (line["baseline"] for line in read_road(tmp_path / ROAD) if "baseline" in line)
    assert [row[0] for row in baseline] == [
        second.at_s for second in record.seconds if 0 <= second.at_s <= blind.sim_seconds
    ]
    at_hand_over = next(sample for sample in path if sample.at_s == 0)
    assert baseline[0][1:3] == [at_hand_over.x_m, at_hand_over.y_m]

    path = tmp_path / ROAD
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) * 2 // 3])
    cut = read_record(path)
    assert 0 < len(cut.seconds) < len(record.seconds)
    assert cut.seconds == record.seconds[: len(cut.seconds)]


@pytest.mark.parametrize(
    "content", [b"", b"not gzip", gzip.compress(b'{"format":3}\n', mtime=0), gzip.compress(b"[]\n", mtime=0)]
)
def test_another_file_is_refused_in_one_line(tmp_path, content):
    path = tmp_path / ROAD
    path.write_bytes(content)
    if not content:
        assert read_record(path).seconds == ()
        return
    with pytest.raises(UserError, match=r"road\.jsonl\.gz"):
        read_record(path)


def test_the_seconds_of_a_drive_come_back_as_they_were_told_and_so_do_those_of_the_former_format(tmp_path):
    rng = np.random.default_rng(0)
    seconds, packer = [], SeenColumns()
    for _ in range(50):  # vehicles come, go and come again, turn through north and stand
        seen = sorted(rng.choice(30, 12, replace=False).tolist())
        seconds.append(
            [
                [
                    number,
                    round(float(rng.normal(0, 3000)), 2),
                    round(float(rng.normal(0, 3000)), 2),
                    round(float(rng.integers(3600)) / 10, 1),
                    round(float(max(0.0, rng.normal(5, 10))), 2),
                    int(rng.integers(64)),
                ]
                for number in seen
            ]
        )
    for form, told in (1, lambda rows: rows), (2, packer.packed):
        lines = [{"format": form}, *({"at_s": 0.0, "seen": told(rows)} for rows in seconds)]
        (tmp_path / ROAD).write_bytes(gzip.compress("".join(json.dumps(line) + "\n" for line in lines).encode()))
        assert [line["seen"] for line in read_road(tmp_path / ROAD) if "seen" in line] == seconds


@pytest.mark.parametrize(
    "seen",
    [
        [[1]],
        [[1, 2], [1], [1], [1], [1], [1]],
        [["a"], [1], [1], [1], [1], [1]],
        [[1], [10**400], [1], [1], [1], [1]],
        [[1], [1], [1], [None], [1], [1]],
        7,
    ],
)
def test_columns_that_are_none_are_refused(tmp_path, seen):
    (tmp_path / ROAD).write_bytes(gzip.compress(json.dumps({"format": 2, "seen": seen}).encode() + b"\n"))
    with pytest.raises(UserError, match="cannot read"):
        list(read_road(tmp_path / ROAD))


def test_a_line_that_is_not_json_is_refused(tmp_path):
    path = tmp_path / ROAD
    path.write_bytes(gzip.compress(json.dumps({"format": 1}).encode() + b"\n{\n"))
    with pytest.raises(UserError, match="cannot read"):
        list(read_road(path))


def test_the_ground_is_told_once_as_it_comes_into_sight_and_read_in_its_drawing_order(tmp_path):
    near, far = (
        GroundArea(GroundKind.WATER, ((x_m, 0.0), (x_m + 50.0, 0.0), (x_m, 50.0))) for x_m in (100.0, 1500.0)
    )
    around = GroundArea(GroundKind.GREEN, ((-9000.0, 9000.0), (9000.0, 9000.0), (0.0, -9000.0)))
    shapes = RoadShapes((LaneShape("a_0", "road", 3.2, ((0.0, 0.0), (9.0, 0.0))),), (), (near, far, around))
    network = RoadNetwork((), (0.0, 0.0, 1.0, 1.0), None, (0.0, 0.0), False)
    writer = RoadWriter(tmp_path / ROAD, shapes, network, {}, 0.0)
    for x_m in (0.0, 10.0, 800.0, 1600.0):
        writer._seek(x_m, 0.0)
    writer.close()
    told = [entry["ground"] for entry in read_road(tmp_path / ROAD) if "ground" in entry]
    assert [[kind for kind, _ in areas] for areas in told] == [["water", "green"], ["water"]]
    assert read_record(tmp_path / ROAD).shapes.ground == (around, near, far)


def test_a_line_that_was_broken_off_ends_the_record(tmp_path, monkeypatch):
    network = RoadNetwork((), (0.0, 0.0, 1.0, 1.0), None, (0.0, 0.0), False)
    writer = RoadWriter(tmp_path / ROAD, RoadShapes((), (), ()), network, {}, 0.0)
    writer.baseline(())
    writer._file.flush()
    compressed = writer._file.compress

    def broken_off(data):
        compressed.compress(data)
        raise KeyboardInterrupt

    monkeypatch.setattr(writer._file, "compress", SimpleNamespace(compress=broken_off))
    with pytest.raises(KeyboardInterrupt):
        writer.baseline(())
    writer.baseline(())
    writer.close()
    assert [sorted(line) for line in read_road(tmp_path / ROAD)][1:] == [["baseline"]]


def test_of_several_departures_only_the_last_is_kept(tmp_path):
    recorder = RoadRecorder(tmp_path, EpisodeSetup().about)
    drives = [[(1.0, "first"), (2.0, "first"), (3.0, "first")], [(2.0, "second"), (3.0, "second")]]
    for drive in drives:
        for time_s, name in drive:
            recorder.looked(RoadSnapshot(time_s, (), ()))
            recorder.moved(SimpleNamespace(time_s=time_s, name=name), None)
    assert [moment.name for moment, _ in recorder._before] == ["first", "second", "second"]


def test_a_place_along_a_line():
    line = [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0)]
    assert [along(line, at_m) for at_m in (-1.0, 4.0, 10.0, 12.0, 99.0)] == [
        (0.0, 0.0), (4.0, 0.0), (10.0, 0.0), (10.0, 2.0), (10.0, 5.0)
    ]  # fmt: skip
