"""Dimensions of the parametric welded housing.

A box of plates on four feet on a base plate: floor, cover, two end walls, two side walls with
bored bosses and ribs, a flange at the height of the shafts (its halves bonded), bolt holes in the
base plate. Origin on the pinion axis at mid plane, x toward the wheel, y up, z axial.
"""

from dataclasses import dataclass, fields

SHORTEST, LONGEST = 5e-4, 5.0
"""Range of any length of a housing [m]; values outside have the wrong unit."""
MOST_BOLTS = 1000


@dataclass(frozen=True)
class Dimensions:
    """Lengths [m] of the welded housing, and the number of its bolts.

    Attributes:
        center_distance: pinion axis to wheel axis.
        pinion_end_clearance: pinion axis to the inner face of the end wall on its side.
        wheel_end_clearance: wheel axis to the inner face of the end wall on its side.
        inner_width: between the inner faces of the side walls, along z.
        axis_height: top of the floor to the axes.
        cover_height: axes to the inner face of the cover.
        side_wall, end_wall, cover, floor, base_plate: thicknesses.
        base_overhang_x, base_overhang_z: of the base plate beyond the box.
        bolt_diameter: of the bolt holes, which are held.
        bolts_per_side: in a row along x on either side.
        bolt_edge_distance, bolt_end_distance: bolt centres to the base plate's edges.
        flange_thickness: of each half.
        flange_width: beyond the walls, at most boss_length.
        pinion_bore, wheel_bore: diameters.
        boss_wall: radial.
        boss_length: beyond the side wall.
        rib_thickness: along x; above and below each boss.
        rib_depth: beyond the side wall, at most boss_length.
        foot_height, foot_length, foot_thickness: along y, x, z.
        foot_position: |z| of the middle of a foot.
    """

    center_distance: float
    pinion_end_clearance: float
    wheel_end_clearance: float
    inner_width: float
    axis_height: float
    cover_height: float
    side_wall: float
    end_wall: float
    cover: float
    floor: float
    base_plate: float
    base_overhang_x: float
    base_overhang_z: float
    bolt_diameter: float
    bolts_per_side: int
    bolt_edge_distance: float
    bolt_end_distance: float
    flange_thickness: float
    flange_width: float
    pinion_bore: float
    wheel_bore: float
    boss_wall: float
    boss_length: float
    rib_thickness: float
    rib_depth: float
    foot_height: float
    foot_length: float
    foot_thickness: float
    foot_position: float

    @property
    def box_x(self) -> tuple[float, float]:
        """Outer faces of the end walls [m]."""
        inner_end = self.center_distance + self.wheel_end_clearance
        return -self.pinion_end_clearance - self.end_wall, inner_end + self.end_wall

    @property
    def half_width(self) -> float:
        """Mid plane to the outer face of a side wall [m]."""
        return self.inner_width / 2 + self.side_wall

    @property
    def base_top(self) -> float:
        """y of the base plate's top [m]."""
        return -self.axis_height - self.floor - self.foot_height

    @property
    def bores(self) -> dict[str, tuple[float, float]]:
        """x of the axis and diameter [m] of the bores, by gear."""
        return {
            "pinion": (0.0, self.pinion_bore),
            "wheel": (self.center_distance, self.wheel_bore),
        }

    @property
    def bolts(self) -> list[tuple[float, float]]:
        """x and z [m] of the bolt centres."""
        first = self.box_x[0] - self.base_overhang_x + self.bolt_end_distance
        last = self.box_x[1] + self.base_overhang_x - self.bolt_end_distance
        z = self.half_width + self.base_overhang_z - self.bolt_edge_distance
        pitch = (last - first) / (self.bolts_per_side - 1)
        return [(first + k * pitch, s * z) for k in range(self.bolts_per_side) for s in (-1, 1)]

    def problem(self) -> str | None:
        """What makes the housing impossible, if anything."""
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type is float and not SHORTEST <= value <= LONGEST:
                return (
                    f"{field.name} = {value:g} m: it must be from {SHORTEST:g} to {LONGEST:g} m; "
                    "is length_unit right?"
                )
        if not 2 <= self.bolts_per_side <= MOST_BOLTS:
            return f"bolts_per_side = {self.bolts_per_side}: it must be from 2 to {MOST_BOLTS}"
        return next((text for possible, text in self._conditions() if not possible), None)

    def _conditions(self) -> list[tuple[bool, str]]:
        pinion, wheel = self.pinion_bore / 2, self.wheel_bore / 2
        bosses = pinion + wheel + 2 * self.boss_wall
        height = min(self.axis_height, self.cover_height)
        length = self.box_x[1] - self.box_x[0]
        foot_outside = self.foot_position + self.foot_thickness / 2
        bolt_inside = self.bolts[-1][1] - self.bolt_diameter / 2
        bolt_free = min(self.bolt_edge_distance, self.bolt_end_distance)
        return [
            _below("pinion_bore / 2", pinion, "pinion_end_clearance", self.pinion_end_clearance),
            _below("wheel_bore / 2", wheel, "wheel_end_clearance", self.wheel_end_clearance),
            _below("the larger bore's radius", max(pinion, wheel),
                   "the lower of axis_height and cover_height", height),
            _below("the sum of the bosses' radii", bosses, "center_distance", self.center_distance),
            # Else the bore goes on beyond the boss face, where sensors lie, or stays closed there.
            _at_most("flange_width", self.flange_width, "boss_length", self.boss_length),
            _at_most("rib_depth", self.rib_depth, "boss_length", self.boss_length),
            _below("2 foot_length", 2 * self.foot_length, "the box's length", length),
            _below("foot_thickness / 2", self.foot_thickness / 2, "foot_position",
                   self.foot_position),
            _below("the outer face of a foot (foot_position + foot_thickness / 2)", foot_outside,
                   "the outer face of the side wall", self.half_width),
            _below("the outer face of a foot", foot_outside, "the inner edge of the bolt holes",
                   bolt_inside),
            _below("bolt_diameter / 2", self.bolt_diameter / 2,
                   "the bolts' distance from the edges", bolt_free),
            _below("bolt_diameter", self.bolt_diameter, "the bolts' pitch",
                   self.bolts[2][0] - self.bolts[0][0]),
        ]  # fmt: skip


def _below(low: str, value: float, high: str, limit: float) -> tuple[bool, str]:
    return value < limit, f"{low} = {value:g} m must be less than {high} = {limit:g} m"


def _at_most(low: str, value: float, high: str, limit: float) -> tuple[bool, str]:
    return value <= limit, f"{low} = {value:g} m must be at most {high} = {limit:g} m"
