"""What `herringbone gear` shows and writes: table, picture, stiffness table, component values."""

import math
from pathlib import Path

from herringbone.core import HerringboneError, ParameterError
from herringbone.gears.component_values import component_values
from herringbone.gears.corner_contact import meshing_impact
from herringbone.gears.gear_file import read_gear_file
from herringbone.gears.gear_pair import GearPair
from herringbone.gears.job import GearJob
from herringbone.gears.mesh_stiffness import MeshStiffness
from herringbone.gears.methods import METHODS, Progress, mesh_stiffness
from herringbone.gears.rexs import read_rexs
from herringbone.gears.slices import SliceMesh
from herringbone.gears.table_file import table_text

TABLE, PICTURE, VALUES = "mesh_stiffness.csv", "gear_pair.png", "gear_mesh.toml"
_READERS = (".toml", ".rexs", ".xml")
_SPEED = 1000.0 * math.pi / 30.0
"""Speed at which the meshing impact is told [rad/s]."""
_PULSE = 0.02
"""Share of the impact force that a helical tooth's corner may have: one of some fifty slices."""
_Row = tuple[str, str]


def gear(
    file: Path,
    output: Path | None = None,
    *,
    method: str = "slices",
    torque: float | None = None,
    stage: str | None = None,
    halves: int = 1,
    progress: Progress | None = None,
) -> str:
    """Compute a pair's table and write its files.

    Args:
        file: gear file (.toml) or REXS file (.rexs, .xml).
        output: folder; results/gear-NAME if None.
        method: of the mesh stiffness.
        torque: of the pinion [N m]; the file's if None.
        stage: of a REXS file.
        halves: of a REXS stage.
        progress: called with what is done and the share of the work, 0 to 1.

    Returns:
        The table as text, and where the files are.

    Raises:
        HerringboneError: see `read_gear_file`, `read_rexs`, `GearJob.task` and the method; or a
            file cannot be written.
    """
    if method not in METHODS:
        raise ParameterError(f"method '{method}' is none of {', '.join(METHODS)}")
    job = _job(file, stage, halves)
    if torque is not None:
        job = GearJob(**{**vars(job), "torque": torque})
    task = job.task()
    stiffness = mesh_stiffness(task, method, progress)
    folder = output or Path("results") / f"gear-{file.stem}"
    written = _write(stiffness, folder, file.stem)
    rows = [*_geometry(job.pair), *_mesh(job, stiffness)]
    width = max(len(name) for name, value in rows if value)
    lines = [f"{name:{width}}  {value}" if value else f"\n{name}" for name, value in rows]
    return "\n".join([*lines, "", *(str(path) for path in written)])


def _job(file: Path, stage: str | None, halves: int) -> GearJob:
    suffix = file.suffix.lower()
    if suffix not in _READERS:
        raise ParameterError(f"{file}: a gear file ends with one of {', '.join(_READERS)}")
    if suffix == ".toml":
        if stage is not None:
            raise ParameterError(f"{file}: --stage is of REXS files only")
        return read_gear_file(file)
    return GearJob(read_rexs(file, stage=stage, halves=halves))


def _pair(values: tuple[float, float], factor: float, digits: int) -> str:
    return "   ".join(f"{factor * value:.{digits}f}" for value in values)


def _geometry(pair: GearPair) -> list[_Row]:
    points, stiffness = pair.path_of_contact, pair.iso6336_stiffness()
    rows = [
        ("Geometry (ISO 21771; pinion   wheel)", ""),
        ("number of teeth", "   ".join(str(z) for z in pair.number_of_teeth)),
        ("normal module", f"{1e3 * pair.normal_module:g} mm"),
        ("transverse module", f"{1e3 * pair.transverse_module:.6f} mm"),
        ("normal pressure angle", f"{math.degrees(pair.normal_pressure_angle):.4f} deg"),
        ("transverse pressure angle", f"{math.degrees(pair.transverse_pressure_angle):.4f} deg"),
        (
            "working transverse pressure angle",
            f"{math.degrees(pair.working_transverse_pressure_angle):.4f} deg",
        ),
        ("helix angle", f"{math.degrees(pair.helix_angle):.4f} deg"),
        ("base helix angle", f"{math.degrees(pair.base_helix_angle):.4f} deg"),
        ("face width of one half", f"{1e3 * pair.face_width:g} mm, halves: {pair.halves}"),
        ("center distance", f"{1e3 * pair.center_distance:.4f} mm"),
        ("profile shift coefficient", _pair(pair.profile_shift_coefficient, 1.0, 4)),
    ]
    for name in ("reference", "base", "pitch", "tip", "root", "form"):
        rows.append((f"{name} radius", f"{_pair(getattr(pair, f'{name}_radius'), 1e3, 4)} mm"))
    rows += [
        ("tip clearance", f"{_pair(pair.tip_clearance, 1e3, 4)} mm"),
        ("tooth thickness at the tip", f"{_pair(pair.tip_tooth_thickness, 1e3, 4)} mm"),
        ("normal backlash", f"{round(1e6 * pair.normal_backlash, 1) + 0.0:.1f} um"),
        ("length of the path of contact", f"{1e3 * points.length:.4f} mm"),
        ("transverse base pitch", f"{1e3 * pair.transverse_base_pitch:.4f} mm"),
        ("transverse contact ratio", f"{pair.transverse_contact_ratio:.4f}"),
        ("overlap ratio", f"{pair.overlap_ratio:.4f}"),
        ("total contact ratio", f"{pair.total_contact_ratio:.4f}"),
        ("Stiffness by ISO 6336-1", ""),
        ("c'_th", f"{1e-9 * stiffness.theoretical_single:.4f} N/(mm um)"),
        ("c'", f"{1e-9 * stiffness.single:.4f} N/(mm um)"),
        ("c_gamma_alpha", f"{1e-9 * stiffness.mesh_alpha:.4f} N/(mm um)"),
        ("all halves, normal to the flank", f"{stiffness.normal:.4g} N/m"),
        ("Half bodies (solid steel; pinion   wheel)", ""),
        ("mass", f"{_pair([body.mass for body in pair.half_body], 1.0, 3)} kg"),
        ("inertia", f"{'   '.join(f'{body.inertia:.5g}' for body in pair.half_body)} kg m2"),
    ]
    return rows


