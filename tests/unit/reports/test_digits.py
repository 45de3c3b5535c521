import pytest

from neural_shadows.reports.data.digits import short


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.01234, "0.0123"), (9.996, "10"), (99.96, "100"), (999.6, "1,000"), (-1340.2, "-1,340")],
)
def test_three_digits_and_no_power_of_ten(value, text):
    assert short(value) == text


def test_more_digits():
    assert [short(value, 4) for value in (0.12345, 12345.6)] == ["0.1235", "12,346"]
