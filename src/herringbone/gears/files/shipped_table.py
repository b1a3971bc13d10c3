"""The stiffness table that the shipped gear pair has: computed from its gear file.

`python -m herringbone.gears.files.shipped_table` writes it anew; it takes the extra 'fe' and, the
first time, less than a minute on two idle cores.
"""

from herringbone.components.registry import component_for
from herringbone.core.declaring.roles import Role
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.table_file import write_table
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness

_SHIPPED = component_for(Role.GEAR_PAIR)
GEAR_FILE = _SHIPPED.folder / "gear_pair.toml"
TABLE_FILE = _SHIPPED.resources / "mesh_stiffness.csv"


def shipped_stiffness() -> MeshStiffness:
    """Mesh stiffness of the component's pair.

    Raises:
        ParameterError: the extra 'fe' is missing.
    """
    return stiffness_for(read_gear_file(GEAR_FILE))


if __name__ == "__main__":
    write_table(shipped_stiffness(), TABLE_FILE)
