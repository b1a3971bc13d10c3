r"""Resonance ratio N and dynamic factor K_v of a pair by ISO 6336-1, method B.

    m_red  = m1 m2 / (m1 + m2),  m_i = pi/8 rho (1 - q_i^4) d_mi^4 / d_bi^2    [kg/m of face width]
             d_m = (d_a + d_f) / 2,  q = d_i / d_m with the bore d_i
    n_E1   = sqrt(c_gamma_alpha / m_red) / z1  [rad/s],   N = n1 / n_E1
    N_S    = 0.85, below 100 N/mm of specific load 0.5 + 0.35 sqrt(F_t K_A / (b 100 N/mm))

    B_p = c' f_pb,eff / w,   B_f = c' f_falpha,eff / w,   B_k = |1 - c' C_a / w|,   w = F_t K_A / b

    subcritical     N <= N_S           K_v = 1 + N (C_v1 B_p + C_v2 B_f + C_v3 B_k)
    main resonance  N_S < N <= 1.15    K_v = 1 + C_v1 B_p + C_v2 B_f + C_v4 B_k
    supercritical   N >= 1.5           K_v = C_v5 B_p + C_v6 B_f + C_v7
    intermediate    1.15 < N < 1.5     linear between both ends

    e           C_v1  C_v2          C_v3            C_v4                    C_v5  C_v6
    1 to 2      0.32  0.34          0.23            0.90                    0.47  0.47
    above 2     0.32  0.57/(e-0.3)  0.096/(e-1.56)  (0.57-0.05 e)/(e-1.44)  0.47  0.12/(e-1.74)
    C_v7: 0.75 up to 1.5, 0.125 sin(pi (e-2)) + 0.875 up to 2.5, then 1

with e = epsilon_gamma of one half. In a double-helical pair F_t and b are those of both halves. The
method takes the pair as one mass on one spring: bearings, shafts and housing are left out, which
the simulated system has.

Source: ISO 6336-1:2006, clause 6, method B. A design relief counts for classes finer than 6 only,
B_k = 1 otherwise. The accuracy is by ISO 1328-1:2013; ISO 6336-1:2006 refers to the edition of
1995, whose classes have other values.
"""

import math
from dataclasses import dataclass

from herringbone.core import ParameterError
from herringbone.gears.accuracy.iso1328 import flank_tolerances
from herringbone.gears.geometry.gear_pair import GearPair

_FULL_LOAD = 1e5
"""Specific load [N/m] below which resonance is broader."""
_RUNNING_IN, _MOST_RUN_IN = 0.075, 3e-6
"""Part of a deviation that running in takes off case-hardened or nitrided flanks, at most [m]."""
_RELIEF_COUNTS_BELOW = 6
RESONANCE_ENDS, SUPERCRITICAL = 1.15, 1.5


@dataclass(frozen=True)
class Deviations:
    """Effective deviations of the worse gear, after running in [m].

    Attributes:
        base_pitch: f_pb,eff, transverse.
        profile_form: f_falpha,eff.
        tip_relief: C_a at the beginning and the end of the path; None: its factor B_k is 1.
    """

    base_pitch: float
    profile_form: float
    tip_relief: float | None = None


@dataclass(frozen=True)
class DynamicFactor:
    """N and K_v of a pair, and what they follow from.

    Attributes:
        reduced_mass: m_red, per face width [kg/m].
        resonance_speed: n_E1 of the pinion [rad/s].
        resonance_ratio: N.
        lower_limit: N_S, where main resonance begins.
        speed_range: subcritical, main resonance, intermediate or supercritical.
        specific_load: F_t K_A / b [N/m].
        pitch_effect: B_p.
        profile_effect: B_f.
        relief_effect: B_k.
        factor: K_v.
    """

    reduced_mass: float
    resonance_speed: float
    resonance_ratio: float
    lower_limit: float
    speed_range: str
    specific_load: float
    pitch_effect: float
    profile_effect: float
    relief_effect: float
    factor: float


