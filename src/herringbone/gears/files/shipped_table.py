"""The stiffness table that the shipped gear pair has: computed from its gear file.

Run `python -m herringbone.gears.files.shipped_table` to write it anew.
"""

from herringbone.components.registry import component_for
from herringbone.core.roles import Role
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.table_file import write_table
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.methods import mesh_stiffness

_SHIPPED = component_for(Role.GEAR_PAIR)
GEAR_FILE = _SHIPPED.folder / "gear_pair.toml"
TABLE_FILE = _SHIPPED.resources / "mesh_stiffness.csv"


def shipped_stiffness() -> MeshStiffness:
    """Mesh stiffness of the component's pair."""
    return mesh_stiffness(read_gear_file(GEAR_FILE).task())


if __name__ == "__main__":
    write_table(shipped_stiffness(), TABLE_FILE)
