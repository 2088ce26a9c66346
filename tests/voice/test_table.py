"""What was heard of what drivers say: the table that ships, and how it is made."""

import lzma
import re

import numpy as np
import pytest

from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.proof import heard as program
from automotive_cosim.tasking.dialogue import LOOK_FIRST
from automotive_cosim.voice import engines, table

LONG = "Keep watch while I drive. " * 20


def test_the_table_has_nearly_all_that_is_said_at_the_first_seed_and_is_small():
    """A new phrasing is said when it is needed, until somebody with the extra renews the table."""
    assert len(program.missing(1)) < len(table.read()) / 20
    assert table.TABLE.stat().st_size <= 400_000


def test_more_noise_takes_more_words():
    shipped = table.read()
    counted = [[table.word_errors(said, row[at]) for said, row in shipped.items()] for at in range(5)]
    errors = [sum(wrong for wrong, _ in each) / sum(words for _, words in each) for each in counted]
    assert errors == sorted(errors)
    assert errors[0] < 0.25
    assert errors[-1] > 0.6


def test_word_errors_are_counted():
    assert table.word_errors("Set the fan to 50.", "set a fan, to fifty now") == (3, 5)
    assert table.word_errors("Left rear", "") == (2, 2)


def test_a_text_is_heard_in_pieces_and_where_it_comes_from_is_not_misheard():
    said = f"From the rear left seat: Left rear, unlock, thanks. {LOOK_FIRST}"
    assert list(table.pieces(said)) == ["Left rear, unlock, thanks.", LOOK_FIRST]
    assert " ".join(table.pieces(LONG)) == LONG.strip()
    assert all(len(piece.split()) <= table.MOST_WORDS for piece in table.pieces(LONG))
    known = next(text for text, row in table.read().items() if not row[-1])
    assert table.heard(f"From the passenger seat: {known}", -30.0) == f"From the passenger seat: {table.NOTHING}"


def test_the_voice_says_units_as_people_do_and_the_table_has_nothing_spelt():
    """Piper would say "kay em slash aitch", "sigh" and "twenty-two thousand eight hundred"."""
    assert engines.aloud("Limit 30 km/h, A/C off at 08:00, tyres in psi; dial 22 814.") == (
        "Limit 30 kilometres an hour, AC off at 8 o'clock, tyres in P S I; dial 2 2 8 1 4."
    )
    assert engines.aloud("100 m at 14:00, 12 kWh/100 km, at 7:30 pm") == (
        "100 metres at 14 hundred, 12 kilowatt hours per 100 kilometres, at 7:30 pm"
    )
    shipped = table.read()
    assert not [said for said in shipped if re.search(r"/|\bpsi\b|\d (km|m|h)\b|:00", engines.aloud(said))]
    assert not [row[0] for row in shipped.values() if re.search(r"\b(slash|sigh)\b", row[0])]


def test_the_nearest_level_counts():
    said, row = next((text, row) for text, row in table.read().items() if len(set(row)) == len(row) and all(row))
    at = {40.0: 0, 8.0: 0, 7.0: 1, 1.0: 2, -4.0: 3, -60.0: 4}
    assert {snr: table.heard(said, snr) for snr in at} == {snr: row[column] for snr, column in at.items()}


def test_words_that_nobody_has_said_are_one_line(monkeypatch):
    monkeypatch.setattr(engines, "_module", lambda name: engines_missing(name))
    with pytest.raises(
        InfrastructureError, match=r"does not have 'Ah\.'; pip install .*voice.* another seed, or --hear text$"
    ):
        table.heard("Ah.", 0.0)


def engines_missing(name):
    raise engines.SetupError(f"{name} is not installed")


def test_what_is_no_table_and_what_is_no_sound_are_one_line(tmp_path):
    path = tmp_path / "own.json.xz"
    for content in (b"", b"{}", lzma.compress(b"[]"), lzma.compress(b'{"levels_db": [1], "heard": {}}')):
        path.write_bytes(content)
        with pytest.raises(UserError, match=r"^own\.json\.xz .*make it anew"):
            table.read(path)
    good = engines.as_wav(np.zeros(1600, np.float32))
    assert len(engines.from_wav(good, "good.wav")) == 1600
    for content in (b"", b"RIFF", good[:40], good[:20]):
        with pytest.raises(UserError, match=r"^bad\.wav .*16 bits"):
            engines.from_wav(content, "bad.wav")


def test_the_noise_is_as_loud_as_it_should_be_and_the_same_each_time():
    words = np.sin(np.arange(16_000) * 0.3).astype(np.float32)
    clean = engines.in_cabin(words, None, "a")
    noisy = engines.in_cabin(words, 0.0, "a")
    assert np.array_equal(noisy, engines.in_cabin(words, 0.0, "a"))
    assert not np.array_equal(noisy, engines.in_cabin(words, 0.0, "b"))
    # What is left when the words are taken away, in their own scale, is as loud as they are while they last.
    gain = np.dot(noisy, clean) / np.dot(clean, clean)
    last = slice(round(engines.MARGIN_S * engines.RATE_HZ), -round(engines.MARGIN_S * engines.RATE_HZ))
    rest_db, words_db = engines._level_db(noisy / gain - clean), engines._level_db(clean[last])
    assert rest_db == pytest.approx(words_db, abs=0.5)


@pytest.mark.proof
@pytest.mark.skipif(not engines.is_installed(), reason="the extra voice is not installed")
def test_the_engines_hear_what_the_table_says():
    """Word for word on the kind of processor that made it; on another, sums are rounded in another order."""
    shipped = table.read()
    here = dict(table.recognise(sorted(shipped)[::90]))
    same = [one == other for text, row in here.items() for one, other in zip(row, shipped[text], strict=True)]
    assert sum(same) >= 0.6 * len(same)
    assert here == dict(table.recognise(list(here)))


def test_a_damaged_voice_or_recogniser_is_one_line_and_costs_one_trial(monkeypatch, tmp_path):
    class _Broken:
        """Stands for every package of the extra."""

        @staticmethod
        def model_path():
            return tmp_path / "none.onnx"

        get_model_path = model_path

        @staticmethod
        def WhisperModel(*where, **how):  # noqa: N802, its name
            raise RuntimeError("Unable to open file\nmodel.bin")

    monkeypatch.setattr(engines, "_module", lambda name: _Broken)
    engines._recogniser.cache_clear()
    with pytest.raises(InfrastructureError, match=r"^the voice said 0 of 1 sentences: "):
        table.heard("Nobody has said this yet.", 0.0)
    with pytest.raises(InfrastructureError, match=r"^the voice said 0 of 1 sentences: "):
        table.sounding("Nobody has said this yet.", 1.5)
    monkeypatch.setattr(engines, "said", lambda texts: [np.ones(1600, np.float32) for _ in texts])
    with pytest.raises(
        InfrastructureError, match=r"^the recogniser .* cannot be loaded \(Unable to open file model\.bin"
    ):
        table.heard("Nobody has said this yet.", 0.0)