def effective_deviations(pair: GearPair, grade: int, tip_relief: float = 0.0) -> Deviations:
    """Deviations of case-hardened gears of a tolerance class, run in.

    f_pb = f_pT cos(alpha_t) and f_falpha = f_falphaT of the worse gear, less 7.5 %, at most 3 um.

    Args:
        pair: gear pair.
        grade: ISO 1328-1 tolerance class.
        tip_relief: C_a, designed [m].

    Raises:
        ParameterError: see `flank_tolerances`.
    """
    limits = [flank_tolerances(pair, gear, grade) for gear in range(2)]
    pitch = max(limit.single_pitch for limit in limits) * math.cos(pair.transverse_pressure_angle)
    form = max(limit.profile_form for limit in limits)
    pitch, form = (value - min(_RUNNING_IN * value, _MOST_RUN_IN) for value in (pitch, form))
    return Deviations(pitch, form, tip_relief if grade < _RELIEF_COUNTS_BELOW else None)


def dynamic_factor(
    pair: GearPair,
    torque: float,
    speed: float,
    deviations: Deviations,
    *,
    load_factor: float = 1.0,
    blank_factor: float = 1.0,
) -> DynamicFactor:
    """N and K_v.

    Args:
        pair: gear pair.
        torque: nominal, of the pinion [N m].
        speed: of the pinion [rad/s].
        deviations: effective.
        load_factor: K_A, times the factor of uneven load paths if there are several.
        blank_factor: C_R, 1 for solid gears.

    Raises:
        ParameterError: torque, load factor or speed not positive, or see `iso6336_stiffness`.
    """
    for name, value, unit in (
        ("torque", torque, " N m"), ("load factor", load_factor, ""), ("speed", speed, " rad/s")
    ):  # fmt: skip
        if not 0.0 < value < math.inf:
            raise ParameterError(f"dynamic factor: {name} {value:g}{unit} must be positive")
    force = load_factor * pair.tooth_forces(torque).pair.tangential_reference
    load = force / (pair.halves * pair.face_width)
    stiffness = pair.iso6336_stiffness(force, blank_factor)
    mass = reduced_mass(pair)
    resonance = math.sqrt(stiffness.mesh_alpha / mass) / pair.number_of_teeth[0]
    ratio = speed / resonance
    limit = 0.5 + 0.35 * math.sqrt(min(1.0, load / _FULL_LOAD))
    effects = (
        stiffness.single * deviations.base_pitch / load,
        stiffness.single * deviations.profile_form / load,
        1.0 if deviations.tip_relief is None
        else abs(1.0 - stiffness.single * deviations.tip_relief / load),
    )  # fmt: skip
    name, factor = _factor(pair.total_contact_ratio, ratio, limit, effects)
    return DynamicFactor(mass, resonance, ratio, limit, name, load, *effects, factor)


def reduced_mass(pair: GearPair) -> float:
    """m_red of both gears on the line of action, per face width [kg/m]."""
    inverse = 0.0
    for gear in range(2):
        mean = pair.tip_radius[gear] + pair.root_radius[gear]
        hollow = 1.0 - (pair.bore_diameter[gear] / mean) ** 4
        base = 2.0 * pair.base_radius[gear]
        inverse += 8.0 * base**2 / (math.pi * pair.density * hollow * mean**4)
    return 1.0 / inverse


def _factor(
    contact_ratio: float, ratio: float, limit: float, effects: tuple[float, float, float]
) -> tuple[str, float]:
    """Name of the range of N, and K_v there."""
    c1, c2, c3, c4, c5, c6, c7 = _coefficients(contact_ratio)
    pitch, profile, relief = effects
    resonant = 1.0 + c1 * pitch + c2 * profile + c4 * relief
    above = c5 * pitch + c6 * profile + c7
    if ratio <= limit:
        return "subcritical", 1.0 + ratio * (c1 * pitch + c2 * profile + c3 * relief)
    if ratio <= RESONANCE_ENDS:
        return "main resonance", resonant
    if ratio >= SUPERCRITICAL:
        return "supercritical", above
    share = (SUPERCRITICAL - ratio) / (SUPERCRITICAL - RESONANCE_ENDS)
    return "intermediate", above + share * (resonant - above)


def _coefficients(e: float) -> tuple[float, ...]:
    """C_v1 to C_v7 at a total contact ratio."""
    last = 0.75 if e <= 1.5 else 0.125 * math.sin(math.pi * (e - 2.0)) + 0.875 if e <= 2.5 else 1.0
    if e <= 2.0:
        return 0.32, 0.34, 0.23, 0.90, 0.47, 0.47, last
    return (
        0.32,
        0.57 / (e - 0.3),
        0.096 / (e - 1.56),
        (0.57 - 0.05 * e) / (e - 1.44),
        0.47,
        0.12 / (e - 1.74),
        last,
    )
