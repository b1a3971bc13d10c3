"""What `herringbone gear` shows and writes: table, picture, stiffness table."""

import json
import re
from pathlib import Path

from herringbone.commands.gear.loaded import flank_text
from herringbone.commands.gear.tables import gear_figures, gear_tables
from herringbone.commands.output import written_into
from herringbone.core.places.files import write_whole
from herringbone.gears.files.read_job import read_job
from herringbone.gears.files.rexs import STAGE_MARK
from herringbone.gears.files.table_file import table_text
from herringbone.gears.job import GearJob
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.load.figures import Conditions, Loaded, check_conditions, loaded_figures
from herringbone.gears.pair_values import backlash_notes
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.methods import AUTO, METHODS, check_method, chosen_method
from herringbone.gears.stiffness.point_mesh import Progress, silent

TABLE, FLANKS = "mesh_stiffness.csv", "flank_load.csv"
PICTURE, LOAD_PICTURE = "gear_pair.png", "gear_load.png"
_UNUSUAL = re.compile(r"[^\w.-]")
"""What names of folders should not have."""


def gear(
    file: Path,
    output: Path | None = None,
    *,
    method: str | None = None,
    torque: float | None = None,
    stage: str | None = None,
    halves: int | None = None,
    conditions: Conditions | None = None,
    progress: Progress | None = None,
    as_json: bool = False,
) -> str:
    """Compute a pair's table and write its files.

    Args:
        file: gear file (.toml) or REXS file (.rexs, .xml).
        output: folder; results/gear-NAME if None, or results/gear-NAME-STAGE.
        method: of the mesh stiffness; the file's if None.
        torque: of the pinion [N m]; the file's if None.
        stage: of a REXS file.
        halves: of a REXS stage; 1 if None.
        conditions: of the load; None: the usual ones.
        progress: called with what is done and the share of the work, 0 to 1.
        as_json: one JSON object, in SI units and rad, instead of table and notes.

    Returns:
        The table as text, and where the files are.

    Raises:
        HerringboneError: see `read_job`, `GearJob.task` and the method; or a
            file cannot be written.
    """
    check_method(method or AUTO)
    job = read_job(file, stage=stage, halves=halves)
    if torque is not None:
        job = GearJob(**{**vars(job), "torque": torque})
    conditions = conditions or Conditions()
    check_conditions(job, conditions)
    job.task().calibration_of("slices")  # of the impact: refused before a table takes its time
    stiffness = stiffness_for(job, method, progress)
    mesh = METHODS[chosen_method(job.method if method is None else method)].mesh(job.task(), silent)
    loaded = loaded_figures(job, mesh, stiffness, conditions)
    folder = output or Path("results") / _folder_name(file, stage)
    written = [str(path) for path in _write(stiffness, loaded, folder, file.stem)]
    notes = [*job.unread, *job.unused(method), *backlash_notes(job)]
    if as_json:
        figures = gear_figures(job, stiffness, loaded)
        return json.dumps({**figures, "notes": notes, "files": written})
    said = [f"note: {note}" for note in notes]
    lines = [gear_tables(job, stiffness, loaded), "", *said, f"Files: {', '.join(written)}"]
    if job.pair.halves == 2:
        of_stage = "" if stage is None else f"{STAGE_MARK}{stage}"
        lines.append(f"In a gearbox: herringbone run SYSTEM --gear {_word(f'{file}{of_stage}')}")
    return "\n".join(lines)


def _folder_name(file: Path, stage: str | None) -> str:
    """gear-FILE, or gear-FILE-STAGE, as stages of one file have results of their own."""
    name = f"gear-{file.stem}"
    return name if stage is None else f"{name}-{_UNUSUAL.sub('_', stage)}"


def _word(text: str) -> str:
    """As one word of a command line."""
    return f'"{text}"' if " " in text else text


def _write(stiffness: MeshStiffness, loaded: Loaded, folder: Path, name: str) -> list[Path]:
    """Write tables and pictures."""
    from herringbone.plotting.gears.gear_load import write_gear_load_picture  # noqa: PLC0415 (lazy)
    from herringbone.plotting.gears.gear_pair import write_gear_pair_picture  # noqa: PLC0415 (lazy)

    texts = {TABLE: table_text(stiffness), FLANKS: flank_text(stiffness.pair, loaded.flanks)}
    with written_into(folder):
        for file_name, text in texts.items():
            write_whole(folder / file_name, text)
        write_gear_pair_picture(stiffness, f"Gear pair {name}", folder / PICTURE)
        write_gear_load_picture(loaded, f"Gear pair {name}", folder / LOAD_PICTURE)
    return [folder / file_name for file_name in (*texts, PICTURE, LOAD_PICTURE)]
