"""Systems, scenes, gears and dimensions of housings."""

from pathlib import Path

from fuzz.kinds.kind import Kind, file_of, written
from herringbone.core.places.paths import component_folder, systems_folder
from herringbone.cosim.structure.system_file import read_system
from herringbone.gears.accuracy.deviation_file import read_deviations, write_deviations
from herringbone.gears.accuracy.deviations import deviations
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.rexs import read_rexs_job
from herringbone.housing.welded.design import read_design
from herringbone.scenes.scene import read_scene

_GEAR_FILE = component_folder("gear_mesh") / "gear_pair.toml"
_STAGE = Path(__file__).resolve().parents[2] / "gear_stage.rexs"


def _read_own_system(file: Path) -> object:
    return read_system(file.parent)


def own_kinds() -> list[Kind]:
    pair = read_gear_file(_GEAR_FILE).pair
    teeth = written(lambda file: write_deviations(deviations(pair, 6, 0), file))
    return [
        Kind("system", (systems_folder() / "gearbox/system.toml").read_bytes(),
             file_of("system.toml", _read_own_system)),
        Kind("scene", (systems_folder() / "test_rig/scenes/loaded.toml").read_bytes(),
             file_of("scene.toml", read_scene)),
        Kind("gear_file", _GEAR_FILE.read_bytes(), file_of("x.toml", read_gear_file)),
        Kind("rexs", _STAGE.read_bytes(), file_of("x.rexs", read_rexs_job)),
        Kind("deviations", teeth, file_of("x.csv", lambda file: read_deviations(file, pair)), 1),
        Kind("dimensions", (component_folder("modal_housing") / "welded_housing.toml").read_bytes(),
             file_of("x.toml", read_design)),
    ]  # fmt: skip
