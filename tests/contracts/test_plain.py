"""Numbers in texts, as people write them."""

import pytest

from automotive_cosim.contracts.plain import rounded


@pytest.mark.parametrize(
    ("value", "digits", "told"),
    [
        (340.0, 2, "340"),
        (1234567.0, 3, "1,230,000"),
        (0.000123, 2, "0.00012"),
        (-0.5, 3, "-0.5"),
        (99.96, 3, "100"),
        (10.0, 3, "10"),
        (0.0, 3, "0"),
        (4.25, 2, "4.2"),
    ],
)
def test_a_number_has_its_digits_and_no_power_of_ten(value: float, digits: int, told: str) -> None:
    assert rounded(value, digits) == told
