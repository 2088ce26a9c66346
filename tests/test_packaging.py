"""What is in the checkout is in the distribution."""

import importlib
import re
import runpy
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

import automotive_cosim
from automotive_cosim import errors
from automotive_cosim.traffic.sumo import DEBIAN_PACKAGES

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def project() -> dict:
    if not (ROOT / "pyproject.toml").is_file():
        pytest.skip("not run from a checkout")
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


@pytest.fixture
def given(monkeypatch) -> dict:
    """What setup.py gives to setuptools."""
    setuptools = pytest.importorskip("setuptools")
    if not (ROOT / "setup.py").is_file():
        pytest.skip("not run from a checkout")
    taken: dict = {}
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(setuptools, "setup", lambda **options: taken.update(options))
    runpy.run_path("setup.py")
    return taken


def test_every_package_is_found(given):
    found = set()
    for name, folder in given["package_dir"].items():
        for marker in (ROOT / folder).rglob("__init__.py"):
            inner = marker.parent.relative_to(ROOT / folder).parts
            if not any((ROOT / folder / Path(*inner[:depth])).is_symlink() for depth in range(1, len(inner) + 1)):
                found.add(".".join((name, *inner)))
    assert found == set(given["packages"])


def test_hints_name_an_extra_as_one_installs_it_from_here(monkeypatch, tmp_path):
    """No index has the package for those who have a checkout; a wheel has no constraints."""
    extra = "reports"
    monkeypatch.setattr(errors, "CHECKOUT", ROOT)
    assert errors.install_hint(extra) == "pip install -c constraints.txt -e '.[reports]'"
    assert errors.install_hint() in (ROOT / "README.md").read_text(encoding="utf-8").replace("python -m ", "")
    monkeypatch.setattr(errors, "CHECKOUT", tmp_path)
    assert errors.install_hint(extra) == "pip install 'automotive-cosim[reports]'"


def test_every_hint_is_made_in_one_place_and_names_an_extra_that_exists(project):
    hints = set()
    for folder in ("automotive_cosim", "agents"):
        for path in (ROOT / folder).rglob("*.py"):
            text = path.read_text(encoding="utf-8")
            assert path.name == "errors.py" or not re.search(r"""["` ]pip install '?automotive-cosim""", text), path
            hints |= set(re.findall(r"""install_hint\(['"](\w+)['"]\)""", text))
    assert hints <= set(project["project"]["optional-dependencies"])
    assert len(hints) > 5


def test_the_links_point_to_the_mapped_folders(given):
    for name, folder in given["package_dir"].items():
        if "." in name:
            assert (ROOT / name.replace(".", "/")).resolve() == (ROOT / folder).resolve()


@pytest.mark.slow
def test_wheel_and_editable_install_do_without_the_links(tmp_path, project, given):
    """As on Windows without the right to make links, where git leaves them as text files."""
    setuptools = pytest.importorskip("setuptools")
    if int(setuptools.__version__.split(".")[0]) < 77:
        pytest.skip(f"setuptools {setuptools.__version__}; pyproject.toml needs 77 or more")
    checkout = tmp_path / "checkout"
    for folder in given["package_dir"].values():
        shutil.copytree(
            ROOT / folder, checkout / folder, symlinks=True, ignore=shutil.ignore_patterns("__pycache__")
        )
    for each in ROOT.glob("*"):
        if each.is_file():
            shutil.copy(each, checkout)
    for link in [each for each in (checkout / "automotive_cosim").iterdir() if each.is_symlink()]:
        target = link.readlink()
        link.unlink()
        link.write_text(target.as_posix(), encoding="utf-8")
    build = "from setuptools import build_meta as made; made.build_wheel('.'); made.build_editable('.')"
    subprocess.run([sys.executable, "-c", build], cwd=checkout, check=True, capture_output=True)
    editable, wheel = sorted(checkout.glob("*.whl"))
    names = set(zipfile.ZipFile(wheel).namelist())
    for name, folder in given["package_dir"].items():
        every = (file for kind in ("py", "toml") for file in (ROOT / folder).rglob(f"*.{kind}"))
        inside = {file.relative_to(ROOT / folder).as_posix() for file in every}
        assert {f"{name.replace('.', '/')}/{file}" for file in inside} <= names
    zipfile.ZipFile(editable).extractall(tmp_path / "site")
    code = f"""
import site, sys
site.addsitedir({str(tmp_path / "site")!r})
sys.path += {[each for each in sys.path if each.endswith("site-packages")]!r}
import automotive_cosim.agents, automotive_cosim.sumo_scenarios, automotive_cosim.tasks
print(*(sys.modules[f"automotive_cosim.{{name}}"].__file__ for name in ("agents", "sumo_scenarios", "tasks")))
"""
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    found = [Path(each).relative_to(checkout).parent.as_posix() for each in done.stdout.split()]
    assert found == ["agents", "sumo_scenarios", "tasks"]


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
    assert not {"gymnasium", "libsumo", "shapely", "pyproj", "PIL", "rich", "jinja2"} & set(loaded)


def test_the_image_installs_the_libraries_that_libsumo_requires():
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    assert f"--no-install-recommends {DEBIAN_PACKAGES} " in text
    assert DEBIAN_PACKAGES in (ROOT / "docs" / "install.md").read_text(encoding="utf-8")


def test_the_citation_names_this_version():
    assert f"\nversion: {automotive_cosim.__version__}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_the_image_and_the_example_name_this_version():
    assert f"image: automotive-cosim:{automotive_cosim.__version__}\n" in (ROOT / "compose.yaml").read_text()
    example = ROOT / "docs/examples/my-agent/.github/workflows/evaluate.yml"
    assert f"/evaluate@v{automotive_cosim.__version__}\n" in example.read_text(encoding="utf-8")


def test_the_changelog_begins_with_this_version_or_the_next_and_older_ones_follow():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    sections = [line.removeprefix("## ") for line in text.splitlines() if line.startswith("## ")]
    if sections[0] == "Unreleased":
        del sections[0]
    assert sections[:1] in ([], [automotive_cosim.__version__])
    assert sections == sorted(sections, key=lambda each: [*map(int, each.split("."))], reverse=True)


def test_every_extra_is_explained(project):
    text = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    assert set(project["project"]["optional-dependencies"]) == set(
        re.findall(r"`(\w+)`", "".join(line.split("|")[1] for line in text.splitlines() if line.startswith("| `")))
    )


def test_harnesses_have_constraints_of_their_own_that_fit_their_extra_and_are_documented(project):
    from packaging.requirements import Requirement

    pinned = {}
    for line in (ROOT / "constraints/harnesses.txt").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            name, _, version = line.partition("==")
            pinned[re.sub(r"[-_.]+", "-", name).lower()] = version
    needed = [*project["project"]["dependencies"], *project["project"]["optional-dependencies"]["harnesses"]]
    for each in map(Requirement, needed):
        if each.marker is None or each.marker.evaluate():
            assert each.specifier.contains(pinned[re.sub(r"[-_.]+", "-", each.name).lower()])
    command = "pip install -c constraints/harnesses.txt -e '.[harnesses]'"
    assert command in (ROOT / "docs" / "doors.md").read_text(encoding="utf-8")
    assert "constraints/harnesses.txt" in (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
