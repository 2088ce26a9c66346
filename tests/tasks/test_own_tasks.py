"""A folder of tasks of one's own joins the catalogue, or is refused with file, line and reason."""

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.tasking.catalogue import Catalogue
from automotive_cosim.tasks.folder import add_folder

OWN = """
from automotive_cosim.tasking.checks import SignalIs
from automotive_cosim.cockpit.signals import HVAC
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.forms import asked

TASKS = (
    asked(
        "own_sync",
        Module.HVAC,
        ("Sync off.", "One side each.", "Split the zones.", "Separate temperatures."),
        SignalIs(HVAC.SYNC, (False,)),
        Open("climate"),
        Tap("hvac.sync"),
    ),
)
"""


def test_a_folder_joins(tmp_path):
    (tmp_path / "own.py").write_text(OWN)
    catalogue = Catalogue()
    add_folder(catalogue, tmp_path)
    assert catalogue["own_sync"].optimal_steps == 3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("TASKS = (", r"own.py, line 1: '\(' was never closed"),
        ("\n\nTASKS = (undefined,)", r"own.py, line 3: NameError"),
        ("TASKS = (1, 2)", r"own.py has no TASKS"),
        ("raise SystemExit(0)", r"own.py, line 1: SystemExit"),
        ("def f(): f()\nf()", r"own.py, line 1: RecursionError"),
        (OWN.replace('"Sync off.", ', ""), r"own.py, line 10: .* has 3 phrasings"),
        (OWN.replace("Sync off.", "Sync {how}."), r"own.py, line 10: .* does not declare: how"),
        (OWN.replace("    ),\n)", "    ),\n) * 2"), r"own.py, line 10: .* occurs twice"),
    ],
    ids=["syntax", "name", "no tasks", "exit", "recursion", "phrasings", "parameter", "twice"],
)
def test_a_broken_file_is_refused_with_its_line(tmp_path, text, said):
    (tmp_path / "own.py").write_text(text)
    with pytest.raises(UserError, match=said):
        add_folder(Catalogue(), tmp_path)


@pytest.mark.slow
def test_a_file_cut_off_anywhere_is_read_or_refused(tmp_path):
    for end in range(0, len(OWN), 7):
        (tmp_path / "own.py").write_text(OWN[:end])
        with pytest.raises(UserError) as caught:
            add_folder(Catalogue(), tmp_path)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("where", ["nowhere", "."])
def test_a_folder_without_tasks_is_refused(tmp_path, where):
    with pytest.raises(UserError, match="--tasks-from"):
        add_folder(Catalogue(), tmp_path / where)
