"""Finds the packages; everything else about the distribution stands in ``pyproject.toml``.

``tasks``, ``agents`` and ``sumo_scenarios`` stand at the top of the checkout, where people look, but belong
to the package: a top-level ``agents`` would collide with other distributions. ``automotive_cosim/`` holds links to
them for what reads a checkout without installing it, such as mypy, pyright and import-linter. Where git leaves the
links as text files, as on Windows without the right to make links, wheels and editable installs are the same.
"""

from setuptools import find_packages, setup

FOLDERS = {
    "automotive_cosim": "automotive_cosim",
    "automotive_cosim.agents": "agents",
    "automotive_cosim.sumo_scenarios": "sumo_scenarios",
    "automotive_cosim.tasks": "tasks",
}
"""Where the packages stand that contain all others."""

setup(
    package_dir=FOLDERS,
    packages=sorted(
        {*FOLDERS, *(f"{name}.{inner}" for name, folder in FOLDERS.items() for inner in find_packages(folder))}
    ),
)
