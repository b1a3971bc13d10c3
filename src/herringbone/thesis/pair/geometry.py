"""Table 2.1, and what follows from it."""

import math
from typing import TYPE_CHECKING

from herringbone.gears import GearPair
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.given import JOB

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MM = 1e3
_PUBLISHED_DISTANCE = 218.2
_HALF_DIGIT = 0.05
"""Centre distance of Table 2.1, given with one decimal [mm]."""


def compute() -> Outcome:
    """Geometry of the pair, by ISO 21771."""
    pair = JOB.pair
    both = _both(pair)
    one = _one(pair)
    return Outcome(
        {
            "gears": table(
                {"quantity": list(both), "unit": [u for u, _ in both.values()],
                 "pinion": [v[0] for _, v in both.values()],
                 "wheel": [v[1] for _, v in both.values()]}
            ),
            "pair": table(
                {"quantity": list(one), "unit": [u for u, _ in one.values()],
                 "value": [v for _, v in one.values()]}
            ),
        },
        _findings(pair),
    )  # fmt: skip


def _both(pair: GearPair) -> dict[str, tuple[str, tuple[float, float]]]:
    radii = {
        "reference radius r": pair.reference_radius,
        "base radius r_b": pair.base_radius,
        "tip radius r_a": pair.tip_radius,
        "root radius r_f": pair.root_radius,
        "form radius r_Ff": pair.form_radius,
    }
    found = {name: ("mm", (_MM * r[0], _MM * r[1])) for name, r in radii.items()}
    teeth = pair.number_of_teeth
    bodies = pair.half_body
    return {
        "number of teeth z": ("", (float(teeth[0]), float(teeth[1]))),
        **found,
        "mass of a half": ("kg", (bodies[0].mass, bodies[1].mass)),
        "inertia of a half": ("kg m²", (bodies[0].inertia, bodies[1].inertia)),
    }


def _one(pair: GearPair) -> dict[str, tuple[str, float]]:
    return {
        "normal module m_n": ("mm", _MM * pair.normal_module),
        "transverse module m_t": ("mm", _MM * pair.transverse_module),
        "normal pressure angle alpha_n": ("°", math.degrees(pair.normal_pressure_angle)),
        "transverse pressure angle alpha_t": ("°", math.degrees(pair.transverse_pressure_angle)),
        "helix angle beta": ("°", math.degrees(pair.helix_angle)),
        "base helix angle beta_b": ("°", math.degrees(pair.base_helix_angle)),
        "centre distance a": ("mm", _MM * pair.center_distance),
        "face width of a half b": ("mm", _MM * pair.face_width),
        "transverse base pitch p_bt": ("mm", _MM * pair.transverse_base_pitch),
        "path of contact g_alpha": ("mm", _MM * pair.path_of_contact.length),
        "transverse contact ratio epsilon_alpha": ("", pair.transverse_contact_ratio),
        "overlap ratio epsilon_beta": ("", pair.overlap_ratio),
    }


def _findings(pair: GearPair) -> tuple[Finding, ...]:
    distance = _MM * pair.center_distance
    return (
        Finding(
            "The centre distance of 27 and 81 teeth of module 3.5 mm at 30° is 218.2 mm.",
            Verdict.of(abs(distance - _PUBLISHED_DISTANCE) < _HALF_DIGIT),
            distance,
            "mm",
            f"without profile shift, {1e3 * (distance - _PUBLISHED_DISTANCE):+.0f} µm from it",
            "The table rounds to 0.1 mm.",
        ),
        Finding(
            "Table 2.1 lists the basic parameters of the pair.",
            Verdict.NEEDS_AN_ASSUMPTION,
            _MM * pair.face_width,
            "mm",
            "per half, with which ISO 6336-1 gives the thesis' mean stiffness",
            "The face width is not listed, although the stiffness needs it: ours follows from the "
            "published stiffness.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """No picture: the table says it all."""
    return {}


ENTRY = Entry(
    name="table_2_1",
    group="pair",
    title="Table 2.1 and the geometry that follows",
    source="chapter 2.2, table 2.1",
    shows="Teeth, normal module, pressure angle, helix angle and centre distance of the pair; "
    "neither face width nor tip and root.",
    compute=compute,
    draw=draw,
    seconds=0.1,
)
