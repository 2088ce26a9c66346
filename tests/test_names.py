"""One name, one thing: no two public classes or type aliases of the package share a name."""

import re
from collections import defaultdict
from glob import glob
from pathlib import Path

import automotive_cosim

CLASS_LIKE = "[A-Z][A-Za-z0-9]*[a-z][A-Za-z0-9]*"
DEFINED = re.compile(rf"^[ \t]*class ({CLASS_LIKE})\b|^({CLASS_LIKE})(?::.*)? =(?!=)", re.MULTILINE)
"""Classes, nested ones included, and what a module assigns to a name like a class's."""


def test_no_two_classes_share_a_name():
    places = defaultdict(set)
    (folder,) = automotive_cosim.__path__
    files = glob(f"{folder}/**/*.py", recursive=True)  # noqa: PTH207, which goes through links as well
    for file in files:
        for defined in DEFINED.finditer(Path(file).read_text(encoding="utf-8")):
            places[defined[1] or defined[2]].add(file)
    assert len(files) > 250
    assert len(places) > 400
    assert {name: sorted(found) for name, found in places.items() if len(found) > 1} == {}
