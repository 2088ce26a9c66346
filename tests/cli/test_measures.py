"""``automotive-cosim measures`` on a recorded road."""

import gzip
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Cli = Callable[..., Any]


def record(folder: Path, ahead_m: float = 44.5) -> Path:
    """The ego follows another car that it comes nearer to, five metres every second."""
    lines: list[dict[str, object]] = [
        {"format": 1},
        {"vehicles": [[0, "ego", "passenger", 5, 1.8], [1, "b", "bus", 12, 2.5]]},
    ]
    for second in range(5):
        seen = [[0, 0.0, 20.0 * second, 0.0, 20.0, 0], [1, 0.0, ahead_m + 15.0 * second, 0.0, 15.0, 0]]
        lines.append(
            {"at_s": float(second), "seen": seen, "lights": {}, "local_time": "", "sun_deg": None, "incidents": []}
        )
    with gzip.open(folder / "road.jsonl.gz", "wt") as file:
        file.writelines(json.dumps(line) + "\n" for line in lines)
    return folder


def test_encounters_and_readings_come_as_csv(cli: Cli, tmp_path: Path) -> None:
    folder = record(tmp_path)
    heads, line = cli("measures", folder).out.splitlines()
    found = dict(zip(heads.split(","), line.split(","), strict=True))
    assert (found["vehicle"], found["other"], found["kind"], found["min_ttc_s"]) == ("ego", "b", "following", "2.5")
    assert len(cli("measures", folder, "--readings").out.splitlines()) == 1 + 5
    assert len(cli("measures", folder, "--ttc", 1).out.splitlines()) <= 2
    none = cli("measures", record(folder, ahead_m=99.0))
    assert len(none.out.splitlines()) == 1
    assert "no encounters within 50 m in 5 seconds" in none.err
    told = cli("measures", record(folder), "--out", tmp_path / "a.csv").out
    assert told.startswith("1 line in ")


def test_tables_come_as_parquet(cli: Cli, tmp_path: Path) -> None:
    pd = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    folder = record(tmp_path)
    for words, count in (((), 1), (("--readings",), 5)):
        assert cli("measures", folder, *words, "--out", tmp_path / "a.csv").code == 0
        assert cli("measures", folder, *words, "--out", tmp_path / "a.parquet").code == 0
        written, table = pd.read_parquet(tmp_path / "a.parquet"), pd.read_csv(tmp_path / "a.csv")
        assert list(written.columns) == list(table.columns)
        assert written.ttc_s.tolist() == table.ttc_s.tolist() if words else written.min_ttc_s.tolist() == [2.5]
        assert len(written) == count
        assert set(written.kind) == {"following"}


def test_what_was_not_recorded_is_said_in_a_line(cli: Cli, tmp_path: Path) -> None:
    ran = cli("measures", tmp_path)
    assert ran.code == 2
    assert "has no road.jsonl.gz; `run` and `eval --pictures all`" in ran.err


def test_of_an_evaluation_every_trial_with_a_road_has_its_lines(cli: Cli, tmp_path: Path) -> None:
    alone = cli("measures", record(tmp_path)).out.splitlines()
    for name in ("one", "two"):
        (tmp_path / "e/pictures" / name).mkdir(parents=True)
        record(tmp_path / "e/pictures" / name)
    heads, *lines = cli("measures", tmp_path / "e").out.splitlines()
    assert heads == f"trial,{alone[0]}"
    assert lines == [f"one,{alone[1]}", f"two,{alone[1]}"]
    assert cli("measures", tmp_path / "e", "--out", tmp_path / "a.csv").out.startswith("2 lines")


def test_an_evaluation_without_an_encounter_has_the_same_columns(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "e/pictures/one").mkdir(parents=True)
    record(tmp_path / "e/pictures/one", ahead_m=99.0)
    assert cli("measures", tmp_path / "e").out.startswith("trial,")


def test_of_an_evaluation_export_names_the_trials_with_a_road(cli: Cli, tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / "e/pictures" / name).mkdir(parents=True)
        (tmp_path / "e/pictures" / name / "road.jsonl.gz").touch()
    ran = cli("export", tmp_path / "e", "csv")
    told = " ".join(str(ran.err).split())
    assert "is an evaluation; give one of its runs: " in told
    assert "pictures/one, " in told
