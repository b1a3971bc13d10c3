"""Words of options and arguments."""

import pytest

from herringbone.core.wording import (
    option,
    percent,
    setting,
    settings,
    several_values,
    words_of_commands,
)


def told():
    return [
        option("record_step", 2e-5),
        option("overwrite", True),
        option("as_fmu"),
        option("probe", False),
        option("start", "rest"),
        option("outside", ["motor", "road"]),
        setting("motor.w0", 3.0),
        several_values("speed"),
    ]


def test_scripts_and_commands_read_their_own_words():
    assert told()[:4] == ["record_step=2e-05", "overwrite=True", "as_fmu", "probe=False"]
    assert told()[4:6] == ['start="rest"', 'outside=["motor", "road"]']
    assert told()[6:] == ['values={"motor.w0": 3}', "speed=[100.0, 200.0, 300.0]"]
    with words_of_commands():
        assert told()[:4] == ["--record-step 2e-05", "--overwrite", "--as-fmu", "--no-probe"]
        assert told()[4:6] == ["--start rest", "--outside motor --outside road"]
        assert told()[6:] == ["--set motor.w0=3", "--speed 500:3000:26"]
    assert option("as_fmu") == "as_fmu"


def test_values_that_are_set_together_are_one_argument():
    pair = {"gear.flank": 1.0, "bearings.flank": "..."}
    assert settings(pair) == 'values={"gear.flank": 1, "bearings.flank": ...}'
    with words_of_commands():
        assert settings(pair) == "--set gear.flank=1 --set bearings.flank=..."
        assert settings({"p.a=b": 2.0}) == """--set '"p.a=b"'=2"""


@pytest.mark.parametrize(
    ("share", "digits", "shown"),
    [(1.234e-5, 2, "0.0012 %"), (0.0996, 2, "10 %"), (2.104, 2, "210 %"), (0.12345, 3, "12.3 %"),
     (9.999, 3, "1000 %"), (-2.5, 2, "-250 %"), (3e5, 2, "3e+07 %"), (float("inf"), 2, "inf %")],
)  # fmt: skip
def test_shares(share, digits, shown):
    assert percent(share, digits) == shown
