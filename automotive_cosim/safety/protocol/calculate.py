"""Fills in the calculator's workbook and has it scored.

Runs under the Python that the calculator is installed for, as a program of its own that knows nothing of this
package: values come as JSON on standard input, points go out so.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from importlib import import_module
from importlib.metadata import distribution
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

PREDICTIONS, VERIFIED, CONTROLS = "VA - Speed assist. pred.", "VA - Speed assist. verif.", "DE - GVC verif."
SCORES = {"Category Scores": 3, "Scenario Scores": 4}
"""Sheets of the report, and the column of the names; their points and the most there are stand in the next two."""


def installed(package: str) -> dict[str, Any]:
    """The version, and one hash over the code and the template, by path, whatever installed them."""
    found = distribution(package)
    kept = sorted(
        (str(each), Path(str(found.locate_file(each))))
        for each in found.files or ()
        if str(each).endswith(".py") or each.name == "sd_template.xlsx"
    )
    digest = hashlib.sha256(b"".join(name.encode() + b"\0" + path.read_bytes() for name, path in kept))
    return {"version": found.version, "sha256": digest.hexdigest()}


def scored(values: dict[str, Any]) -> dict[str, list[float]]:
    """Points and the most there are, by the name of a scenario or category, of what the calculator assessed."""
    openpyxl: Any = import_module("openpyxl")

    def run(*arguments: str) -> None:
        command = [sys.executable, "-m", "euroncap_rating_2026", "safe_driving", *arguments]
        subprocess.run(command, check=True, cwd=folder, stdout=subprocess.DEVNULL)

    with TemporaryDirectory() as home:
        folder = Path(home)
        run("generate-template")
        book = openpyxl.load_workbook(path := folder / "sd_template.xlsx")
        _predict(book[PREDICTIONS], values)
        book.save(path)
        run("preprocess", "-i", path.name)
        book = openpyxl.load_workbook(path := folder / "sd_preprocessed_template.xlsx")
        for sheet in (VERIFIED, CONTROLS):
            for row in book[sheet].iter_rows(min_row=2):
                name = row[1].value or row[0].value
                if name in values["verified"]:
                    row[2].value = "PASS" if values["verified"][name] else "FAIL"
        book.save(path)
        run("compute-score", "-i", path.name)
        book = openpyxl.load_workbook(next(folder.glob("*_report.xlsx")))
        return {
            str(row[at]): [float(row[at + 1]), float(row[at + 2])]
            for sheet, at in SCORES.items()
            for row in book[sheet].iter_rows(min_row=2, values_only=True)
            if row[at] and isinstance(row[at + 1], int | float)
        }


def _predict(sheet: Any, values: dict[str, Any]) -> None:
    """Colours each country and kind of limit that the sheet has, and each hazard of which the car is told."""
    areas = [area for each in sheet.data_validations.dataValidation for area in str(each.sqref).split()]
    cells = {cell.coordinate for area in areas for row in _rows(sheet, area) for cell in row}
    columns = {sheet.cell(2, number).value: number for number in range(3, 15)}
    for row in range(3, 32):
        for name, number in columns.items():
            cell = sheet.cell(row, number)
            if cell.coordinate in cells:
                holds = values["limits"].get(name, {}).get(sheet.cell(row, 2).value, values["untried"])
                cell.value = "Green" if holds else "Red"
    for number in range(3, 13):
        holds = values["hazards"].get(sheet.cell(33, number).value, values["untried"])
        sheet.cell(35, number).value = "Green" if holds else "Red"


def _rows(sheet: Any, area: str) -> Any:
    found = sheet[area]
    return found if isinstance(found, tuple) else ((found,),)


if __name__ == "__main__":
    given = json.load(sys.stdin)
    about = installed(given["package"])
    if given["wanted"] == about:
        about["points"] = [scored(each) for each in given["values"]]
    json.dump(about, sys.stdout)
