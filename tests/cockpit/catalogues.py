"""The catalogues of texts, held against the texts in the code.

python -m tests.cockpit.catalogues            # what is missing, unused or untranslated, language by language
python -m tests.cockpit.catalogues --renew    # adds what is missing, untranslated, and drops what is unused
"""

import sys
from collections.abc import Iterator, Sequence
from io import SEEK_END, BytesIO
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.extract import extract_from_dir
from babel.messages.pofile import read_po, write_po

import automotive_cosim

ROOT = Path(automotive_cosim.__file__).parent
PACKAGES = ("contracts", "cockpit", "interface", "traffic")
"""Where the texts of the screens are written."""
FOLDER = ROOT / "cockpit" / "languages"
KEYWORDS = {"say": None, "say_in": ((1, "c"), 2), "counted": (1, 2)}
"""The functions of ``contracts.text`` and which of their arguments is what."""
HEADERS = ("Language", "Plural-Forms", "MIME-Version", "Content-Type", "Content-Transfer-Encoding")

Key = tuple[tuple[str, ...], str | None]
"""A message, or its singular and plural; and its context."""


def written() -> Catalog:
    """The messages in the code and the files they stand in."""
    found = Catalog()
    for package in PACKAGES:
        for name, _, message, _, context in extract_from_dir(
            ROOT / package, [("**.py", "python")], keywords=KEYWORDS
        ):
            found.add(message, locations=[(f"{package}/{name}", 0)], context=context)
    return found


def known(language: str) -> Catalog:
    """The catalogue of a language, as it is stored."""
    with (FOLDER / f"{language}.po").open("rb") as file:
        return read_po(file, locale=language)


def keys(catalogue: Catalog) -> set[Key]:
    """Its messages, without the header."""
    return {(strings(message.id), message.context) for message in catalogue if message.id}


def renewed(language: str, now: Catalog) -> Catalog:
    """The stored catalogue with the messages of the code, and no others."""
    stored = known(language)
    stored.update(now, no_fuzzy_matching=True)
    stored.obsolete.clear()
    return stored


def text(catalogue: Catalog) -> bytes:
    """The file of a catalogue: by message, without dates and line numbers, so that only what changes is new."""
    header = "".join(f'"{name}: {dict(catalogue.mime_headers)[name]}\\n"\n' for name in HEADERS)
    file = BytesIO(f'msgid ""\nmsgstr ""\n{header}\n'.encode())
    file.seek(0, SEEK_END)
    write_po(file, catalogue, width=0, sort_output=True, include_lineno=False, omit_header=True)
    return file.getvalue()


def differences(language: str, now: Catalog) -> Iterator[str]:
    """What a catalogue lacks (-), has in vain (+) or does not translate (?)."""
    stored = known(language)
    yield from (f"{language} - {key}" for key in sorted(map(repr, keys(now) - keys(stored))))
    yield from (f"{language} + {key}" for key in sorted(map(repr, keys(stored) - keys(now))))
    yield from (f"{language} ? {message.id!r}" for message in stored if not all(strings(message.string)))


def strings(given: str | Sequence[str] | None) -> tuple[str, ...]:
    """The forms of a message or its translation: one, or one for each plural."""
    return (given or "",) if isinstance(given, str | None) else tuple(given)


def languages() -> tuple[str, ...]:
    """The languages that have a catalogue."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.po")))


if __name__ == "__main__":
    now = written()
    if "--renew" in sys.argv:
        for language in languages():
            (FOLDER / f"{language}.po").write_bytes(text(renewed(language, now)))
    for language in languages():
        sys.stdout.writelines(f"{line}\n" for line in differences(language, now))
