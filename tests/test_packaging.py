"""What is in the checkout is in the distribution."""

import importlib
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import automotive_cosim
from automotive_cosim.traffic.sumo import DEBIAN_PACKAGES

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def project() -> dict:
    if not (ROOT / "pyproject.toml").is_file():
        pytest.skip("not run from a checkout")
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_every_package_is_listed(project):
    mapped = project["tool"]["setuptools"]["package-dir"]
    folders = {ROOT / folder: name for name, folder in mapped.items()}
    found = set()
    for folder, name in folders.items():
        for marker in folder.rglob("__init__.py"):
            inner = marker.parent.relative_to(folder).parts
            if not any((folder / Path(*inner[:depth])).is_symlink() for depth in range(1, len(inner) + 1)):
                found.add(".".join((name, *inner)))
    assert found == set(project["tool"]["setuptools"]["packages"])


def test_the_links_point_to_the_mapped_folders(project):
    for name, folder in project["tool"]["setuptools"]["package-dir"].items():
        if "." in name:
            assert (ROOT / name.replace(".", "/")).resolve() == (ROOT / folder).resolve()


def test_every_template_and_style_is_package_data(project):
    packed = {
        file
        for package, patterns in project["tool"]["setuptools"]["package-data"].items()
        for pattern in patterns
        for file in ROOT.joinpath(*package.split(".")).glob(pattern)
    }
    shown = {file for kind in ("html", "css") for file in (ROOT / "automotive_cosim").rglob(f"*.{kind}")}
    assert shown
    assert not shown - packed


def test_the_version_is_stated_once(project):
    assert "version" in project["project"]["dynamic"]
    assert project["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "automotive_cosim.__version__"}


@pytest.mark.parametrize("name", ["tasks", "agents"])
def test_another_name_is_refused(name: str):
    outside = subprocess.run(
        [sys.executable, "-c", f"import {name}"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert outside.returncode == 1
    assert f"automotive_cosim.{name}" in outside.stderr


def test_every_console_script_is_there(project):
    for target in project["project"]["scripts"].values():
        module, _, function = target.partition(":")
        assert module in project["tool"]["setuptools"]["py-modules"]
        assert callable(getattr(importlib.import_module(module), function))


def test_importing_the_package_changes_no_signal_handler():
    code = """
import signal, sys
sys.argv[0] = "automotive-cosim"
heard = {number: signal.getsignal(number) for number in signal.valid_signals()}
import automotive_cosim.cli.main, automotive_cosim.envs, automotive_cosim.traffic.process
print([number for number in heard if signal.getsignal(number) != heard[number]])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_importing_the_package_is_light():
    code = "import automotive_cosim, sys; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "gymnasium" in loaded
    assert not {"libsumo", "shapely", "pyproj", "PIL", "rich", "jinja2"} & set(loaded)


def test_the_image_installs_the_libraries_that_libsumo_requires():
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    assert f"--no-install-recommends {DEBIAN_PACKAGES} " in text
    assert DEBIAN_PACKAGES in (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_citation_names_this_version():
    assert f"\nversion: {automotive_cosim.__version__}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_the_image_and_the_example_name_this_version():
    assert f"image: automotive-cosim:{automotive_cosim.__version__}\n" in (ROOT / "compose.yaml").read_text()
    example = ROOT / "docs/examples/my-agent/.github/workflows/evaluate.yml"
    assert f"/evaluate@v{automotive_cosim.__version__}\n" in example.read_text(encoding="utf-8")


def test_the_first_section_of_the_changelog_is_this_version_and_older_ones_follow():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    sections = [line.removeprefix("## ") for line in text.splitlines() if line.startswith("## ")]
    if sections[0] == "Unreleased":
        del sections[0]
    assert sections[0] == automotive_cosim.__version__
    assert sections == sorted(sections, key=lambda each: [*map(int, each.split("."))], reverse=True)


def test_every_extra_is_explained(project):
    text = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    assert set(project["project"]["optional-dependencies"]) == set(
        re.findall(r"`(\w+)`", "".join(line.split("|")[1] for line in text.splitlines() if line.startswith("| `")))
    )
