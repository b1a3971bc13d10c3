r"""A pair of cylindrical gears: spur, helical or double helical, from its manufacturing data.

Terms and formulas are those of ISO 21771 (involute gears) and ISO 53 (basic rack); everything is
in SI units. Values of both gears are pairs (pinion, wheel). The main relations:

    m_t = m_n / cos(beta),   tan(alpha_t) = tan(alpha_n) / cos(beta),
    sin(beta_b) = sin(beta) cos(alpha_n),   r = z m_t / 2,   r_b = r cos(alpha_t),
    inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) (x1 + x2) / (z1 + z2),
    a = (r1 + r2) cos(alpha_t) / cos(alpha_wt),
    r_a = r + m_n (h_aP + x + k),   r_f = r - m_n (h_fP - x_E).

A centre distance may be given, or follows from the profile shifts without backlash; a profile
shift that is None follows from the centre distance.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from herringbone.core import ParameterError
from herringbone.core.facts import Facts
from herringbone.gears.geometry import given
from herringbone.gears.geometry.checks import check_given, check_meshing
from herringbone.gears.geometry.contact import (
    PathOfContact,
    ToothForces,
    path_of_contact,
    tooth_forces,
)
from herringbone.gears.geometry.given import Pair, as_pair
from herringbone.gears.geometry.half_body import GapShaft, HalfBody, gap_shaft, half_body
from herringbone.gears.geometry.tooth_profile import Rack, ToothProfile, generate_tooth
from herringbone.gears.stiffness import iso6336

Given = float | Sequence[float]
_COMPLETED: Any = None
"""Default of what follows from the other values; never None in a pair that is made."""
_HUB_SHARE = 0.4


@dataclass(frozen=True, kw_only=True, repr=False)
class GearPair(Facts):
    """A cylindrical gear pair by ISO 21771.

    What is given for both gears is a pair (pinion, wheel), or one value for both.

    Args:
        number_of_teeth: z.
        normal_module: m_n [m].
        normal_pressure_angle: alpha_n [rad].
        helix_angle: beta at the reference cylinder [rad]; its sign is the hand of the left half.
        face_width: b of one half [m].
        halves: 2 for a double-helical pair, 1 for a single helix or a spur pair.
        center_distance: a [m]; if None, that of zero backlash.
        profile_shift_coefficient: x; None in one or both places: follows from the centre distance
            (equal shares if both).
        addendum_coefficient: h_aP of the basic rack, in modules.
        dedendum_coefficient: h_fP of the basic rack, in modules.
        tip_alteration_coefficient: k, in modules.
        root_fillet_radius_coefficient: rho_fP of the basic rack, in modules; if None, 0.38 or the
            largest that the rack has room for.
        tip_radius: r_a [m]; if given, it takes the place of the value from the addendum.
        tooth_thickness_allowance: E_sn [m], zero or negative: teeth thinner than nominal.
        bore_diameter: [m]; 0: solid.
        gap_width: axial gap between both halves [m].
        groove_diameter: of the gap [m]; if None, the root diameter.
        shaft_diameter: of the shaft stub at each half's outer end [m].
        stub_length: of these stubs [m].
        youngs_modulus: [Pa].
        poissons_ratio: [-].
        density: [kg/m3].

    Raises:
        ParameterError: a value is not possible, or the gears cannot mesh: undercut, pointed teeth,
            contact ratio below 1, impossible centre distance, negative backlash, tips that reach
            the mate's root.
    """

    number_of_teeth: tuple[int, int]
    normal_module: float
    normal_pressure_angle: float = math.radians(20.0)
    helix_angle: float = 0.0
    face_width: float
    halves: int = 2
    center_distance: float = _COMPLETED
    profile_shift_coefficient: Pair = (0.0, 0.0)
    addendum_coefficient: Pair = (1.0, 1.0)
    dedendum_coefficient: Pair = (1.25, 1.25)
    tip_alteration_coefficient: Pair = (0.0, 0.0)
    root_fillet_radius_coefficient: Pair = _COMPLETED
    tip_radius: Pair = _COMPLETED
    tooth_thickness_allowance: Pair = (0.0, 0.0)
    bore_diameter: Pair = (0.0, 0.0)
    gap_width: float = 0.0
    groove_diameter: Pair = _COMPLETED
    shaft_diameter: Pair = (0.0, 0.0)
    stub_length: Pair = (0.0, 0.0)
    youngs_modulus: float = 2.06e11
    poissons_ratio: float = 0.3
    density: float = 7850.0

    if TYPE_CHECKING:  # what may be given is more than what a pair holds

        def __init__(
            self,
            *,
            number_of_teeth: Sequence[int],
            normal_module: float,
            normal_pressure_angle: float = ...,
            helix_angle: float = ...,
            face_width: float,
            halves: int = ...,
            center_distance: float | None = ...,
            profile_shift_coefficient: float | Sequence[float | None] | None = ...,
            addendum_coefficient: Given = ...,
            dedendum_coefficient: Given = ...,
            tip_alteration_coefficient: Given = ...,
            root_fillet_radius_coefficient: float | Sequence[float | None] | None = ...,
            tip_radius: float | Sequence[float | None] | None = ...,
            tooth_thickness_allowance: Given = ...,
            bore_diameter: Given = ...,
            gap_width: float = ...,
            groove_diameter: float | Sequence[float | None] | None = ...,
            shaft_diameter: Given = ...,
            stub_length: Given = ...,
            youngs_modulus: float = ...,
            poissons_ratio: float = ...,
            density: float = ...,
        ) -> None: ...

    def __post_init__(self) -> None:
        for name in (
            "number_of_teeth", "addendum_coefficient", "dedendum_coefficient",
            "tip_alteration_coefficient", "tooth_thickness_allowance", "bore_diameter",
            "shaft_diameter", "stub_length", "profile_shift_coefficient",
            "root_fillet_radius_coefficient", "tip_radius", "groove_diameter",
        ):  # fmt: skip
            object.__setattr__(self, name, _pair(name, getattr(self, name)))
        check_given(self)
        object.__setattr__(self, "center_distance", given.center_distance(self))
        object.__setattr__(self, "profile_shift_coefficient", given.profile_shifts(self))
        object.__setattr__(self, "root_fillet_radius_coefficient", given.root_fillets(self))
        object.__setattr__(self, "tip_radius", given.tip_radii(self))
        groove: tuple[float | None, float | None] = self.groove_diameter
        if groove == (None, None):
            object.__setattr__(self, "groove_diameter", as_pair(2.0 * r for r in self.root_radius))
        check_meshing(self)

    # Angles, module and radii

    @cached_property
    def transverse_module(self) -> float:
        """m_t [m]."""
        return self.normal_module / math.cos(self.helix_angle)

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """alpha_t [rad]."""
        return math.atan(math.tan(self.normal_pressure_angle) / math.cos(self.helix_angle))

    @cached_property
    def working_transverse_pressure_angle(self) -> float:
        """alpha_wt [rad]."""
        return math.acos(sum(self.base_radius) / self.center_distance)

    @cached_property
    def base_helix_angle(self) -> float:
        """beta_b [rad], with the sign of the helix angle."""
        return math.asin(math.sin(self.helix_angle) * math.cos(self.normal_pressure_angle))

    @cached_property
    def gear_ratio(self) -> float:
        """u = z2 / z1."""
        return self.number_of_teeth[1] / self.number_of_teeth[0]

    @cached_property
    def reference_radius(self) -> Pair:
        """r [m]."""
        return as_pair(0.5 * z * self.transverse_module for z in self.number_of_teeth)

    @cached_property
    def reference_center_distance(self) -> float:
        """a_d = r1 + r2 [m]."""
        return sum(self.reference_radius)

    @cached_property
    def base_radius(self) -> Pair:
        """r_b [m]."""
        return as_pair(r * math.cos(self.transverse_pressure_angle) for r in self.reference_radius)

    @cached_property
    def pitch_radius(self) -> Pair:
        """r_w [m], of the working pitch circles."""
        return as_pair(
            r / math.cos(self.working_transverse_pressure_angle) for r in self.base_radius
        )

    @cached_property
    def generating_profile_shift_coefficient(self) -> Pair:
        """x_E: profile shift with which the teeth are cut, the thickness allowance included."""
        thinner = 2.0 * self.normal_module * math.tan(self.normal_pressure_angle)
        return as_pair(
            x + allowance / thinner
            for x, allowance in zip(
                self.profile_shift_coefficient, self.tooth_thickness_allowance, strict=True
            )
        )

    @cached_property
    def root_radius(self) -> Pair:
        """r_f [m]."""
        return as_pair(
            r - self.normal_module * (h - x)
            for r, h, x in zip(
                self.reference_radius,
                self.dedendum_coefficient,
                self.generating_profile_shift_coefficient,
                strict=True,
            )
        )

    @cached_property
    def form_radius(self) -> Pair:
        """r_Ff [m], where the involute begins above the root fillet."""
        return as_pair(self.tooth_profile(gear).form_radius for gear in range(2))

    @cached_property
    def tip_clearance(self) -> Pair:
        """c [m], between the gear's root and the mate's tip."""
        return as_pair(
            self.center_distance - self.root_radius[gear] - self.tip_radius[1 - gear]
            for gear in range(2)
        )

    @cached_property
    def tip_tooth_thickness(self) -> Pair:
        """s_an [m], normal tooth thickness at the tip; not positive: pointed."""
        return as_pair(
            2.0
            * self.tip_radius[gear]
            * self.tooth_profile(gear).half_angle(self.tip_radius[gear])
            * math.cos(self._helix_angle_at(gear, self.tip_radius[gear]))
            for gear in range(2)
        )

    def _helix_angle_at(self, gear: int, radius: float) -> float:
        return math.atan(math.tan(self.helix_angle) * radius / self.reference_radius[gear])

    @cached_property
    def normal_backlash(self) -> float:
        """j_bn [m]: play normal to the flanks at this centre distance."""
        turned = 0.0
        for gear in range(2):
            profile = self.tooth_profile(gear)
            turned += 2.0 * self.pitch_radius[gear] * profile.half_angle(self.pitch_radius[gear])
        pitch = 2.0 * math.pi * self.pitch_radius[0] / self.number_of_teeth[0]
        along = (pitch - turned) * math.cos(self.working_transverse_pressure_angle)
        return along * math.cos(self.base_helix_angle)

    # Contact

    @cached_property
    def transverse_base_pitch(self) -> float:
        """p_bt [m]."""
        return 2.0 * math.pi * self.base_radius[0] / self.number_of_teeth[0]

    @cached_property
    def path_of_contact(self) -> PathOfContact:
        """Points A to E on the line of action, in the transverse plane."""
        return path_of_contact(self)

    @cached_property
    def length_of_path_of_contact(self) -> float:
        """g_alpha [m]."""
        return self.path_of_contact.length

    @cached_property
    def transverse_contact_ratio(self) -> float:
        """epsilon_alpha."""
        return self.length_of_path_of_contact / self.transverse_base_pitch

    @cached_property
    def overlap_ratio(self) -> float:
        """epsilon_beta, of one half."""
        turned = self.face_width * math.sin(abs(self.helix_angle))
        return turned / (math.pi * self.normal_module)

    @cached_property
    def total_contact_ratio(self) -> float:
        """epsilon_gamma, of one half."""
        return self.transverse_contact_ratio + self.overlap_ratio

    def mesh_frequency(self, speed: float) -> float:
        """f_m [Hz] at a speed of the pinion [rad/s]."""
        return abs(speed) * self.number_of_teeth[0] / (2.0 * math.pi)

    def tooth_forces(self, torque: float) -> ToothForces:
        """Static forces in the mesh at a torque of the pinion [N m], shared by the halves."""
        return tooth_forces(self, torque)

    # Teeth and bodies

    def rack(self, gear: int) -> Rack:
        """Basic rack that cuts a gear (0 pinion, 1 wheel), in the normal section."""
        return Rack(
            module=self.normal_module,
            pressure_angle=self.normal_pressure_angle,
            dedendum=self.dedendum_coefficient[gear] * self.normal_module,
            fillet_radius=self.root_fillet_radius_coefficient[gear] * self.normal_module,
            profile_shift=self.generating_profile_shift_coefficient[gear] * self.normal_module,
        )

    def tooth_profile(self, gear: int, points: int = 200) -> ToothProfile:
        """Transverse section of a tooth of the pinion (0) or wheel (1), cut by the basic rack.

        Args:
            gear: 0 pinion, 1 wheel.
            points: on the fillet and on the involute, each.
        """
        return generate_tooth(
            self.rack(gear),
            self.number_of_teeth[gear],
            self.tip_radius[gear],
            helix_angle=self.helix_angle,
            points=points,
        )

    @cached_property
    def hub_radius(self) -> Pair:
        """Radius [m] inside which a body is rigid in tooth compliance: the bore.

        A solid gear, one with its shaft: 0.4 of the root radius.
        """
        return as_pair(
            0.5 * bore if bore > 0.0 else _HUB_SHARE * root
            for bore, root in zip(self.bore_diameter, self.root_radius, strict=True)
        )

    @cached_property
    def half_body(self) -> tuple[HalfBody, HalfBody]:
        """Mass [kg] and inertia [kg m2] of one half of each gear."""
        return half_body(self, 0), half_body(self, 1)

    @cached_property
    def gap_shaft(self) -> tuple[GapShaft, GapShaft]:
        """Stiffnesses of the shaft between the halves' mid planes.

        Raises:
            ParameterError: the pair has one half only.
        """
        return gap_shaft(self, 0), gap_shaft(self, 1)

    def iso6336_stiffness(
        self, tangential_force: float | None = None, blank_factor: float = 1.0
    ) -> iso6336.Stiffness:
        """Tooth stiffness by ISO 6336-1, method B; see `iso6336.stiffness`."""
        return iso6336.stiffness(self, tangential_force, blank_factor)

    def _facts(self) -> dict[str, str]:
        z1, z2 = self.number_of_teeth
        x1, x2 = self.profile_shift_coefficient
        return {
            "z": f"{z1}/{z2}",
            "m_n": f"{1e3 * self.normal_module:g} mm",
            "alpha_n": f"{math.degrees(self.normal_pressure_angle):.4g} deg",
            "beta": f"{math.degrees(self.helix_angle):.4g} deg",
            "b": f"{self.halves} x {1e3 * self.face_width:g} mm",
            "a": f"{1e3 * self.center_distance:.4f} mm",
            "x": f"{x1:.4g}/{x2:.4g}",
            "epsilon_alpha": f"{self.transverse_contact_ratio:.4g}",
            "epsilon_beta": f"{self.overlap_ratio:.4g}",
        }


def _pair(name: str, value: Any) -> tuple[Any, Any]:  # noqa: ANN401 (a user's, not checked yet)
    if value is None or isinstance(value, (int, float)):
        return (value, value)
    pair = tuple(value)
    if len(pair) != 2:
        raise ParameterError(f"{name}: {len(pair)} values; give one, or two: (pinion, wheel)")
    return pair[0], pair[1]
