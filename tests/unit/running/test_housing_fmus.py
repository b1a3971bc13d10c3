"""FMUs that are put in the place of a housing."""

import pytest

from herringbone.core import StructureError
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.exporting.export import build_fmus
from herringbone.running.loading import with_replacements


@pytest.mark.parametrize("probe", [True, False])
def test_what_is_no_housing_is_refused_at_once(probe):
    """Before trial steps, and without a line on connections, which are not the user's."""
    (motor,) = build_fmus(["drive_motor"])
    said = (
        f"^gearbox.modal_housing: {motor} is no housing: it has none of pinion_left, pinion_right, "
        "wheel_left, wheel_right, by which test_rig joins it; see 'herringbone check [^;]*'$"
    )
    with pytest.raises(StructureError, match=said):
        with_replacements(read_system("test_rig"), {"modal_housing": motor}, probe=probe)


def test_a_housing_is_taken():
    (housing,) = build_fmus(["modal_housing"])
    rig = read_system("test_rig")
    found, _ = with_replacements(rig, {"modal_housing": housing}, probe=False)
    assert found.foreign_parts == ("gearbox.modal_housing",)
