"""An FMU that allows one instance per process says so when a second one is wanted."""

import pytest
from support.foreign.c_fmu import compiled_fmu
from support.foreign.drivetrain import SOURCE, description

from herringbone.core import FmuError
from herringbone.cosim.fmu.file import extract_fmu
from herringbone.cosim.fmu.instance import new_part

ONE = "({static int n; n++ ? (Model *)0 : (Model *)calloc(1, sizeof(Model));})"
ONCE = ' canBeInstantiatedOnlyOncePerProcess="true"'


@pytest.mark.parametrize(("ability", "told"), [("", "may be one that"), (ONCE, "declares that it")])
def test_the_second_instance_is_told_from_others(tmp_path, ability, told):
    text = description("ROTOR", saves=True).replace(" canGetAndSet", f"{ability} canGetAndSet")
    text = text.replace('guid="t"', f'guid="{told}"')
    file = compiled_fmu(SOURCE, text, tmp_path, ("PART=ROTOR", f"NEW()={ONE}", "DELETE(m)=free(m)"))
    folder = extract_fmu(file)
    first = new_part("first", file, folder)
    with pytest.raises(FmuError, match=f"it {told} can be instantiated once only per process, and"):
        new_part("second", file, folder)
    first.close()
