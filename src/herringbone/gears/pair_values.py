"""What components take from a gear pair, of its geometry and of what a gear file adds to it."""

import math

from herringbone.core import ParameterError
from herringbone.core.declaring.pair_values import PairValues
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.involute import involute
from herringbone.gears.job import GearJob

USUAL_BACKLASH = 0.05
"""Normal backlash over normal module, of pairs that have none by their tooth thickness."""
_NONE = 1e-7
"""A backlash [m] that is none."""
_LARGE = 0.1
"""Backlash over module that is more than that of usual gears."""
_SAME = 0.1
"""Difference of two backlashes, over them, that deserves no line."""


def pair_values(job: GearJob) -> tuple[PairValues, tuple[str, ...]]:
    """Values of a pair, and lines on what had to be assumed.

    Raises:
        ParameterError: the pair is not double helical.
    """
    pair, mesh = job.pair, job.mesh
    if pair.halves != 2:
        raise ParameterError(
            f"the pair has halves = {pair.halves}; the component is double helical: halves = 2"
        )
    notes = (*job.unread, *job.unused(), *backlash_notes(job))
    backlash = backlash_of(job)
    if mesh.backlash is None and pair.normal_backlash < _NONE:
        notes += (
            f"backlash assumed: {1e6 * backlash:.4g} um, {USUAL_BACKLASH:g} of the module, as the "
            "teeth are not thinner than nominal; give [mesh] backlash or tooth_thickness_allowance",
        )
    bodies, shafts = pair.half_body, pair.gap_shaft
    values = PairValues(
        number_of_teeth=(float(pair.number_of_teeth[0]), float(pair.number_of_teeth[1])),
        base_radius=pair.base_radius,
        half_mass=(bodies[0].mass, bodies[1].mass),
        half_inertia=(bodies[0].inertia, bodies[1].inertia),
        shaft_radial=(shafts[0].radial, shafts[1].radial),
        shaft_axial=(shafts[0].axial, shafts[1].axial),
        shaft_torsional=(shafts[0].torsional, shafts[1].torsional),
        base_helix_angle=pair.base_helix_angle,
        working_pressure_angle=pair.working_transverse_pressure_angle,
        face_width=pair.face_width,
        backlash=backlash,
        coast_phase=_coast_phase(pair, backlash) % 1.0,
        total_contact_ratio=pair.total_contact_ratio,
        mesh_damping_ratio=mesh.damping_ratio,
        shaft_damping_ratio=mesh.shaft_damping_ratio,
        bearing_damping_ratio=mesh.bearing_damping_ratio,
    )
    return values, notes


def backlash_of(job: GearJob) -> float:
    """Normal backlash [m] that runs take: what is given, that of the geometry, or a usual one."""
    if job.mesh.backlash is not None:
        return job.mesh.backlash
    geometric = job.pair.normal_backlash
    return geometric if geometric >= _NONE else USUAL_BACKLASH * job.pair.normal_module


def backlash_notes(job: GearJob) -> tuple[str, ...]:
    """Lines on a backlash by the geometry that is large, or that runs do not take."""
    geometric, given = job.pair.normal_backlash, job.mesh.backlash
    lines = []
    if geometric > _LARGE * job.pair.normal_module:
        lines.append(
            f"normal backlash {1e6 * geometric:.4g} um by center distance, profile shift and tooth "
            f"thickness is more than {_LARGE:g} of the module; in a gear file "
            'profile_shift_coefficient = "auto" follows from the center distance'
        )
    if given is not None and geometric >= _NONE and abs(given - geometric) > _SAME * geometric:
        lines.append(
            f"runs take [mesh] backlash = {1e6 * given:.4g} um; by center distance, profile shift "
            f"and tooth thickness it is {1e6 * geometric:.4g} um"
        )
    return tuple(lines)


def coast_periods(job: GearJob) -> int:
    """Whole mesh periods that the coast phase of a pair leaves out; they tell teeth apart."""
    return math.floor(_coast_phase(job.pair, backlash_of(job)))


def _coast_phase(pair: GearPair, backlash: float) -> float:
    """Phase of the drive flank of a pinion tooth plus that of its coast flank [mesh periods].

    A pinion tooth of thickness s_w at the working circle touches at the pitch point with one flank,
    and s_w / p_w of a pitch later with the other. On either line of action the phase begins where
    contact does, the distance A C before; on the coast flank it runs backwards, and the contact
    lines lean the other way: p_drive + p_coast = s_w / p_w + (2 A C + b tan(beta_b)) / p_bt. s_w
    has the pinion's allowance, and half of what backlash there is beyond that of the geometry.
    """
    points, pitch = pair.path_of_contact, pair.transverse_base_pitch
    shift = pair.profile_shift_coefficient[0]
    thickness = 0.5 * math.pi + 2.0 * shift * math.tan(pair.normal_pressure_angle)
    thickness *= pair.transverse_module
    angle = thickness / pair.reference_radius[0] + 2.0 * (
        involute(pair.transverse_pressure_angle) - involute(pair.working_transverse_pressure_angle)
    )
    of_pitch = angle * pair.number_of_teeth[0] / (2.0 * math.pi)
    beyond = 0.5 * (backlash - pair.normal_backlash)
    allowance = pair.tooth_thickness_allowance[0] * math.cos(pair.normal_pressure_angle)
    thinned = (beyond - allowance) / math.cos(pair.base_helix_angle)
    overlap = pair.face_width * math.tan(abs(pair.base_helix_angle))
    along = 2.0 * (points.pitch - points.start) - thinned + overlap
    return of_pitch + along / pitch
