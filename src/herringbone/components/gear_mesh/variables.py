"""Variables of the gear mesh: with the values of the shipped pair."""

import math

from herringbone.components.gear_mesh.of_pair import of_pair
from herringbone.components.ports import HALVES, flange_body
from herringbone.components.shipped_pair import SHIPPED_PAIR
from herringbone.core import Variable, input_, local, output, parameter, state
from herringbone.core.declaring.roles import GEARS, SIDES, Quantity
from herringbone.core.declaring.units import RATES

_SHIPPED = of_pair(SHIPPED_PAIR, {})
_DEFLECTION_SIZE, _SPEED_SIZE, _FREQUENCY_SIZE = 1e-6, 100.0, 1e3
"""Nominal deflection [m, rad], shaft speed [rad/s] and angular frequency of vibration [rad/s]."""


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
        local(
            "first_angle", "rad", "mean angle of the pinion's halves at the end of initialisation"
        ),
    ]


def _of_pair(
    name: str,
    unit: str,
    description: str,
    *,
    minimum: float = -math.inf,
    maximum: float = math.inf,
    quantity: Quantity | None = None,
    place: str = "",
) -> Variable:
    """A parameter with the value of the shipped pair."""
    return parameter(
        name,
        unit,
        description,
        _SHIPPED[name],
        minimum=minimum,
        maximum=maximum,
        quantity=quantity,
        place=place,
    )


def _gear_parameters(gear: str) -> list[Variable]:
    of, p = _of_pair, parameter
    return [
        of(f"{gear}.number_of_teeth", "1", "number of teeth", minimum=1,
           quantity=Quantity.NUMBER_OF_TEETH, place=gear),
        of(f"{gear}.base_radius", "m", "base radius", minimum=1e-6,
           quantity=Quantity.BASE_RADIUS, place=gear),
        of(f"{gear}.mass", "kg", "mass of one half", minimum=1e-9),
        of(f"{gear}.inertia", "kg.m2", "inertia of one half", minimum=1e-12),
        of(f"{gear}.shaft_stiffness_y", "N/m", "gap shaft, bending and shear", minimum=0),
        of(f"{gear}.shaft_stiffness_z", "N/m", "gap shaft, tension", minimum=0),
        of(f"{gear}.shaft_stiffness_t", "N.m/rad", "gap shaft, torsion", minimum=0),
        of(f"{gear}.shaft_damping_y", "N.s/m", "gap shaft, bending and shear", minimum=0),
        of(f"{gear}.shaft_damping_z", "N.s/m", "gap shaft, tension", minimum=0),
        of(f"{gear}.shaft_damping_t", "N.m.s/rad", "gap shaft, torsion", minimum=0),
        p(f"{gear}.torque_share_left", "1", "left half's share of the flange torque", 0.5,
          minimum=0, maximum=1),
        p(f"{gear}.unbalance", "kg.m", "unbalance of the gear, half of it at each half", 0.0,
          minimum=0),
        p(f"{gear}.unbalance_phase", "rad", "angle of the unbalance from +y at angle 0", 0.0),
    ]  # fmt: skip


def _mesh_parameters() -> list[Variable]:
    of, p = _of_pair, parameter
    return [
        of("base_helix_angle", "rad", "base helix angle beta_b", minimum=-1.2, maximum=1.2),
        of("face_width", "m", "face width of a half: whose table it is", minimum=1e-6),
        of("mesh_damping_ratio", "1", "zeta of the mesh damping", minimum=0),
        p("damping_transition", "m", "deflection over which the damping rises", 5e-7,
          minimum=1e-12),
        p("damping_gate", "1", "1: damping rises over damping_transition, 0: it always acts", 1.0,
          minimum=0, maximum=1, whole=True),
        of("backlash", "m", "normal backlash", minimum=0),
        p("flank", "1", "whose line of action y is: -1 coast, else drive", 1.0,
          minimum=-1, maximum=1, whole=True, quantity=Quantity.CARRYING_FLANK),
        of("coast_phase", "1",
           "phase of the drive flank plus that of the coast flank, mesh periods"),
        of("total_contact_ratio", "1",
           "epsilon_gamma of a half: where teeth enter on flanks whose phase falls", minimum=0),
        p("stagger", "1", "right half ahead of left half, mesh periods", 0.0),
        p("symmetry_deviation", "m", "f_A: axial offset of the chevron's apex", 0.0,
          minimum=-0.01, maximum=0.01),
        p("symmetry_constant", "1", "c0: constant share of f_A", 0.4),
        p("symmetry_pinion", "1", "c1: share of f_A that turns with the pinion", 0.3),
        p("symmetry_wheel", "1", "c2: share of f_A that turns with the wheel", 0.3),
        p("symmetry_pinion_phase", "rad", "phi1", 0.0),
        p("symmetry_wheel_phase", "rad", "phi2", 1.0),
        p("impact_force", "N", "peak of the meshing impact, 0: off", 0.0, minimum=0,
          quantity=Quantity.IMPACT_FORCE),
        p("impact_duration", "1", "length of the impact, mesh periods", 0.2,
          minimum=1e-6, maximum=1),
        p("pinion_restraint", "N/m", "axial stiffness of the pinion against ground, 0: it floats",
          0.0, minimum=0),
        p("pinion_axial_drag", "N.s/m", "axial drag of each pinion half against ground", 50.0,
          minimum=0),
        p("drag_torque", "N.m", "drag torque on the pinion", 0.0, minimum=0),
        p("ramp_turns", "1", "pinion turns in which errors, deviations, unbalance come in", 1.0,
          minimum=0),
        p("micro_step", "s", "longest Runge-Kutta step", 2.5e-6, minimum=1e-9, maximum=1e-4,
          tunable=True, quantity=Quantity.MICRO_STEP),
    ]  # fmt: skip


VARIABLES = (
    *_states(),
    *_ports(),
    *_results(),
    *_gear_parameters("pinion"),
    *_gear_parameters("wheel"),
    *_mesh_parameters(),
)
