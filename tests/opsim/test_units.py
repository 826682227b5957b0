import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.units import UNITS, UnitError, parse, written


@pytest.mark.parametrize(
    ("text", "kind", "si"),
    [
        ("45 s", "time", 45.0),
        ("45s", "time", 45.0),
        (" 1.5 h ", "time", 5400.0),
        ("1 min 30 s", "time", 90.0),
        ("1h30min", "time", 5400.0),
        ("250 ms", "time", 0.25),
        ("2 d", "time", 172800.0),
        ("00:45:00", "time", 2700.0),
        ("8:00:00.5", "time", 28800.5),
        ("1e3 s", "time", 1000.0),
        (".5 s", "time", 0.5),
        ("-2 m", "length", -2.0),
        ("5 ft 11 in", "length", 1.8034),
        ("80 cm", "length", 0.8),
        ("4.5 km/h", "speed", 1.25),
        ("60 m/min", "speed", 1.0),
        ("600 g", "mass", 0.6),
        ("180 deg", "angle", math.pi),
        ("0.2 rad", "angle", 0.2),
        ("1.1 h", "time", 3960.0),  # 1.1 * 3600 in floats is 3960.0000000000005
    ],
)
def test_a_quantity_is_read_to_the_nearest_float(text, kind, si):
    assert parse(text, kind) == si


@pytest.mark.parametrize(
    ("value", "kind", "said"),
    [
        (30, "time", "30 has no unit; expected a time; write '30 s', '30 min' or '30 h'"),
        ("30", "time", "30 has no unit; expected a time; write '30 s', '30 min' or '30 h'"),
        ("8 hours", "time", "unknown unit 'hours'; write '8 h'"),
        ("1 hour 30 mins", "time", "unknown unit 'hour'; write '1 h 30 min'"),
        ("20 secs", "time", "unknown unit 'secs'; write '20 s'"),
        ("8 H", "time", "unknown unit 'H'; write '8 h'"),
        ("2 weks", "time", "unknown unit 'weks'; units of time: ms, s, min, h, d"),
        ("2 mn", "time", "unknown unit 'mn'; did you mean 'min'? units of time: ms, s, min, h, d"),
        ("80 cmm", "length", "unknown unit 'cmm'; did you mean 'mm'? units of length: mm, cm, m, km, in, ft"),
        ("5 kg", "time", "'5 kg' is a mass; expected a time; such as '45 s'"),
        ("5 kg", "angle", "'5 kg' is a mass; expected an angle; such as '10 deg'"),
        ("10 deg", "mass", "'10 deg' is an angle; expected a mass; such as '6 kg'"),
        (10, "angle", "10 has no unit; expected an angle; write '10 deg' or '10 rad'"),
        ("10 degrees", "angle", "unknown unit 'degrees'; write '10 deg'"),
        ("10\u00b0", "angle", "unknown unit '\u00b0'; write '10 deg'"),
        ("1,5 s", "time", "cannot read '1,5 s' as a time; write a decimal point: '1.5 s'"),
        (
            "45:00",
            "time",
            "'45:00' may be hours and minutes or minutes and seconds; write '45 h 0 min' or '45 min 0 s'",
        ),
        ("1:2:3:4", "time", "cannot read '1:2:3:4' as a time; write '45 s', '1 min 30 s' or a clock '00:45:00'"),
        ("30 s 1 min", "time", "cannot read '30 s 1 min' as a time; write one number and one unit, or '1 min 30 s'"),
        ("1 min -30 s", "time", "cannot read '1 min -30 s' as a time; write one number and one unit, or '1 min 30 s'"),
        ("1e99 s", "time", "'1e99 s' is out of any range that can be meant"),
        ("", "time", "expected a time, found empty text; write a number and its unit, such as '45 s'"),
        ("soon", "time", "cannot read 'soon' as a time; write a number and its unit, such as '45 s'"),
        (float("inf"), "time", "expected a time, found inf; write a finite number with its unit: '45 s'"),
        (float("nan"), "mass", "expected a mass, found nan; write a finite number with its unit: '6 kg'"),
        (True, "mass", "expected a mass, found true; write it with its unit, such as '6 kg'"),
        (None, "length", "expected a length, found nothing; write it with its unit, such as '1.5 m'"),
        ([1], "speed", "expected a speed, found a list of 1; write it with its unit, such as '1.2 m/s'"),
    ],
)
def test_what_is_no_quantity_is_answered_with_the_way_out(value, kind, said):
    with pytest.raises(UnitError) as caught:
        parse(value, kind)
    assert str(caught.value) == said


@given(
    st.sampled_from(sorted(UNITS)),
    st.integers(-(10**6), 10**6),
    st.integers(0, 3),
    st.sampled_from(["", " ", "  "]),
    st.data(),
)
def test_every_unit_scales_its_number(kind, number, decimals, space, data):
    unit = data.draw(st.sampled_from(sorted(UNITS[kind])))
    text = f"{number / 10**decimals:.{decimals}f}"
    assert parse(f"{text}{space}{unit}", kind) == pytest.approx(float(text) * float(UNITS[kind][unit]), rel=1e-15)


@given(st.integers(0, 999), st.integers(0, 59), st.integers(0, 59))
def test_clock_and_parts_mean_the_same(hours, minutes, seconds):
    parts = parse(f"{hours} h {minutes} min {seconds} s", "time")
    assert parse(f"{hours}:{minutes:02d}:{seconds:02d}", "time") == parts == hours * 3600 + minutes * 60 + seconds


@given(st.text(max_size=30) | st.text("0123456789.,:+-eE smhind/kg", max_size=20), st.sampled_from(sorted(UNITS)))
def test_any_text_is_a_finite_number_or_a_unit_error(text, kind):
    try:
        assert abs(parse(text, kind)) < 1e40
    except UnitError as error:
        assert error.message


@pytest.mark.parametrize(
    ("text", "kind"), [("45 deg", "angle"), ("2.5 s", "time"), ("0.25 m", "length"), ("6 kg", "mass")]
)
def test_what_is_written_is_what_was_read(text, kind):
    assert written(parse(text, kind), kind) == text
