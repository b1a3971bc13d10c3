"""The stiffness table that the gear_mesh component ships: computed from its gear file.

Run `python -m herringbone.gears.files.shipped_table` to write it anew.
"""

from herringbone.core.paths import component_folder, resources_folder
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.table_file import write_table
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.methods import mesh_stiffness

GEAR_FILE = component_folder("gear_mesh") / "gear_pair.toml"
TABLE_FILE = resources_folder("gear_mesh") / "mesh_stiffness.csv"


def shipped_stiffness() -> MeshStiffness:
    """Mesh stiffness of the component's pair."""
    return mesh_stiffness(read_gear_file(GEAR_FILE).task())


if __name__ == "__main__":
    write_table(shipped_stiffness(), TABLE_FILE)
