"""What the code says of itself on these pages: ``python -m docs.tables`` writes it anew, between its marks.

A test holds it equal to the code, so a page reads the same in a checkout and on the site.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from enum import Enum
from pathlib import Path
from tempfile import TemporaryDirectory

from typer.testing import CliRunner

from automotive_cosim import schemas
from automotive_cosim.agents import FORMATS
from automotive_cosim.cli.main import app
from automotive_cosim.drives.changes import WAKES
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.exchange.catalogs import CARRIED, DIFFERENT, REFUSED, table
from automotive_cosim.formats.bounds import READERS
from automotive_cosim.formats.docs import field_docs, member_docs
from automotive_cosim.interface import spaces
from automotive_cosim.interface.house_rules import HOUSE
from automotive_cosim.models.gguf import KNOWN
from automotive_cosim.publish.leaderboard import board
from automotive_cosim.report.summary import DIMENSIONS
from automotive_cosim.report.tables import Table
from automotive_cosim.run import difficulty
from automotive_cosim.safety.protocol.evidence import protocol
from automotive_cosim.safety.space import LIBRARY, read_space
from automotive_cosim.voice import cabin
from automotive_cosim.voice.engines import aloud
from automotive_cosim.voice.table import LEVELS_DB, read, word_errors

DOCS = Path(__file__).parent
MARKED = re.compile(r"(<!-- (\w+), made by `python -m docs\.tables` -->\n\n).*?(\n\n<!-- end -->)", re.DOTALL)
"""A table of a page: its mark with its name, the table, the mark of its end."""
FRAMEWORK = DOCS / "examples" / "frameworks" / "openai_agents.py"
HIDDEN = (
    "Input", "Clock", "Latency", "Sees", "Feedback", "Screen", "Language", "Make", "Order", "Hears", "Policy",
    "Attention", *DIMENSIONS.values(),
)  # fmt: skip
"""Columns of the leaderboard that its page here leaves out."""


def main() -> None:
    """Writes every table of every page anew; prints the pages that changed."""
    for page in pages():
        text = page.read_text(encoding="utf-8")
        if (renewed := MARKED.sub(_filled, text)) != text:
            page.write_text(renewed, encoding="utf-8")
            print(page)


def pages() -> list[Path]:
    """The pages that have tables."""
    return [page for page in sorted(DOCS.glob("**/*.md")) if MARKED.search(page.read_text(encoding="utf-8"))]


def stale(page: Path) -> list[str]:
    """The tables of a page that are not what the code says."""
    found = MARKED.finditer(page.read_text(encoding="utf-8"))
    return [mark[2] for mark in found if _filled(mark) != mark[0]]


def printed(*arguments: str) -> str:
    """What a command prints. Raises RuntimeError: it fails."""
    ran = CliRunner().invoke(app, arguments, catch_exceptions=False)
    if ran.exit_code:
        raise RuntimeError(f"automotive-cosim {' '.join(arguments)} ended with code {ran.exit_code}: {ran.output}")
    return ran.output.rstrip()


def _filled(mark: re.Match[str]) -> str:
    return mark[1] + MADE[mark[2]]().strip() + mark[3]


def _table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    lines = (heads, ["---"] * len(heads), *rows)
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def _conditions() -> str:
    """Each condition, with what its values mean."""
    rows: list[tuple[str, str, str]] = []
    for each in TABLE:
        kind = type(each.default)
        docs = member_docs(kind) if issubclass(kind, Enum) else {}
        told = [f"`{kind[name]}`: {text}" if text else f"`{kind[name]}`" for name, text in docs.items()]
        rows.append((f"`--{each.word}`", each.help, "<br>".join(told) or f"`{each.default}` and up"))
    return _table(("option", "what it is about", "values, the usual one first"), rows)


def _families() -> str:
    return _table(
        ("family", "season", "what it is"),
        [(f"`{each.id}`", each.season, each.about) for each in FAMILIES.values()],
    )


def _kinds() -> str:
    heads = "kind", "the event", "told by", "neutral: true, but not due", "its look-alike", "times"
    rows = [
        (
            each.name,
            each.about,
            ", ".join(f"`{name}`" for name in each.told_by),
            each.neutral,
            each.lookalike,
            each.source,
            f"{each.lasts_s:.0f} s",
            f"{each.weight:g}",
            ", ".join(sorted(each.alerts))
            or ("none: the state counts" if each.by_state else "words, or the switch"),
        )
        for each in KINDS.values()
    ]
    return _table((*heads, "prepares", "weight", "alerts"), rows)


def _leaderboard() -> str:
    """The tables of all bundles in the repository. Raises RuntimeError: a bundle has a problem."""
    with TemporaryDirectory() as scratch:
        made = board(DOCS / "leaderboard" / "bundles", Path(scratch) / "board.html")
    if made.left_out:
        raise RuntimeError(f"docs/leaderboard/bundles: {'; '.join(made.left_out)}")
    parts: list[str] = []
    for places, conditions, _ in made.tables:
        parts.append(f"{conditions.tasks}, {conditions.scenarios}, seed {conditions.seeds}, {conditions.limits}:")
        parts.append(_shown(places))
    for places in made.drives:
        parts += f"{places.title}:", _shown(places)
    return "\n\n".join((*parts, "What models got wrong, with an episode of each kind:", _shown(made.lost)))


def _shown(table: Table) -> str:
    shown = [place for place, head in enumerate(table.columns) if head not in HIDDEN]
    return _table(
        [table.columns[place] for place in shown], [[row[place] for place in shown] for row in table.rows]
    )


def _fields(name: str) -> str:
    """The fields of a file format, a table for each of its parts, from its JSON Schema."""
    schema = json.loads(schemas.text(name))
    parts: list[str] = []
    for about, part in (("", schema), *((each["description"], each) for each in schema["$defs"].values())):
        fields = {field: each for field, each in part["properties"].items() if field != "kind"}
        if "kind" in part["properties"]:
            about = f'**`kind = "{part["properties"]["kind"]["const"]}"`** {about}'
        rows: list[tuple[str, str, str]] = []
        for field, each in fields.items():
            value = each.get("default")
            default = "" if value in (None, "") or isinstance(value, dict) else f"`{json.dumps(value)}`"
            rows.append((f"`{field}`", default, each.get("description", "")))
        parts += [about, _table(("field", "default", "meaning"), rows)] if rows else [about]
    return "\n\n".join(parts)


def _contestants() -> str:
    """Who has tried the halves that are on record as they are now."""
    known = [
        each.outcomes.won
        for name, each in difficulty.shipped().halves.items()
        if difficulty.measured(*name.split("/"))
    ]
    rows = []
    for name, ability in sorted(difficulty.shipped().abilities.items(), key=lambda each: -each[1]):
        outcomes = [won[name] for won in known if name in won]
        won, tried = sum(each[0] for each in outcomes), sum(each[1] for each in outcomes)
        rows.append((name, f"{won:,} of {tried:,}", f"{ability:+.1f}"))
    return _table(("Contestant", "Halves won", "Ability in logits"), rows)


def _heard() -> str:
    """Word errors of the shipped table by the ratio of words to noise."""
    rows = []
    for at, level in enumerate(LEVELS_DB):
        counted = [word_errors(aloud(said), row[at]) for said, row in read().items()]
        wrong, words = (sum(each[part] for each in counted) for part in (0, 1))
        whole = sum(each[0] == 0 for each in counted)
        ratio = "without noise" if level is None else f"{level:g} dB"
        rows.append((ratio, f"{wrong / words:.0%}", f"{whole / len(counted):.0%}"))
    return _table(("words above noise", "word errors", "without any error"), rows)


def _openscenario() -> str:
    """Each element of OpenSCENARIO XML with what the import makes of its attributes and parts."""
    rows: list[tuple[str, ...]] = []
    for tag, row in table().items():
        by_word: dict[str, list[str]] = {CARRIED: [], DIFFERENT: [], REFUSED: []}
        for name, word, difference in row.told():
            told = f" ({difference})" if difference else ""
            by_word[word].append(f"`{name}`{told}")
        rows.append((f"`{tag}`", *("; ".join(each) for each in by_word.values())))
    return _table(("element", CARRIED, DIFFERENT, REFUSED), sorted(rows))


MADE: Mapping[str, Callable[[], str]] = {
    "conditions": _conditions,
    "cabin": lambda: (cabin.__doc__ or "").partition("\n\n")[2],
    "contestants": _contestants,
    "families": _families,
    "framework": lambda: f"```python\n{FRAMEWORK.read_text(encoding='utf-8').strip()}\n```",
    "functions": lambda: f"```text\n{printed('show', 'functions')}\n```",
    "heard": _heard,
    "kinds": _kinds,
    "known_files": lambda: _table(
        ("model", "maker", "SHA-256 of the file"),
        [(each.model, each.maker, f"`{name}`") for name, each in KNOWN.items()],
    ),
    "leaderboard": _leaderboard,
    "native_formats": lambda: _table(
        ("`format`", "models", "coordinates", "declines with"),
        [(f"`{name}`", each.models, each.grid.told, each.declines) for name, each in FORMATS.items()],
    ),
    "openscenario": _openscenario,
    "plan": lambda: _fields("plan"),
    "policy": lambda: _table(
        ("rule", "words", "source"), [(f"`{each.id}`", each.words, each.source) for each in HOUSE]
    ),
    "scenario": lambda: _fields("scenario"),
    "protocol": lambda: _table(
        ("row", "tasks", "drives", "stage on any network", "not shown"),
        [
            (
                row.name,
                *(", ".join(f"`{name}`" for name in names) for names in (row.tasks, row.drives, row.stages)),
                row.lacks,
            )
            for row in protocol("euroncap-2026").rows
            if row.part in ("limits", "hazards")
        ],
    ),
    "readers": lambda: _table(
        ("file", "read by", "bound"), [(each.what, f"`{each.where}`", each.bound) for each in READERS]
    ),
    "settings": lambda: _table(
        ("factor of drives", "value"), [(f"`{name}`", about) for name, about in field_docs(DriveSettings).items()]
    ),
    "situations": lambda: _table(
        ("scenario", "what happens"), [(f"`{name}`", read_space(path).about) for name, path in LIBRARY.items()]
    ),
    "spaces": lambda: (spaces.__doc__ or "").replace("``", "`"),
    "wakes": lambda: _table(("change", "when"), [(each.name, each.about) for each in WAKES]),
}
"""What makes each table."""


if __name__ == "__main__":
    main()
