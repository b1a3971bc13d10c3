"""Figures of a gear pair as tables for people and as one object for programs."""

import math
from collections.abc import Sequence
from dataclasses import asdict

from herringbone.commands.gear.loaded import loaded_json, loaded_rows
from herringbone.core.declaring.units import RAD_S
from herringbone.gears.geometry.corner_contact import Impact
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.job import GearJob
from herringbone.gears.load.figures import Loaded
from herringbone.gears.load.impact import impact_at
from herringbone.gears.pair_values import USUAL_BACKLASH, backlash_of
from herringbone.gears.stiffness.calibration import FULL_SPECIFIC_LOAD
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness

_PULSE = 0.02
"""Share of the impact force that a helical tooth's corner may have: one of some fifty slices."""
_HARMONICS = 3
_COLUMN = 9
"""Width of a number of a pair."""
_FORCES = {
    "tangential_reference": "tangential, at the reference circle",
    "radial_reference": "radial, at the reference circle",
    "tangential_working": "tangential, at the working pitch circle",
    "radial_working": "radial, at the working pitch circle",
    "line_of_action": "line of action, transverse",
    "normal": "normal to the flank (pair: sum)",
    "axial": "axial",
}
_Row = tuple[str, str]
_PAIR_FIGURES = (
    "number_of_teeth", "halves", "normal_module", "normal_pressure_angle",
    "working_transverse_pressure_angle", "helix_angle", "base_helix_angle", "face_width",
    "center_distance", "profile_shift_coefficient", "reference_radius", "base_radius",
    "pitch_radius", "tip_radius", "root_radius", "form_radius", "tip_clearance",
    "normal_backlash", "transverse_base_pitch", "transverse_contact_ratio", "overlap_ratio",
    "total_contact_ratio",
)  # fmt: skip


def gear_tables(job: GearJob, stiffness: MeshStiffness, loaded: Loaded) -> str:
    """Tables of geometry, forces, mesh stiffness, load and meshing impact, with units."""
    return "\n\n".join([
        _aligned([*_geometry(job), *_modification(job.modification), *_forces(job)]),
        _stiffness_table(stiffness, loaded),
        _aligned([*loaded_rows(loaded), *_impact_rows(job, stiffness, loaded)]),
    ])  # fmt: skip


def gear_figures(job: GearJob, stiffness: MeshStiffness, loaded: Loaded) -> dict:
    """What the tables show, in SI units and rad."""
    speed = loaded.conditions.speed
    pair, impact = (
        job.pair,
        impact_at(job, stiffness, speed, job.pair.tooth_forces(job.pinion_torque).normal),
    )
    forces = pair.tooth_forces(job.pinion_torque)
    return {
        "pair": {name: getattr(pair, name) for name in _PAIR_FIGURES},
        "backlash_in_runs": backlash_of(job) if pair.halves == 2 else None,
        "iso6336_stiffness": asdict(pair.iso6336_stiffness()),
        "pinion_torque": job.pinion_torque,
        "forces": asdict(forces),
        "mesh_stiffness": {
            "method": stiffness.method,
            "load": stiffness.loads.tolist(),
            "secant": stiffness.secant.mean(axis=1).tolist(),
            "tangent": stiffness.tangent.mean(axis=1).tolist(),
            "deflection": stiffness.deflection.mean(axis=1).tolist(),
            "harmonics": stiffness.harmonics()[:, :_HARMONICS].tolist(),
        },
        "modification": asdict(job.modification),
        "loaded": loaded_json(loaded),
        "impact": {"speed": speed, **asdict(impact)},
    }


def _aligned(rows: Sequence[_Row]) -> str:
    """Rows under headings; a heading has no value."""
    width = max(len(name) for name, value in rows if value)
    lines = [f"{name:{width}}  {value}" if value else f"\n{name}" for name, value in rows]
    return "\n".join(lines).lstrip("\n")


def _pair(values: Sequence[float], factor: float, digits: int) -> str:
    return " ".join(f"{factor * value:{_COLUMN}.{digits}f}" for value in values)


def _geometry(job: GearJob) -> list[_Row]:
    pair = job.pair
    points, stiffness = pair.path_of_contact, pair.iso6336_stiffness()
    rows = [
        ("Geometry (ISO 21771; pinion   wheel)", ""),
        ("number of teeth", _pair(pair.number_of_teeth, 1.0, 0)),
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
        ("normal backlash by geometry", f"{round(1e6 * pair.normal_backlash, 1) + 0.0:.1f} um"),
        *_backlash(job),
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
        ("inertia", f"{_pair([body.inertia for body in pair.half_body], 1.0, 6)} kg m2"),
    ]
    return rows


