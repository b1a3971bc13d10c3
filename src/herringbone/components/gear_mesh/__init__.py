r"""Herringbone gear pair: four half-bodies, two gap shafts, two meshes, 12 degrees of freedom.

**Bodies.** 1 pinion left, 2 pinion right, 3 wheel left, 4 wheel right; each moves along the line
of action (y), along the axis (z) and about it (theta). y points where the driving pinion flank
pushes the wheel; z from the right half to the left one; rotations are positive in driving sense, so
that a positive rotation of either gear moves its flank to +y. s = +1 left, -1 right; beta_b is the
base helix angle. `flank` says which flank carries: 1 drive, -1 coast (torque reversed). y then is
the line of action of that flank (on coast, its negative direction), which the bearings must know.

**Rigid approach** of the flanks, normal to them:

    delta_L = cos(beta_b) (y1 - y3 + rb1 theta1 - rb2 theta3) + sin(beta_b) a_L
    delta_R = cos(beta_b) (y2 - y4 + rb1 theta2 - rb2 theta4) - sin(beta_b) a_R
    a_L = z1 - z3 + eps_z,    a_R = z2 - z4 + eps_z
    eps_z = f_A (c0 + c1 cos((theta1 + theta2) / 2 + phi1) + c2 cos((theta3 + theta4) / 2 + phi2))

f_A is the symmetry deviation: the axial offset of the chevron's apex, with a constant part and the
run-outs of pinion and wheel. It is never inside the stiffness table.

**Contact** on the drive flank and on the coast flank, each with its depth x > 0 (otherwise open),

    drive: x = delta - e_drive,    coast: x = -backlash - delta - e_coast

e is R times the given transmission error of `tooth_errors`: of each side and flank the sum of
amplitude cos(order theta + phase), theta the angle of the own half of the gear that is named; it is
normal to the flank, positive where material is missing. It moves all pairs of teeth alike. Errors
of single teeth share out the load anew as soon as they are of the size of the deflection (2.4 um at
200 N m): use `tooth_deviations`. With the unloaded transmission error of teeth of class 6 for e,
mesh harmonics 1 to 4 of the loaded one are 2.3, 0.22, 5.1 and 2.1 times those they should be
(27/81 pair, 200 N m), and the mean tangent stiffness is 877 N/um in place of 598.

**Deviations of single teeth** (`tooth_deviations`, with `pair_law`). On a flank of a side that has
them, F and U are sums over pairs of teeth. At the phase p of the flank the pair n is at q = p - n;
it is tooth n mod z, counted from 0, of pinion and wheel. All pairs count whose q lies between the
first and the last node of the law: n = floor(p) + 1, too, as the first node lies before 0. On the
coast flank this counts teeth by the phase of that flank. With position P, profile A, helix H of the
file (pinion 1, wheel 2), the contact ratios eps_a and eps_b of the law's pair, and m(q), h(q) of
`Force law of a pair of teeth` below,

    x = depth + R (P1 + P2 + (A1 - A2) ((q - eps_b (1 - m)) / eps_a - 1/2) + (H1 + H2) (m - 1/2))
    y = R h ((A1 - A2) eps_b / eps_a + H1 + H2)
    U = sum over n of U_pair(q, x, y),   F = dU/d(depth),   k = d2U/d(depth)2

dU/dp is taken with everything that depends on q. Such a flank may touch while its depth is below 0;
it is open where F <= 0. In `Pressure` below, depth stands for x, but the x of r is the mean
(sum of x dU_pair/dx + y dU_pair/dy) / F. Ungated damping takes k of ideal teeth.
Without deviations the sum is F of the stiffness table, but for the interpolation: its mesh
harmonics 1 to 4 within 1 % (the fourth 3 % at 8 um). Against the load distribution with all gaps
see `herringbone.gears.stiffness.pair_law`. Such a run takes four times as long.

**Ramp.** Errors, deviations and unbalance come in over the first turns of the pinion, so that a run
can start in equilibrium: with theta_m = (theta1 + theta2) / 2 and
t = |theta_m - first_angle| / (2 pi ramp_turns), at most 1,

    R = t^3 (10 - 15 t + 6 t^2);   ramp_turns 0: R = 1

first_angle is theta_m at the end of initialisation, that of the start values.

**Phase** of the contact lines, in mesh periods, p_bt = 2 pi rb1 / z_1:

    p_L = z_1 / (2 pi) theta1 + tan(beta_b) a_L / p_bt
    p_R = z_1 / (2 pi) theta2 - tan(beta_b) a_R / p_bt + stagger
    on the coast flank: coast_phase - p

The teeth are symmetric, so the coast flank has the table of its side, run through backwards. A
contact line lies at s = (p + j) p_bt (j: any whole number) from the start A of the path of contact,
at the end of the face that leads; the coast flank of the same pinion tooth meets the other line of
action, and the other end leads there. With the pinion's base tooth thickness the sum of both is

    coast_phase = 2 g / p_bt + 1/2 + b tan|beta_b| / p_bt - backlash / (2 cos(beta_b) p_bt)

g: path of approach, sqrt(ra2^2 - rb2^2) - rb2 tan(alpha_wt), for teeth that are as thick as their
spaces at the working circle but for the backlash, of which each gear has half. Add half of what the
pinion's teeth are thicker, along the base circle and over p_bt. Whole periods do not matter.

**Pressure** P of a contact, from the force law F(p, x) of its side with tangent k, and the
energy U(p, x) (both below); x' is the depth's rate:

    damping_gate 1: P = max(0, F(p, x) + q r h(p) + C r x')       (0 where F <= 0)
    damping_gate 0: P = F(p, x) + q r h(p) + C x';  both flanks open: P = C x' on the drive flank,
                    with k at x = 1e-12 m (of a flank with deviations at max(x, 1e-12 m))
    C = 2 zeta sqrt(max(0, k) m_e),   m_e = 1 / (rb1^2 / I_pinion + rb2^2 / I_wheel),   I: of a half
    r = v^2 (3 - 2 v),   v = min(1, x / damping_transition)

C is the corrected form of the thesis' mesh damping, whose base radii are swapped. Gated, damping
rises smoothly with the contact and never pulls. Ungated, it acts across the backlash, too, and may
pull, as in the oscillators of the literature; no teeth do so. It matters where teeth separate: the
clearance oscillator of A. Kahraman and R. Singh (J. Sound Vib. 142, 1990: damping ratio 0.05, mean
force 0.1, alternating force 0.05 times the frequency squared), swept downwards, falls back from
separation to contact at 0.71 of its natural frequency ungated, at 0.58 gated: in free flight
nothing is lost. Without separation both are the same above the transition.

h is the meshing impact of the flank that carries: q is impact_force there, 0 on the other flank;
h(p) = (1 - cos(2 pi f / impact_duration)) / 2 where f is below impact_duration, else 0. f is how
many mesh periods ago teeth entered: the fractional part of p where the phase p of the contact
rises, that of total_contact_ratio - p where it falls. With w = theta1', it rises on the drive flank
where w >= 0, on the coast flank where w <= 0.

**Normal force** of a mesh: N = P on the drive flank, -P on the coast flank (their sum, if both
should touch).

**Reactions** (virtual work): a contact does the power P x' and stores U(p, x), so that every
generalised force is -(N d(delta)/dq + dU/dp dp/dq) + P de/dq, and on theta_m, which R follows,
-dU/dR dR/dtheta_m, half of it on either half of the pinion. With E = (dU/dp)_drive -
(dU/dp)_coast of a mesh, path force cos(beta_b) N and push G = cos(beta_b) N + E / p_bt:

    f_y: -+ cos(beta_b) N                          (pinion -, wheel +)
    f_z: -+ s tan(beta_b) G
    torque on theta1, theta2: - rb1 G + P de/dtheta - M de_z/d(mean pinion angle) / 2
    torque on theta3, theta4: + rb2 cos(beta_b) N + P de/dtheta - M de_z/d(mean wheel angle) / 2
    torque on theta1 and theta2 as well: - 1/2 dR/dtheta_m sum of dU/dR at constant depth
    M = tan(beta_b) (G_L - G_R)

de/dtheta of theta1 and theta2 includes what R has of theta_m, on both sides.

**Equations of motion** (first index: this half, other: the half of the same gear; f, tau are the
inputs; mesh: as above):

    m y'' = f_y - k_y (y - y_other) - c_y (y' - y_other') + mesh
    m z'' = f_z - k_z (z - z_other) - c_z (z' - z_other') + mesh
            - pinion_restraint (z1 + z2) / 4 - pinion_axial_drag z'              (pinion only)
    I theta'' = share tau + k_t (theta_other - theta) + c_t (theta_other' - theta') + mesh
            - drag_torque theta' / (2 sqrt(1 + theta'^2))                        (pinion only)

share: torque_share_left for the left half, the rest for the right one. `pinion_restraint` holds the
pinion axially against ground at the mean of its halves (0: it floats). With an unbalance u of the
gear, half of it at each half, at psi = theta + unbalance_phase from +y, the equations of y and
theta of a half (right-hand sides f and t) become, with R' = dR/dtheta_m theta_m',

    m y'' - R u/2 sin(psi) theta'' = f + R u/2 cos(psi) theta'^2 + R' u/2 sin(psi) theta'
    I theta'' - R u/2 sin(psi) y'' = t + R' u/2 sin(psi) y'
    on theta1 and theta2 as well: - 1/2 dR/dtheta_m u/2 sin(psi) theta' y' of each half with one

States are theta1 ("angle"), the twists theta2 - theta1 and theta4 - theta3, and
rb1 theta1 - rb2 theta3 ("approach"), so that precision does not decay with the number of
revolutions. A flange moves with the mean of its two halves, weighted by their torque shares:
otherwise power would be created.

**Outputs.** `mesh_*.force` is N; `mesh_*.deflection` is delta - e_drive, or delta + e_coast if the
coast flank carries: the deflection of the teeth while they touch. `transmission_error` is the mean
of both halves' rb1 theta_pinion - rb2 theta_wheel. `time_outside_table` and `time_on_other_flank`
(not outputs, but variables of the FMU) add up communication steps at whose end a mesh is loaded
outside its table, or on the flank that does not carry; there the direction of the separating force
is wrong. With deviations the mean depth counts there.

**Integration**: classical Runge-Kutta with `micro_step`. A micro step in which a force bends (teeth
meet or part, their damping becomes whole, or would pull) is taken again in 8 parts, as its order is
lost there. The default keeps the error of the bearing forces below 1e-5, also when teeth separate.
On the test rig at 1000 r/min, against micro steps of 0.2 us:

    micro step      2.5 us    3.3 us    5 us      10 us
    loaded teeth    8.8e-8    2.8e-7    1.4e-6    2.2e-5
    separation      1.3e-6    1.0e-6    6.6e-6    7.5e-5

**Refused**: teeth that do not fit the base radii (z1 / z2 against rb1 / rb2, 1e-3), and a table
whose line `# pair: z1 z2 rb1 rb2 beta_b b` differs from the parameters (teeth; the others by 1e-4).
A table without that line is taken, and `table_of_this_pair` stays 0. Deviations of teeth are
refused without the law of a pair of teeth, with that of another pair (its line `# pair_law:` begins
like the table's), and with another number of teeth.

**Limits.** y is one direction: while flanks of both kinds carry in turn, the separating force is
right on one of them only. No friction, no tilting of the bodies.

Sources: the thesis, chapter 3, with the corrections derived from virtual work; the torque of the
energy over phase: see A. Oh, K. Grosh and J. R. Barber, Energy conserving equations of motion for
gear systems, J. Vib. Acoust. 127 (2005). Geometry, masses, shaft stiffnesses and the stiffness
table are those of the pair in `gear_pair.toml`; `herringbone gear` computes them, and those of
other pairs.
"""

