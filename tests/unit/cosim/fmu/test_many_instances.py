"""Many instances of an FMU in one cell: what they have in common is read once."""

import sys

import pytest
from support.foreign.c_flange import c_flange

from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.cosim.fmu.opening import many_of

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="cells need Linux")


@pytest.mark.parametrize("fmi", [2, 3])
def test_further_instances_do_not_read_the_file_again(tmp_path, fmi):
    """Trials of a part that saves no state take hundreds of them."""
    file = c_flange(tmp_path, "ROTOR", fmi=fmi)
    with foreign_fmu_policy(in_process=False), many_of("rotor", file) as make:
        make().close()
        file.unlink()
        first, second = make(), make()
        first.set("flange.tau", 3.0)
        assert (*first.get(["flange.tau"]), *second.get(["flange.tau"])) == (3.0, 0.0)
        for part in (first, second):
            part.close()
