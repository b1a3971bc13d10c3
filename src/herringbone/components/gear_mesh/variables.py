"""Variables of the gear mesh: with the values of the shipped pair."""

import math

from herringbone.components.ports import HALVES, flange_body
from herringbone.core import Variable, input_, local, output, parameter, state
from herringbone.core.roles import GEARS, SIDES, Quantity
from herringbone.core.units import RATES

_MODULE, _PRESSURE_ANGLE, _HELIX_ANGLE = 3.5e-3, math.radians(20.0), math.radians(30.0)
_PINION_TEETH, _WHEEL_TEETH = 27, 81
_TRANSVERSE_ANGLE = math.atan(math.tan(_PRESSURE_ANGLE) / math.cos(_HELIX_ANGLE))
_BASE_HELIX_ANGLE = math.asin(math.sin(_HELIX_ANGLE) * math.cos(_PRESSURE_ANGLE))
_BASE_RADIUS = tuple(
    0.5 * z * _MODULE / math.cos(_HELIX_ANGLE) * math.cos(_TRANSVERSE_ANGLE)
    for z in (_PINION_TEETH, _WHEEL_TEETH)
)
_FACE_WIDTH = 0.0473
_BACKLASH = 180e-6


def _coast_phase() -> float:
    """Phase of the drive flank plus that of the coast flank, in [0, 1): see the equations."""
    pitch = 2.0 * math.pi * _BASE_RADIUS[0] / _PINION_TEETH
    tip = 0.5 * _WHEEL_TEETH * _MODULE / math.cos(_HELIX_ANGLE) + _MODULE
    approach = math.sqrt(tip**2 - _BASE_RADIUS[1] ** 2)
    approach -= _BASE_RADIUS[1] * math.tan(_TRANSVERSE_ANGLE)
    thinned = 0.5 * _BACKLASH / math.cos(_BASE_HELIX_ANGLE)
    overlap = _FACE_WIDTH * math.tan(_BASE_HELIX_ANGLE)
    return (0.5 + (2.0 * approach - thinned + overlap) / pitch) % 1.0


_SHAFT_DAMPING_RATIO = 0.02
_DEFLECTION_SIZE, _SPEED_SIZE, _FREQUENCY_SIZE = 1e-6, 100.0, 1e3
"""Nominal deflection [m, rad], shaft speed [rad/s] and angular frequency of vibration [rad/s]."""
_MASS = {"pinion": 6.500, "wheel": 47.739}
_INERTIA = {"pinion": 7.380e-3, "wheel": 0.5813}
_SHAFT = {  # gap shaft: y [N/m], z [N/m], rotation [N m/rad]
    "pinion": (4.192e9, 1.671e10, 7.637e6),
    "wheel": (5.774e10, 1.732e11, 8.220e8),
}


def _shaft_damping(gear: str) -> tuple[float, float, float]:
    """2 % of the local critical damping of the two halves against each other."""
    bodies = (_MASS[gear], _MASS[gear], _INERTIA[gear])
    radial, axial, torsional = (
        2.0 * _SHAFT_DAMPING_RATIO * math.sqrt(k * m / 2.0)
        for k, m in zip(_SHAFT[gear], bodies, strict=True)
    )
    return radial, axial, torsional


def _states() -> list[Variable]:
    bodies = [
        state(f"{axis}_{i + 1}", "m", f"{axis} of {half}", nominal=_DEFLECTION_SIZE)
        for axis in "yz"
        for i, half in enumerate(HALVES)
    ]
    rotations = [
        state("angle", "rad", "angle of the pinion's left half", steady="rotating"),
        state("pinion_twist", "rad", "pinion, right half ahead of left half",
              nominal=_DEFLECTION_SIZE),
        state("approach", "m", "rb1 theta1 - rb2 theta3 of the left halves",
              nominal=_DEFLECTION_SIZE),
        state("wheel_twist", "rad", "wheel, right half ahead of left half",
              nominal=_DEFLECTION_SIZE),
    ]  # fmt: skip
    positions = bodies + rotations
    return positions + [
        state(
            f"der({v.name})",
            RATES[v.unit],
            f"rate of {v.name}",
            nominal=_SPEED_SIZE if v.name == "angle" else _FREQUENCY_SIZE * v.nominal,
        )
        for v in positions
    ]


def _ports() -> list[Variable]:
    ports = []
    for half in HALVES:
        for axis in "yz":
            # An unbalance couples y with the rotation.
            through = (f"{half.partition('_')[0]}.tau",) if axis == "y" else ()
            force, s, v, a = (f"{half}.{q}_{axis}" for q in "fsva")
            at = f"of {half} along {axis}"
            ports += [
                input_(force, "N", f"force on {half} along {axis}"),
                output(s, "m", f"position {at}", nodes=True, rate=v),
                output(v, "m/s", f"velocity {at}", nodes=True, rate=a),
                output(a, "m/s2", f"acceleration {at}", feedthrough=(force, *through)),
            ]
    for gear in GEARS:
        ports += flange_body(gear, more=tuple(f"{gear}_{side}.f_y" for side in SIDES))
    return ports


