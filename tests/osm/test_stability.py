import shutil
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.errors import ScenarioError, TrafficError
from automotive_cosim.osm.report import ImportReport
from automotive_cosim.scenarios import load
from automotive_cosim.traffic import processor_time, stability
from automotive_cosim.traffic.stability import BACKLOG_SHARE_LIMIT, HALTED_SHARE_LIMIT, Stability, Stuck, measure

Imported = tuple[Path, ImportReport]

GOOD = Stability(
    scale=1.0,
    seed=0,
    step_length_s=1.0,
    observed_s=3600.0,
    halted_share_max=0.1,
    halted_share_mean=0.05,
    vehicles_mean=100.0,
    vehicles_max=120,
    arrived=500,
    teleports=0,
    collisions=0,
    backlog=0,
    backlog_share=0.0,
)


def test_every_article_of_the_law_can_be_broken() -> None:
    assert GOOD.stable
    for broken in (
        {"halted_share_max": HALTED_SHARE_LIMIT},
        {"teleports": 1},
        {"collisions": 1},
        {"backlog_share": BACKLOG_SHARE_LIMIT + 0.01},
        {"vehicles_max": 0},
    ):
        assert len(replace(GOOD, **broken).problems) == 1  # type: ignore[arg-type]


def test_a_red_light_is_no_jam_where_few_drive() -> None:
    """Nine of ten cars halted is a signal; nine of ten halted among two hundred is a jam."""
    for vehicles, is_jam in ((10, False), (200, True)):
        tally = stability._Tally(warm_s=0.0)
        for second in range(1, 181):
            counts = {"running": vehicles, "halting": 0.9 * vehicles, "teleports": 0, "inserted": vehicles}
            tally.add({"time": float(second), **counts})
        assert tally.broken_beyond(HALTED_SHARE_LIMIT) == is_jam


def test_sumo_says_who_stood_where_and_why() -> None:
    warnings = (
        "Warning: At actuated tlLogic 'a', linkIndex 4 has no controlling detector.\n",
        "Warning: Teleporting vehicle '3'; waited too long (wrong lane), lane='13#1_1', time=378.00.\n",
        "Warning: Vehicle '3' ends teleporting on edge '14', time=378.00.\n",
    )
    assert list(stability._stuck(warnings)) == [Stuck("3", "13#1_1", "wrong lane")]


def test_a_run_is_the_same_again_and_leaves_the_folder_alone(imported: Imported) -> None:
    folder, _ = imported
    before = {path.name: (path.stat().st_mtime_ns, path.stat().st_size) for path in folder.iterdir()}
    runs = [measure(load(folder), observe_s=300, seed=3) for _ in range(2)]
    assert runs[0] == runs[1]
    assert runs[0].observed_s == pytest.approx(300, abs=2)
    assert runs[0].arrived > 0
    assert 0 < runs[0].halted_share_mean <= runs[0].halted_share_max
    assert {path.name: (path.stat().st_mtime_ns, path.stat().st_size) for path in folder.iterdir()} == before


@pytest.mark.slow
def test_more_demand_means_more_vehicles_and_in_the_end_a_jam(imported: Imported) -> None:
    scenario = load(imported[0])
    calm = measure(scenario, observe_s=120, scale=0.5)
    busy = measure(scenario, observe_s=120, scale=1.0)
    jammed = measure(scenario, observe_s=600, scale=40.0, stop_at=0.4)
    assert calm.vehicles_mean < busy.vehicles_mean < jammed.vehicles_mean
    assert not jammed.stable
    assert jammed.observed_s < 600, "a lost run is given up"


def test_no_traffic_is_not_stable(imported: Imported) -> None:
    assert "no traffic" in measure(load(imported[0]), observe_s=120, scale=0.0).problems[0]


def test_what_sumo_refuses_is_told_in_sumos_words(imported: Imported, tmp_path: Path) -> None:
    folder = tmp_path / "broken"
    shutil.copytree(imported[0], folder)
    trips = next(folder.glob("*.trips.xml.gz"))
    config = next(folder.glob("*.sumocfg"))
    plain = folder / "trips.xml"
    plain.write_text('<routes><trip id="a" depart="0" from="no_such_edge" to="nor_this"/></routes>')
    config.write_text(config.read_text().replace(trips.name, plain.name))
    with pytest.raises(ScenarioError, match="no_such_edge") as refused:
        measure(load(folder), observe_s=60)
    assert "\n" not in str(refused.value)


