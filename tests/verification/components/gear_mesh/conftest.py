"""The table that tests of the gear pair share."""

import pytest
from support.gearing.gear_mesh import constant_table


@pytest.fixture
def constant(tmp_path):
    return constant_table(tmp_path / "constant.csv")
