"""Every view lists what it listed; ``goldens`` renews the lists and shows what has changed."""

import pytest

from .goldens import differences, made, stored


@pytest.mark.slow
@pytest.mark.parametrize("part", [5, pytest.param(1, marks=pytest.mark.proof)])
def test_every_view_lists_what_it_listed(part: int) -> None:
    assert "\n".join(differences(stored(part), made(part))) == "", "python -m tests.cockpit.goldens --renew"


def test_a_difference_is_told_under_its_view() -> None:
    known = {"home": ["a", "b"], "map": ["c"], "gone": ["d"]}
    assert list(differences(known, known)) == []
    now = {"home": ["a", "e"], "map": ["c"], "new": ["f"]}
    assert list(differences(known, now)) == ["gone", "  - d", "home", "  - b", "  + e", "new", "  + f"]
    assert list(differences({"home": ["a", "b"]}, {"home": ["b", "a"]})) == ["home", "  in another order"]