def _results() -> list[Variable]:
    meshes = [
        v
        for side in SIDES
        for v in (
            output(f"mesh_{side}.force", "N", f"normal force of the {side} mesh",
                   quantity=Quantity.MESH_FORCE, place=side),
            output(f"mesh_{side}.deflection", "m", f"normal deflection of the {side} mesh",
                   quantity=Quantity.MESH_DEFLECTION, place=side),
        )
    ]  # fmt: skip
    return [
        *meshes,
        output("transmission_error", "m", "mean of the halves' rb1 theta_pinion - rb2 theta_wheel"),
        output("axial_offset", "m", "eps_z: apex of the pinion against that of the wheel"),
        local("time_outside_table", "s", "time with a mesh loaded outside its table"),
        local(
            "table_of_this_pair",
            "1",
            "1: the table tells its pair, and it is this one; 0: it tells none",
        ),
        local("time_on_other_flank", "s", "time with a mesh loaded on the flank not in `flank`"),
    ]


def _gear_parameters(gear: str, teeth: int, base_radius: float) -> list[Variable]:
    k_y, k_z, k_t = _SHAFT[gear]
    c_y, c_z, c_t = _shaft_damping(gear)
    p = parameter
    return [
        p(f"{gear}.number_of_teeth", "1", "number of teeth", teeth, minimum=1,
          quantity=Quantity.NUMBER_OF_TEETH, place=gear),
        p(f"{gear}.base_radius", "m", "base radius", base_radius, minimum=1e-6),
        p(f"{gear}.mass", "kg", "mass of one half", _MASS[gear], minimum=1e-9),
        p(f"{gear}.inertia", "kg.m2", "inertia of one half", _INERTIA[gear], minimum=1e-12),
        p(f"{gear}.shaft_stiffness_y", "N/m", "gap shaft, bending and shear", k_y, minimum=0),
        p(f"{gear}.shaft_stiffness_z", "N/m", "gap shaft, tension", k_z, minimum=0),
        p(f"{gear}.shaft_stiffness_t", "N.m/rad", "gap shaft, torsion", k_t, minimum=0),
        p(f"{gear}.shaft_damping_y", "N.s/m", "gap shaft, bending and shear", c_y, minimum=0),
        p(f"{gear}.shaft_damping_z", "N.s/m", "gap shaft, tension", c_z, minimum=0),
        p(f"{gear}.shaft_damping_t", "N.m.s/rad", "gap shaft, torsion", c_t, minimum=0),
        p(f"{gear}.torque_share_left", "1", "left half's share of the flange torque", 0.5,
          minimum=0, maximum=1),
        p(f"{gear}.unbalance", "kg.m", "unbalance of the gear, half of it at each half", 0.0,
          minimum=0),
        p(f"{gear}.unbalance_phase", "rad", "angle of the unbalance from +y at angle 0", 0.0),
    ]  # fmt: skip


def _mesh_parameters() -> list[Variable]:
    p = parameter
    return [
        p("base_helix_angle", "rad", "base helix angle beta_b", _BASE_HELIX_ANGLE,
          minimum=-1.2, maximum=1.2),
        p("face_width", "m", "face width of a half: whose table it is", _FACE_WIDTH,
          minimum=1e-6),
        p("mesh_damping_ratio", "1", "zeta of the mesh damping", 0.1, minimum=0),
        p("damping_transition", "m", "deflection over which the damping rises", 5e-7,
          minimum=1e-12),
        p("damping_gate", "1", "1: damping rises over damping_transition, 0: it always acts", 1.0,
          minimum=0, maximum=1, whole=True),
        p("backlash", "m", "normal backlash", _BACKLASH, minimum=0),
        p("flank", "1", "whose line of action y is: -1 coast, else drive", 1.0,
          minimum=-1, maximum=1, whole=True, quantity=Quantity.CARRYING_FLANK),
        p("coast_phase", "1", "phase of the drive flank plus that of the coast flank, mesh periods",
          _coast_phase()),
        p("stagger", "1", "right half ahead of left half, mesh periods", 0.0),
        p("symmetry_deviation", "m", "f_A: axial offset of the chevron's apex", 0.0),
        p("symmetry_constant", "1", "c0: constant share of f_A", 0.4),
        p("symmetry_pinion", "1", "c1: share of f_A that turns with the pinion", 0.3),
        p("symmetry_wheel", "1", "c2: share of f_A that turns with the wheel", 0.3),
        p("symmetry_pinion_phase", "rad", "phi1", 0.0),
        p("symmetry_wheel_phase", "rad", "phi2", 1.0),
        p("impact_force", "N", "peak of the meshing impact, 0: off", 0.0, minimum=0),
        p("impact_duration", "1", "length of the impact, mesh periods", 0.2,
          minimum=1e-6, maximum=1),
        p("pinion_restraint", "N/m", "axial stiffness of the pinion against ground, 0: it floats",
          0.0, minimum=0),
        p("pinion_axial_drag", "N.s/m", "axial drag of each pinion half against ground", 50.0,
          minimum=0),
        p("drag_torque", "N.m", "drag torque on the pinion", 0.0, minimum=0),
        p("micro_step", "s", "longest Runge-Kutta step", 2.5e-6, minimum=1e-9, maximum=1e-4,
          quantity=Quantity.MICRO_STEP),
    ]  # fmt: skip


VARIABLES = (
    *_states(),
    *_ports(),
    *_results(),
    *_gear_parameters("pinion", _PINION_TEETH, _BASE_RADIUS[0]),
    *_gear_parameters("wheel", _WHEEL_TEETH, _BASE_RADIUS[1]),
    *_mesh_parameters(),
)
