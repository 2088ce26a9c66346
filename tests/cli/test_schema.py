"""``automotive-cosim show schema``."""

import json
import subprocess
import sys

from automotive_cosim import schemas


def test_it_lists_every_format(cli):
    ran = cli("show", "schema")
    assert ran.code == 0
    assert tuple(line.split()[0] for line in ran.out.splitlines()) == schemas.names()


def test_it_prints_one_or_writes_it(cli, tmp_path):
    printed = cli("show", "schema", "plan").out
    assert json.loads(printed)["title"] == "plan"
    assert cli("show", "schema", "plan", "--out", "plan.schema.json").code == 0
    assert (tmp_path / "plan.schema.json").read_text(encoding="utf-8") == printed


def test_a_wrong_name_is_one_line(cli):
    ran = cli("show", "schema", "plam")
    assert (ran.code, ran.out) == (2, "")
    assert (
        ran.err
        == "error: no schema named 'plam': did you mean 'plan'? List them with `automotive-cosim show schema`.\n"
    )
    assert "needs the NAME of a schema" in cli("show", "schema", "--out", "x.json").err


def test_it_reads_what_is_shipped_and_loads_nothing_for_it():
    code = (
        "import sys; sys.argv = ['automotive-cosim', 'show', 'schema', 'rules']\n"
        "from automotive_cosim.cli.main import main\n"
        "try: main()\n"
        "finally: print([name for name in ('shapely', 'automotive_cosim.geo') if name in sys.modules])"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "[]"


def test_every_problem_of_a_file_is_a_line(cli, tmp_path):
    (tmp_path / "plan.toml").write_text("agents = 3\nseeds = [-1]\nsede = 1\n", encoding="utf-8")
    ran = cli("eval", "--plan", "plan.toml", "--dry-run")
    assert (ran.code, ran.out) == (2, "")
    assert sorted(line.split(":")[1] for line in ran.err.splitlines()) == [
        " plan.toml line 1", " plan.toml line 2", " plan.toml line 3",
    ]  # fmt: skip
    assert all(line.startswith("error: ") for line in ran.err.splitlines())