def _backlash(job: GearJob) -> list[_Row]:
    """The backlash that runs take, which double-helical pairs alone have, and where it is from."""
    if job.pair.halves == 1:
        return []
    taken, geometric = backlash_of(job), job.pair.normal_backlash
    if job.mesh.backlash is not None:
        source = "[mesh] backlash"
    else:
        source = "the same" if taken == geometric else f"assumed, {USUAL_BACKLASH:g} of the module"
    return [("normal backlash in runs", f"{1e6 * taken:.1f} um ({source})")]


def _modification(modification: Modification) -> list[_Row]:
    return [
        ("Modification of the flanks (pinion   wheel)", ""),
        ("tip relief, parabolic", f"{_pair(modification.tip_relief, 1e6, 2)} um"),
        ("its length on the path of contact", f"{1e3 * modification.relief_length:g} mm"),
        ("helix crowning", f"{1e6 * modification.helix_crowning:g} um"),
    ]


def _forces(job: GearJob) -> list[_Row]:
    torque = job.pinion_torque
    forces = job.pair.tooth_forces(torque)
    columns = (forces.half,) if job.pair.halves == 1 else (forces.pair, forces.half)
    heading = "" if job.pair.halves == 1 else " (pair   one half)"
    origin = f": {1e-3 * FULL_SPECIFIC_LOAD:g} N/mm of face width, as no torque is given"
    chosen = origin if job.torque is None else ""
    return [(f"Forces at {torque:.6g} N m of the pinion{chosen}{heading}", "")] + [
        (label, f"{_pair([getattr(column, name) for column in columns], 1.0, 1)} N")
        for name, label in _FORCES.items()
    ]


def _stiffness_table(stiffness: MeshStiffness, loaded: Loaded) -> str:
    """Means over a mesh period, at every load; transmission error of the pair at its torque."""
    lines = [
        "Mesh stiffness of one half, normal to the flank, means over a mesh period",
        stiffness.method,
        f"{'torque':>8}  {'load':>9}  {'secant':>9}  {'tangent':>9}  {'deflection':>10}"
        f"  {'TE p-p':>7}   secant's harmonics",
        f"{'[N m]':>8}  {'[N]':>9}  {'[N/um]':>9}  {'[N/um]':>9}  {'[um]':>10}  {'[um]':>7}"
        f"   1 to {_HARMONICS} [% of mean]",
    ]
    harmonics = stiffness.harmonics()[:, :_HARMONICS]
    arm = stiffness.pair.base_radius[0] * math.cos(stiffness.pair.base_helix_angle)
    torques = stiffness.pair.halves * arm * stiffness.loads
    unloaded = [] if stiffness.loads[0] > 0.0 else ["-"]
    errors = unloaded + [f"{1e6 * pair.peak_to_peak:.3f}" for pair in loaded.torques]
    errors += ["-"] * (torques.size - len(errors))
    for i, load in enumerate(stiffness.loads):
        amplitudes = " ".join(f"{100.0 * value:7.2f}" for value in harmonics[i])
        lines.append(
            f"{torques[i]:8.1f}  {load:9.1f}  {1e-6 * stiffness.secant[i].mean():9.1f}  "
            f"{1e-6 * stiffness.tangent[i].mean():9.1f}  "
            f"{1e6 * stiffness.deflection[i].mean():10.3f}  {errors[i]:>7}  {amplitudes}"
        )
    return "\n".join(lines)


def _impact(job: GearJob, stiffness: MeshStiffness, speed: float) -> Impact:
    return impact_at(job, stiffness, speed, job.pair.tooth_forces(job.pinion_torque).normal)


def _impact_rows(job: GearJob, stiffness: MeshStiffness, loaded: Loaded) -> list[_Row]:
    speed = loaded.conditions.speed
    impact = _impact(job, stiffness, speed)
    return [
        (f"Meshing impact at this load and {speed / RAD_S:g} r/min, without relief", ""),
        ("contact begins early by", f"{1e3 * impact.early_contact:.3f} mm"),
        ("velocity, normal to the flank", f"{impact.velocity:.4f} m/s"),
        ("force over the full face (upper bound)", f"{impact.force:.0f} N"),
        (f"{_PULSE:g} of it, for impact_force", f"{_PULSE * impact.force:.1f} N"),
    ]
