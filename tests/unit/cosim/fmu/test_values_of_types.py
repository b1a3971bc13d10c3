"""Values of all types, as people write them."""

import re

import pytest

from herringbone.commands.options import start_values
from herringbone.core import ParameterError
from herringbone.cosim.fmu.values import as_value, as_values

ITEMS = (("off", 1), ("on", 2), ("back", -3))


def test_items_of_an_array_are_numbers_or_names():
    assert as_values("Enumeration", "1 on -3", 3, "p.m", ITEMS) == [1, 2, -3]


def test_digits_of_bytes_that_read_as_a_number_are_refused():
    """0102 is the number 102: its digits are gone."""
    said = "it takes a Binary, as hexadecimal digits; in quotes, --set 'PART.VARIABLE=\"0102\"'"
    with pytest.raises(ParameterError, match=re.escape(said)):
        as_value("Binary", *start_values(["p.b=0102"]).values(), "p.b")
    assert as_value("Binary", *start_values(['p.b="0102"']).values(), "p.b") == b"\x01\x02"


def test_names_with_an_equals_sign_stand_in_quotes():
    assert start_values(['"p.a = b"=2', 'p.s="x=1"']) == {"p.a = b": 2.0, "p.s": "x=1"}
    assert start_values(['"p.a=b"="2"']) == {"p.a=b": "2"}
    for wrong in ('"p.a=b"', '""=2', '"p.a=b"='):
        with pytest.raises(ParameterError, match=f"^--set {wrong}: it must be INSTANCE.VARIABLE="):
            start_values([wrong])


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("9007199254740993.0", 9007199254740993), ("-9.007199254740993e15", -9007199254740993),
        ("18446744073709551615", 18446744073709551615), ("1e300", 1e300), ("1e17", 1e17),
    ],
)  # fmt: skip
def test_whole_numbers_keep_all_digits(text, value):
    (found,) = start_values([f"p.k={text}"]).values()
    assert (found, type(found)) == (value, type(value))