def _mesh(job: GearJob, stiffness: MeshStiffness) -> list[_Row]:
    pair, torque = job.pair, job.pinion_torque
    forces = pair.tooth_forces(torque)
    rows = [
        (f"Forces at {torque:.6g} N m of the pinion", ""),
        ("tangential, at the reference circle", f"{forces.tangential:.1f} N"),
        ("line of action, transverse", f"{forces.line_of_action:.1f} N"),
        ("normal, one half", f"{forces.normal:.1f} N"),
        ("axial, one half", f"{forces.axial:.1f} N"),
        (f"Mesh stiffness of one half ({stiffness.method})", ""),
    ]
    harmonics = stiffness.harmonics()
    for i, load in enumerate(stiffness.loads):
        amplitudes = " ".join(f"{100.0 * value:.2f}" for value in harmonics[i, :3])
        rows.append(
            (
                f"at {load:.6g} N",
                f"secant {stiffness.secant[i].mean():.4g} N/m, tangent "
                f"{stiffness.tangent[i].mean():.4g} N/m, deflection "
                f"{1e6 * stiffness.deflection[i].mean():.3f} um, harmonics 1-3 {amplitudes} %",
            )
        )
    return rows + _impact(job, stiffness, forces.normal)


def _impact(job: GearJob, stiffness: MeshStiffness, load: float) -> list[_Row]:
    """What the meshing impact may reach; an upper bound for helical teeth."""
    mesh = SliceMesh(job.pair, calibration=job.calibration)
    deflection = load / stiffness.mean(load)
    impact = meshing_impact(job.pair, _SPEED, deflection, mesh.single_pair_stiffness(load))
    return [
        ("Meshing impact at this load and 1000 r/min, without relief", ""),
        ("contact begins early by", f"{1e3 * impact.early_contact:.3f} mm"),
        ("velocity, normal to the flank", f"{impact.velocity:.4f} m/s"),
        ("force over the full face (upper bound)", f"{impact.force:.0f} N"),
        (f"{_PULSE:g} of it, for gear_mesh.impact_force", f"{_PULSE * impact.force:.1f} N"),
    ]


def _write(stiffness: MeshStiffness, folder: Path, name: str) -> list[Path]:
    """Write table, picture and, of a double-helical pair, the component's values."""
    from herringbone.plotting.gear_pair import write_gear_pair_picture  # noqa: PLC0415 (lazy)

    texts = {TABLE: table_text(stiffness)}
    if stiffness.pair.halves == 2:
        texts[VALUES] = _values_text(stiffness.pair)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for file_name, text in texts.items():
            (folder / file_name).write_text(text, encoding="utf-8", newline="\n")
        write_gear_pair_picture(stiffness, f"Gear pair {name}", folder / PICTURE)
    except OSError as error:
        raise HerringboneError(
            f"cannot write to {folder}: {error.strerror}; choose another folder with -o"
        ) from error
    return [folder / file_name for file_name in (*texts, PICTURE)]


def _values_text(pair: GearPair) -> str:
    """Values of the gear_mesh component as the [set] table of a scene."""
    lines = [
        "# Values of the gear_mesh component for this pair: the [set] table of a scene.",
        f"# A steady load of the wheel is {pair.gear_ratio:.6g} times the pinion's torque.",
        "[set]",
    ]
    lines += [f'"gear_mesh.{name}" = {value!r}' for name, value in component_values(pair).items()]
    return "\n".join(lines) + "\n"
