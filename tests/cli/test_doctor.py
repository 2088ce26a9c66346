"""``doctor`` names what is missing, and what to do."""

import importlib.util
import json
import os
import socket

import pytest

from automotive_cosim.cli import doctor
from automotive_cosim.cockpit import theme
from automotive_cosim.errors import SetupError
from automotive_cosim.traffic import sumo


@pytest.fixture
def without_sumo(monkeypatch):
    def refuse():
        raise SetupError("libsumo cannot be loaded (libGL.so.1): apt-get install libgl1")

    monkeypatch.setattr(sumo, "load_library", refuse)


@pytest.mark.sumo
def test_a_machine_that_runs_the_tests_is_ready(cli):
    ran = cli("doctor")
    assert ran.code == 0
    assert ran.out.splitlines()[-1] == "ready"


def test_a_missing_library_is_named_with_its_fix(cli, without_sumo):
    ran = cli("doctor")
    assert ran.code == 1
    line = next(line for line in ran.out.splitlines() if "SUMO" in line)
    assert line.startswith("missing")
    assert "libGL.so.1" in line
    assert "apt-get install libgl1" in line
    assert ran.out.splitlines()[-1].startswith("not ready")


def test_json_says_the_same(cli, without_sumo):
    ran = cli("doctor", "--json")
    told = json.loads(ran.out)
    assert ran.code == 1
    assert not told["ok"]
    assert {check["about"]: check["state"] for check in told["checks"]}["SUMO"] == "missing"
    assert all(check["fix"] for check in told["checks"] if check["state"] != "ok")


def _no_spec(missing):
    def find(name, package=None):
        return None if missing(name) else importlib.util.find_spec(name, package)

    return find


def test_links_that_git_left_as_text_are_found(monkeypatch):
    monkeypatch.setattr(doctor, "find_spec", _no_spec(lambda name: name == "automotive_cosim.tasks"))
    found = doctor._folders()
    assert found.state is doctor.Health.MISSING
    assert "pip install -e ." in found.fix


def test_missing_fonts_are_found(monkeypatch):
    monkeypatch.setattr(theme, "find_spec", _no_spec(lambda name: name == "font_roboto"))
    theme.font.cache_clear()
    found = doctor._fonts()
    assert found.state is doctor.Health.MISSING
    assert "font_roboto" in found.found


def test_a_plain_installation_sets_no_arabic_and_is_ready_all_the_same(monkeypatch):
    monkeypatch.setattr(theme, "find_spec", _no_spec(lambda name: name == "matplotlib"))
    monkeypatch.setattr(theme, "sets_right_to_left", lambda: False)
    theme.font.cache_clear()
    found = doctor._fonts()
    assert found.state is doctor.Health.OK
    assert "libfribidi0" in found.fix


def test_a_system_without_fork_is_told_what_to_use(monkeypatch):
    monkeypatch.delattr(os, "fork")
    found = doctor._processes()
    assert (found.state, found.fix) == (doctor.Health.MISSING, "use Linux; on Windows WSL, on macOS a container")


def test_little_memory_and_little_disk_are_limits(monkeypatch):
    monkeypatch.setattr(doctor, "MEMORY_MB", 10**9)
    monkeypatch.setattr(doctor, "DISK_MB", 10**9)
    assert {doctor._memory().state, doctor._disk().state} == {doctor.Health.LIMITED}


def test_a_machine_that_lets_nothing_listen_is_limited(monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(socket, "create_server", refuse)
    found = doctor._ports()
    assert found.state is doctor.Health.LIMITED
    assert "not permitted" in found.found


def test_each_extra_of_the_package_is_known():
    from importlib.metadata import metadata

    declared = set(metadata("automotive-cosim").get_all("Provides-Extra")) - {"test", "dev", "docs"}
    assert declared == set(doctor.EXTRAS)
