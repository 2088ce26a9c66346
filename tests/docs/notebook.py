"""``docs/examples/first_pair.ipynb`` is made from the script beside it, whose cells begin with ``# %%``.

python -m tests.docs.notebook --renew
"""

import argparse
import json
import re
from collections.abc import Iterator
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "docs/examples/first_pair.py"
NOTEBOOK = SCRIPT.with_suffix(".ipynb")


def cells() -> Iterator[tuple[bool, str]]:
    """Whether each cell is code, and its text."""
    marks = re.split(r"^# %%(.*)\n", SCRIPT.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
    for kind, text in zip(marks[::2], marks[1::2], strict=True):
        is_code = "markdown" not in kind
        yield is_code, text.strip("\n") if is_code else re.sub(r"^# ?", "", text.strip("\n"), flags=re.MULTILINE)


def made() -> str:
    """The notebook as JSON, without output."""
    told = [
        {"cell_type": "code", "id": f"cell-{number}", "metadata": {}, "execution_count": None, "outputs": []}
        if is_code
        else {"cell_type": "markdown", "id": f"cell-{number}", "metadata": {}}
        for number, (is_code, _) in enumerate(cells())
    ]
    for cell, (_, text) in zip(told, cells(), strict=True):
        cell["source"] = text.splitlines(keepends=True)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    whole = {"cells": told, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(whole, indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--renew", action="store_true", help="write the notebook")
    if parser.parse_args().renew:
        NOTEBOOK.write_text(made(), encoding="utf-8")
    else:
        print("the notebook", "is that of the script" if NOTEBOOK.read_text("utf-8") == made() else "is stale")
