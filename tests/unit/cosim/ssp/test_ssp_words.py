"""What an .ssp file says that would change the run without a word."""

import pytest

from herringbone.core import StructureError
from herringbone.cosim.ssp.parameters import _TYPES
from herringbone.cosim.ssp.read import read_stop_time

STRUCTURE = """<?xml version="1.0" encoding="UTF-8"?>
<ssd:SystemStructureDescription version="1.0" name="s"
 xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription">
<ssd:System name="s"/>
<ssd:DefaultExperiment startTime="{start}" stopTime="10.2"/>
</ssd:SystemStructureDescription>
"""


@pytest.mark.parametrize(("text", "value"), [("true", 1), (" 1 ", 1), ("false", 0), ("0", 0)])
def test_words_of_a_boolean(text, value):
    assert _TYPES["Boolean"](text) == value


@pytest.mark.parametrize("text", ["True", "TRUE", "yes", "-"])
def test_other_words_are_none(text):
    """They were false."""
    with pytest.raises(ValueError, match=text):
        _TYPES["Boolean"](text)


@pytest.mark.parametrize(("text", "value"), [("-3", -3), ("2", 2), ("on it", "on it"), ("²", "²")])
def test_an_item_is_told_by_its_number_or_name(text, value):
    assert _TYPES["Enumeration"](text) == value


def test_runs_begin_at_0(tmp_path):
    file = tmp_path / "SystemStructure.ssd"
    file.write_text(STRUCTURE.format(start="0"))
    assert read_stop_time(tmp_path) == 10.2
    file.write_text(STRUCTURE.format(start="10"))
    with pytest.raises(StructureError, match="startTime = 10 s: runs begin at 0 s"):
        read_stop_time(tmp_path)
