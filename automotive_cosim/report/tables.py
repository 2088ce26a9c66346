"""Tables that know the episodes behind each figure, for Markdown, CSV, LaTeX and the page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from automotive_cosim.formats.csvs import csv_text


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table, and the episodes behind it."""

    text: str
    episodes: tuple[str, ...] = ()
    """Ids of the episodes behind it."""

    def __str__(self) -> str:
        return self.text


TableRow = tuple[Cell | str, ...]
TableRecord = Mapping[str, Cell | str]
"""A row by the headings of its cells."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table; the first ``heads`` columns name the row."""

    name: str
    """Base name of its files."""
    title: str
    columns: tuple[str, ...]
    rows: tuple[TableRow, ...]
    note: str = ""
    heads: int = 1

    def __post_init__(self) -> None:
        if any(len(row) != len(self.columns) for row in self.rows):
            raise ValueError(f"table {self.name!r} has a row that is not {len(self.columns)} wide")

    @classmethod
    def of(cls, name: str, title: str, records: Iterable[TableRecord], note: str = "", heads: int = 1) -> Table:
        """A table of rows that have the same headings; without a row it has no column either."""
        rows = list(records)
        return cls(
            name, title, tuple(rows[0]) if rows else (), tuple(tuple(row.values()) for row in rows), note, heads
        )

    def markdown(self) -> str:
        """The table in Markdown, under its title."""
        lines = [_md(self.columns), _md(["---"] * self.heads + ["---:"] * (len(self.columns) - self.heads))]
        lines += [_md([str(cell) for cell in row]) for row in self.rows]
        return f"**{self.title}**\n\n" + "\n".join(lines) + (f"\n\n{self.note}" if self.note else "") + "\n"

    def records(self) -> list[dict[str, str]]:
        """The rows by the names of the columns, for JSON."""
        return [dict(zip(self.columns, map(str, row), strict=True)) for row in self.rows]

    def csv(self) -> str:
        """Comma-separated values, the columns' names first."""
        return csv_text(self.columns, ([str(cell) for cell in row] for row in self.rows))

    def latex(self) -> str:
        """A LaTeX table for the booktabs package."""
        columns = "l" * self.heads + "r" * (len(self.columns) - self.heads)
        lines = [_tex(self.columns), r"\midrule", *(_tex([str(cell) for cell in row]) for row in self.rows)]
        return "\n".join(
            [
                r"\begin{table}",
                r"\centering",
                rf"\begin{{tabular}}{{{columns}}}",
                r"\toprule",
                *lines,
                r"\bottomrule",
                r"\end{tabular}",
                rf"\caption{{{_escaped(f'{self.title}. {self.note}'.strip())}}}",
                r"\end{table}",
                "",
            ]
        )


def _md(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def _tex(cells: Sequence[str]) -> str:
    return " & ".join(map(_escaped, cells)) + r" \\"


SPECIAL = {character: "\\" + character for character in "&%$#_{}"} | {
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "\\": r"\textbackslash{}",
    "−": "$-$",
    "–": "--",
    "…": r"\dots{}",
    "“": "``",
    "”": "''",
}


def _escaped(text: str) -> str:
    return "".join(SPECIAL.get(character, character) for character in text)
