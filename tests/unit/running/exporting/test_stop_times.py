"""What an .ssp file asks for as a scene."""

import pytest

from herringbone.core import ParameterError
from herringbone.running.exporting.ssp_import import ssp_scene
from herringbone.scenes import Scene

STRUCTURE = """<?xml version="1.0" encoding="UTF-8"?>
<ssd:SystemStructureDescription version="1.0" name="s"
 xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription">
<ssd:System name="s"/>
<ssd:DefaultExperiment startTime="0" stopTime="{stop}"/>
</ssd:SystemStructureDescription>
"""


def test_the_stop_time_is_the_duration_and_positive(tmp_path):
    file = tmp_path / "SystemStructure.ssd"
    file.write_text(STRUCTURE.format(stop="3"), encoding="utf-8")
    assert ssp_scene(tmp_path).t_end == 3.0
    file.write_text(STRUCTURE.format(stop="0"), encoding="utf-8")
    assert ssp_scene(tmp_path).t_end == Scene("s").t_end
    file.write_text(STRUCTURE.format(stop="-3"), encoding="utf-8")
    with pytest.raises(ParameterError, match=r"stopTime = -3 s: it must be positive") as error:
        ssp_scene(tmp_path)
    assert str(tmp_path) in str(error.value)
