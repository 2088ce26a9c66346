"""Development and test sets: what the rule says, and that nothing else decides."""

import hashlib

from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import Split
from automotive_cosim.tasking.split import split_of, split_of_seed
from automotive_cosim.tasks import CATALOGUE


def test_a_quarter_of_the_seeds_is_test_by_the_stated_hash():
    for seed in range(400):
        first_byte = hashlib.sha256(str(seed).encode()).digest()[0]
        assert (split_of_seed(seed) is Split.TEST) == (first_byte % 4 == 2)
    assert 0.2 < sum(split_of_seed(seed) is Split.TEST for seed in range(4000)) / 4000 < 0.3


def test_the_seeds_of_the_examples_are_development():
    assert {split_of_seed(seed) for seed in (0, 1, 2)} == {Split.DEV}


def test_an_episode_is_development_only_if_seed_and_phrasing_are():
    for task in list(CATALOGUE.values())[::9]:
        for seed in range(12):
            held_out = draw(task, "first", seed).held_out
            is_dev = not held_out and split_of_seed(seed) is Split.DEV
            assert split_of(task, seed) is (Split.DEV if is_dev else Split.TEST)
            assert split_of(task, seed, held_out=True) is Split.TEST