import inspect
import math

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh import motion
from herringbone.components.gear_mesh.beyond import BEYOND
from herringbone.components.gear_mesh.frozen import freeze_mesh
from herringbone.components.gear_mesh.laws import LAWS
from herringbone.components.gear_mesh.loading import LOADER
from herringbone.components.gear_mesh.of_pair import of_pair
from herringbone.components.gear_mesh.ramp import start
from herringbone.components.resources import pair_law, tooth_deviations, transmission_error
from herringbone.core import Component, Kernels
from herringbone.kernels import force_law, steppers, tooth_pair_law

_EQUATIONS = "\n".join([
    __doc__,
    "### Force law\n",
    inspect.cleandoc(force_law.__doc__),
    "\n### Force law of a pair of teeth\n",
    inspect.cleandoc(tooth_pair_law.__doc__),
    "\n### Files of teeth\n",
    inspect.cleandoc(tooth_deviations.__doc__),
    "",
    inspect.cleandoc(pair_law.__doc__),
])  # fmt: skip
_CLOSED = 5e-6  # a usual deflection [m], where the search for an equilibrium begins


def _guess(block: np.ndarray) -> None:
    """Both meshes closed on the flank that carries, whatever deviations there are.

    The ramp of these begins where the search ends: while it turns the pinion, nothing comes in.
    """
    closed = abs(block[at.F_A]) * math.tan(abs(block[at.BETA])) + _CLOSED
    if block[at.RAMP_TURNS] > 0.0:
        block[at.RAMP_TURNS] = math.inf
    else:
        of_teeth = tooth_deviations.largest(block, at.DEVIATIONS)
        of_teeth += transmission_error.largest(block, at.ERRORS)
        closed += of_teeth / math.cos(block[at.BETA])
    if block[at.FLANK] < 0.0:
        closed = -closed - block[at.BACKLASH] / math.cos(block[at.BETA])
    block[at.APPROACH] = closed


GEAR_MESH = Component(
    at.DECLARATION,
    Kernels(motion.step, motion.rhs, motion.out),
    _EQUATIONS,
    load=LOADER,
    verify=LOADER.verify,
    start=start,
    guess=_guess,
    motion=motion.motions,
    indicators=motion.indicators,
    indicator_count=4,
    longest_step=steppers.longest_step(at.DECLARATION, "micro_step"),
    freeze=freeze_mesh,
    of_pair=of_pair,
    laws=LAWS,
    beyond=BEYOND,
)
