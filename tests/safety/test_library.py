"""The library of logical scenarios."""

from pathlib import Path

import pytest

from automotive_cosim.drives.events import KINDS
from automotive_cosim.errors import UserError
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.trial import Limits
from automotive_cosim.safety.space import LIBRARY, FactorChoices, FactorRange, read_space, space_file
from automotive_cosim.safety.trying import trial_of
from tests.laws import over


def test_there_are_thirty() -> None:
    assert len(LIBRARY) >= 30


@over(LIBRARY)
def test_every_space_can_be_searched(name: str) -> None:
    space = read_space(space_file(name))
    assert space.about.endswith(".")
    assert space.sources
    assert space.rule.events
    assert set(space.rule.events) <= KINDS.keys()
    assert any(
        (isinstance(each, FactorRange) and each.name != "seed") or len(each.levels) > 1 for each in space.factors
    )
    staged = space.factor("stage").nominal if any(each.name == "stage" for each in space.factors) else ""
    assert staged
    for factor in space.factors:
        ends = factor.values if isinstance(factor, FactorChoices) else (factor.least, factor.most, factor.nominal)
        for value in ends:
            job = trial_of({**space.nominal, factor.name: value}).job("silent", "none", 0, Limits(), ())
            assert isinstance(job, DriveSetup)
            assert job.script.staged == () or staged != "nothing"


def test_neither_a_file_nor_a_name_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="did you mean 'cut-in'"):
        space_file("cutin")
    with pytest.raises(UserError, match=r"there is no file mine\.toml"):
        space_file("mine.toml")


def test_the_guides_first_search_is_of_events_that_its_staging_makes_due() -> None:
    import re
    import tomllib
    from pathlib import Path

    import automotive_cosim.safety

    guide = Path(__file__).parents[2] / "docs/failures.md"
    name = re.findall(r"search --space (\S+)", guide.read_text("utf-8"))[0]
    file = Path(automotive_cosim.safety.__file__).parent / "spaces" / f"{name}.toml"
    space = tomllib.loads(file.read_text("utf-8"))
    assert space["factors"]["stage"] in space["failure"]["events"]
