"""What `herringbone gear` shows and writes: table, picture, stiffness table, component values."""

import json
from pathlib import Path

from herringbone.commands.gear.loaded import flank_text
from herringbone.commands.gear.tables import gear_figures, gear_tables
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.roles import Role
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.rexs import read_rexs
from herringbone.gears.files.table_file import table_text
from herringbone.gears.job import GearJob
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.load.figures import Conditions, Loaded, loaded_figures
from herringbone.gears.pair_values import pair_values
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.methods import AUTO, METHODS, check_method, chosen_method
from herringbone.gears.stiffness.point_mesh import Progress, silent

TABLE, FLANKS = "mesh_stiffness.csv", "flank_load.csv"
PICTURE, LOAD_PICTURE = "gear_pair.png", "gear_load.png"
_READERS = (".toml", ".rexs", ".xml")


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
        output: folder; results/gear-NAME if None.
        method: of the mesh stiffness; the file's if None.
        torque: of the pinion [N m]; the file's if None.
        stage: of a REXS file.
        halves: of a REXS stage; 1 if None.
        conditions: of the load; None: the usual ones.
        progress: called with what is done and the share of the work, 0 to 1.
        as_json: one JSON object, in SI units and rad, instead of the table.

    Returns:
        The table as text, and where the files are.

    Raises:
        HerringboneError: see `read_gear_file`, `read_rexs`, `GearJob.task` and the method; or a
            file cannot be written.
    """
    check_method(method or AUTO)
    job = _job(file, stage, halves)
    if torque is not None:
        job = GearJob(**{**vars(job), "torque": torque})
    stiffness = stiffness_for(job, method, progress)
    mesh = METHODS[chosen_method(job.method if method is None else method)].mesh(job.task(), silent)
    loaded = loaded_figures(job, mesh, stiffness, conditions or Conditions())
    folder = output or Path("results") / f"gear-{file.stem}"
    written = [str(path) for path in _write(job, stiffness, loaded, folder, file.stem)]
    if as_json:
        return json.dumps({**gear_figures(job, stiffness, loaded), "files": written})
    return f"{gear_tables(job, stiffness, loaded)}\n\nFiles: {', '.join(written)}"


def _job(file: Path, stage: str | None, halves: int | None) -> GearJob:
    suffix = file.suffix.lower()
    if suffix not in _READERS:
        raise ParameterError(f"{file}: a gear file ends with one of {', '.join(_READERS)}")
    if suffix == ".toml":
        for option, value in (("stage", stage), ("halves", halves)):
            if value is not None:
                raise ParameterError(f"{file}: --{option} is of REXS files only")
        return read_gear_file(file)
    return GearJob(read_rexs(file, stage=stage, halves=1 if halves is None else halves))


def _write(
    job: GearJob, stiffness: MeshStiffness, loaded: Loaded, folder: Path, name: str
) -> list[Path]:
    """Write tables, pictures and, of a double-helical pair, the component's values."""
    from herringbone.plotting.gear_load import write_gear_load_picture  # noqa: PLC0415 (lazy)
    from herringbone.plotting.gear_pair import write_gear_pair_picture  # noqa: PLC0415 (lazy)

    texts = {TABLE: table_text(stiffness), FLANKS: flank_text(stiffness.pair, loaded.flanks)}
    if stiffness.pair.halves == 2:
        component, text = _values_text(job)
        texts[f"{component}.toml"] = text
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for file_name, text in texts.items():
            (folder / file_name).write_text(text, encoding="utf-8", newline="\n")
        write_gear_pair_picture(stiffness, f"Gear pair {name}", folder / PICTURE)
        write_gear_load_picture(loaded, f"Gear pair {name}", folder / LOAD_PICTURE)
    except OSError as error:
        raise HerringboneError(
            f"cannot write to {folder}: {error.strerror}; choose another folder with -o"
        ) from error
    return [folder / file_name for file_name in (*texts, PICTURE, LOAD_PICTURE)]


def _values_text(job: GearJob) -> tuple[str, str]:
    """Name of the gear pair's component, and its values as the [set] table of a scene."""
    from herringbone.components.registry import component_for  # noqa: PLC0415 (numba)

    component = component_for(Role.GEAR_PAIR)
    pair, notes = pair_values(job)
    follow = component.of_pair(pair, {}) if component.of_pair else {}
    values: dict[str, float | str] = {**follow, "stiffness_table": TABLE}
    lines = [
        f"# Values of the {component.name} component for this pair: the [set] table of a scene.",
        "# Damping and pressure angle of the bearings and the controller's gear ratio follow, too:",
        "# herringbone run SYSTEM --gear FILE sets all of them, and needs no such table.",
        *(f"# {note[0].upper()}{note[1:]}." for note in notes),
        "[set]",
    ]
    lines += [
        f'"{component.name}.{name}" = ' + (f'"{value}"' if isinstance(value, str) else f"{value!r}")
        for name, value in values.items()
    ]
    return component.name, "\n".join(lines) + "\n"