def _stand_in(folder: Path, script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A program in SUMO's place."""
    path = folder / "sumo"
    path.write_text(f"#!{sys.executable}\nimport os, signal, sys, time\n{script}\n", encoding="utf-8")
    path.chmod(0o755)
    monkeypatch.setattr(stability, "program", lambda _name: path)


STEP = 'print(\'<step time="1.00" running="1" halting="0" waiting="0" inserted="1"/>\', flush=True)'
LAST = STEP.replace("1.00", "99999.00")


TOLD = pytest.mark.skipif(not processor_time.PROC.is_dir(), reason="no processor time is told")
BUSY, ASLEEP = "while True: pass", "time.sleep(600)"


@pytest.mark.parametrize(
    ("script", "limit"),
    [
        pytest.param(BUSY, "LOADING_LIMIT_S", id="busy loading"),
        pytest.param(f"{STEP}\n{BUSY}", "SILENCE_LIMIT_S", id="busy driving"),
        pytest.param(ASLEEP, "STANDSTILL_LIMIT_S", id="asleep loading", marks=TOLD),
        pytest.param(f"{STEP}\n{ASLEEP}", "STANDSTILL_LIMIT_S", id="asleep driving", marks=TOLD),
    ],
)
def test_a_sumo_that_hangs_is_ended(
    script: str, limit: str, imported: Imported, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the one limit that is for it: the others are minutes."""
    _stand_in(tmp_path, script, monkeypatch)
    monkeypatch.setattr(stability, "LOOK_EVERY_S", 0.05)
    monkeypatch.setattr(stability, limit, 0.5)
    with pytest.raises(TrafficError, match=r"hung in village\.sumocfg"):
        measure(load(imported[0]), observe_s=60)


@TOLD
def test_a_sumo_that_gets_no_processor_does_not_hang(
    imported: Imported, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is silent for twice the limit, before its first step and after it, and goes on."""
    _stand_in(tmp_path, f"time.sleep(1)\n{STEP}\ntime.sleep(1)\n{LAST}", monkeypatch)
    monkeypatch.setattr(stability, "LOOK_EVERY_S", 0.05)
    for limit in ("LOADING_LIMIT_S", "SILENCE_LIMIT_S"):
        monkeypatch.setattr(stability, limit, 0.5)
    assert measure(load(imported[0]), observe_s=60).vehicles_max == 1


@pytest.mark.parametrize(
    ("script", "limit"),
    [(ASLEEP, "LOADING_LIMIT_S"), (f"{STEP}\n{ASLEEP}", "SILENCE_LIMIT_S")],
    ids=["loading", "driving"],
)
def test_where_no_processor_time_is_told_wall_time_counts(
    script: str, limit: str, imported: Imported, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _stand_in(tmp_path, script, monkeypatch)
    monkeypatch.setattr(processor_time, "PROC", tmp_path)
    monkeypatch.setattr(stability, "LOOK_EVERY_S", 0.05)
    monkeypatch.setattr(stability, limit, 0.5)
    with pytest.raises(TrafficError, match=r"hung in village\.sumocfg"):
        measure(load(imported[0]), observe_s=60)


def test_a_sumo_that_is_killed_is_told_from_one_that_refuses(
    imported: Imported, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _stand_in(tmp_path, f"{STEP}\nos.kill(os.getpid(), signal.SIGKILL)", monkeypatch)
    with pytest.raises(TrafficError, match="killed by SIGKILL"):
        measure(load(imported[0]), observe_s=60)
    _stand_in(tmp_path, "sys.exit('Error: no way')", monkeypatch)
    with pytest.raises(ScenarioError, match="no way"):
        measure(load(imported[0]), observe_s=60)


def test_a_sumo_that_is_stopped_is_no_town_without_traffic(
    imported: Imported, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It ends in good order when it is asked to, as by a machine that shuts down."""
    _stand_in(tmp_path, STEP, monkeypatch)
    with pytest.raises(TrafficError, match="stopped from outside"):
        measure(load(imported[0]), observe_s=60)
