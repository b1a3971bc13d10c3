"""Figures of a gear pair as tables for people and as one object for programs."""

import math
from collections.abc import Sequence
from dataclasses import asdict

from herringbone.gears.geometry.corner_contact import Impact, meshing_impact
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import SliceMesh

_SPEED = 1000.0 * math.pi / 30.0
"""Speed at which the meshing impact is told [rad/s]."""
_PULSE = 0.02
"""Share of the impact force that a helical tooth's corner may have: one of some fifty slices."""
_HARMONICS = 3
_COLUMN = 9
"""Width of a number of a pair."""
_Row = tuple[str, str]
_PAIR_FIGURES = (
    "number_of_teeth", "halves", "normal_module", "normal_pressure_angle",
    "working_transverse_pressure_angle", "helix_angle", "base_helix_angle", "face_width",
    "center_distance", "profile_shift_coefficient", "reference_radius", "base_radius",
    "pitch_radius", "tip_radius", "root_radius", "form_radius", "tip_clearance",
    "normal_backlash", "transverse_base_pitch", "transverse_contact_ratio", "overlap_ratio",
    "total_contact_ratio",
)  # fmt: skip


def gear_tables(job: GearJob, stiffness: MeshStiffness) -> str:
    """Tables of geometry, forces, mesh stiffness and meshing impact, with units."""
    return "\n\n".join([
        _aligned([*_geometry(job.pair), *_forces(job)]),
        _stiffness_table(stiffness),
        _aligned(_impact_rows(job, stiffness)),
    ])  # fmt: skip


def gear_figures(job: GearJob, stiffness: MeshStiffness) -> dict:
    """What the tables show, in SI units and rad."""
    pair, impact = job.pair, _impact(job, stiffness)
    forces = pair.tooth_forces(job.pinion_torque)
    return {
        "pair": {name: getattr(pair, name) for name in _PAIR_FIGURES},
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
        "impact": {"speed": _SPEED, **asdict(impact)},
    }


def _aligned(rows: Sequence[_Row]) -> str:
    """Rows under headings; a heading has no value."""
    width = max(len(name) for name, value in rows if value)
    lines = [f"{name:{width}}  {value}" if value else f"\n{name}" for name, value in rows]
    return "\n".join(lines).lstrip("\n")


def _pair(values: Sequence[float], factor: float, digits: int) -> str:
    return " ".join(f"{factor * value:{_COLUMN}.{digits}f}" for value in values)


def _geometry(pair: GearPair) -> list[_Row]:
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
        ("inertia", f"{_pair([body.inertia for body in pair.half_body], 1.0, 6)} kg m2"),
    ]
    return rows


def _forces(job: GearJob) -> list[_Row]:
    torque = job.pinion_torque
    forces = job.pair.tooth_forces(torque)
    return [
        (f"Forces at {torque:.6g} N m of the pinion", ""),
        ("tangential, at the reference circle", f"{forces.tangential:.1f} N"),
        ("line of action, transverse", f"{forces.line_of_action:.1f} N"),
        ("normal, one half", f"{forces.normal:.1f} N"),
        ("axial, one half", f"{forces.axial:.1f} N"),
    ]


def _stiffness_table(stiffness: MeshStiffness) -> str:
    """Means over a mesh period, at every load."""
    lines = [
        "Mesh stiffness of one half, means over a mesh period",
        stiffness.method,
        f"{'load':>10}  {'secant':>9}  {'tangent':>9}  {'deflection':>10}   secant's harmonics",
        f"{'[N]':>10}  {'[N/um]':>9}  {'[N/um]':>9}  {'[um]':>10}   1 to {_HARMONICS} [% of mean]",
    ]
    harmonics = stiffness.harmonics()[:, :_HARMONICS]
    for i, load in enumerate(stiffness.loads):
        amplitudes = " ".join(f"{100.0 * value:7.2f}" for value in harmonics[i])
        lines.append(
            f"{load:10.1f}  {1e-6 * stiffness.secant[i].mean():9.1f}  "
            f"{1e-6 * stiffness.tangent[i].mean():9.1f}  "
            f"{1e6 * stiffness.deflection[i].mean():10.3f}  {amplitudes}"
        )
    return "\n".join(lines)


def _impact(job: GearJob, stiffness: MeshStiffness) -> Impact:
    """What the meshing impact may reach at the job's torque; an upper bound for helical teeth."""
    load = job.pair.tooth_forces(job.pinion_torque).normal
    mesh = SliceMesh(job.pair, calibration=job.task().calibration_of("slices"))
    deflection = load / stiffness.mean(load)
    return meshing_impact(job.pair, _SPEED, deflection, mesh.single_pair_stiffness(load))


def _impact_rows(job: GearJob, stiffness: MeshStiffness) -> list[_Row]:
    impact = _impact(job, stiffness)
    return [
        ("Meshing impact at this load and 1000 r/min, without relief", ""),
        ("contact begins early by", f"{1e3 * impact.early_contact:.3f} mm"),
        ("velocity, normal to the flank", f"{impact.velocity:.4f} m/s"),
        ("force over the full face (upper bound)", f"{impact.force:.0f} N"),
        (f"{_PULSE:g} of it, for impact_force", f"{_PULSE * impact.force:.1f} N"),
    ]
