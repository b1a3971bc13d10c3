"""What a run has computed is kept, whatever its data say; FMUs carry the file that is meant."""

import shutil
import zipfile

from support.compiler import needs_compiler

import herringbone as hb
from herringbone.core.places.paths import component_folder
from herringbone.cosim.ssp.read import read_ssp
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.exporting.export import export_ssp


def test_data_that_are_not_the_described_ones_lose_no_run(tmp_path):
    """The FMU takes them; the figures that need the description are left out, with a line."""
    folder = shutil.copytree(component_folder("modal_housing") / "resources", tmp_path / "other")
    modes = folder / "modes.csv"
    modes.write_text(modes.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    values = {f"modal_housing.{name}": folder / f"{name}.csv" for name in ("modes", "shapes")}
    kept = []
    result = hb.run("gearbox", fmu="in-process", t_end=1e-3, values=values, recorded=kept.append)
    assert kept[0].outcome.completed
    assert result.budget == ()
    (line,) = (note for note in result.info.notes if "no error budget" in note)
    assert "is not the file that housing.json describes" in line


@needs_compiler
def test_parts_of_one_component_carry_files_of_their_own(tmp_path):
    cycle = component_folder("bench_controller") / "resources" / "loaded.csv"
    file = tmp_path / "mine.csv"
    file.write_text(cycle.read_text(encoding="utf-8").replace("1000", "900"), encoding="utf-8")
    parts = tuple(
        PartSpec(name, "bench_controller", values={"cycle": str(file)} if name == "own" else {})
        for name in ("first", "own")
    )
    ssp = export_ssp(System("two", "", parts, ()), tmp_path / "two.ssp")
    first, own = (part.fmu for part in read_ssp(ssp).parts)
    for fmu, wanted in ((first, cycle), (own, file)):
        with zipfile.ZipFile(fmu) as archive:
            assert archive.read("resources/loaded.csv") == wanted.read_bytes()
