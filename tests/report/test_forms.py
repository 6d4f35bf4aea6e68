"""Numbers are written with the digits, signs, powers and units that they have."""

import pytest

from report.forms import count, decade, degrees, percent, seconds, signed_percent, significant, times, unit


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        (significant(0.0), "0"),
        (significant(0.0996), "0.10"),
        (significant(1033.01, 4), "1033"),
        (significant(3.21e-5), "3.2 × 10⁻⁵"),
        (significant(1.4574e10, 3), "1.46 × 10¹⁰"),
        (decade(2e-4), "2 × 10⁻⁴"),
        (decade(0.1), "10⁻¹"),
        (percent(0.0053026), "0.53 %"),
        (percent(-5.6e-6), "−5.6 × 10⁻⁶"),
        (percent(4.3204), "432 %"),
        (signed_percent(0.91), "+91 %"),
        (times(26.18), "26 ×"),
        (count(863), "863"),
        (count(1000000), "1 000 000"),
        (seconds(0.021314), "21 ms"),
        (seconds(7.3e-5), "73 µs"),
        (seconds(5e-9), "5.0 ns"),
        (degrees(1.57079632679), "90°"),
        (unit("GPa", 3, 1e-9)(206e9), "206 GPa"),
    ],
)
def test_number_is_written_as_it_should(written, expected):
    """Digits, minus signs, powers of ten and units come out as a reader expects them."""
    assert written.replace("\u00a0", " ").replace("\u202f", " ") == expected


def test_part_of_a_whole_is_no_count():
    """What is counted is whole."""
    with pytest.raises(ValueError, match=r"2\.5 is not a whole number"):
        count(2.5)
