#!/bin/bash
# Seen with euroncap-rating-2026 5.4.9 (Euro NCAP's calculator): in the sheet of speed limits by country, the values
# alone do not say what is claimed. Where the template is as it comes, an empty cell is grey and fails its row; the same
# empty cell without a fill counts as "no such limit in that country", and the row passes. A workbook that is written
# anew from its values (pandas, CSV) therefore is not the one that was read. One would expect empty to mean one thing.
# Seen, with every cell of the column Green but one country's, which is left empty:
#   grey, as it comes: FAIL
#   no fill: PASS
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q euroncap-rating-2026==5.4.9
cat > seen.py <<'P'
import subprocess, sys
from openpyxl import load_workbook
from openpyxl.styles import PatternFill

def run(*words):
    command = [sys.executable, "-m", "euroncap_rating_2026", "safe_driving", *words]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

for name, fill in (("grey, as it comes", None), ("no fill", PatternFill())):
    run("generate-template")
    book = load_workbook("sd_template.xlsx")
    sheet = book["VA - Speed assist. pred."]
    for row in range(3, 32):
        sheet.cell(row, 3).value = "Green"
    sheet["C4"].value = None
    sheet["C4"].fill = fill or sheet["C4"].fill.copy()
    book.save("sd_template.xlsx")
    run("preprocess", "-i", "sd_template.xlsx")
    print(f"{name}:", load_workbook("sd_preprocessed_template.xlsx")["VA - Speed assist. verif."]["C5"].value)
P
v/bin/python -W ignore seen.py | tee seen.txt
printf 'grey, as it comes: FAIL\nno fill: PASS\n' | diff - seen.txt
