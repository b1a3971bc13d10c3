"""What happens if the second implementation leaves a path out: the product must be elsewhere."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from second_implementation.product import FMUS
from second_implementation.teeth import DeviatingTeeth

_FILES = FMUS / "gear_mesh" / "resources"


class LeftOut(NamedTuple):
    """A path that is left out of a case.

    Attributes:
        case: its name.
        part, values: parameters, or with part "files" resource files, that have no effect.
        change: what is left out of the second implementation itself.
    """

    case: str
    part: str = "files"
    values: Mapping = MappingProxyType({})
    change: Callable | None = None


def _gear(case, **values):
    return LeftOut(case, "gear_mesh", {name.replace("__", "."): v for name, v in values.items()})


def _bearings(case, **values):
    return _gear(case, **values)._replace(part="bearing_supports")


def _without_reaction_of_ramp(model):
    """R is a given function of time: nothing is taken from the rotation."""
    ramp = model.gear.ramp
    at = ramp.at
    ramp.at = lambda angle: (at(angle)[0], 0.0)


def _without_column(column):
    """Deviations of teeth without position, profile or helix (0, 1, 2)."""

    def change(model):
        for teeth in _deviating(model):
            teeth.pinion[:, column] = teeth.wheel[:, column] = 0.0

    return change


def _without_slope(name):
    """Energy of deviating teeth that does not depend on the phase, or on R."""

    def change(model):
        for teeth in _deviating(model):
            load = teeth.load
            teeth.load = lambda *at, load=load: load(*at)._replace(**{name: 0.0})

    return change


def _deviating(model):
    return [t for t in model.gear.contacts.teeth.values() if isinstance(t, DeviatingTeeth)]


_TEETH, _COAST_TEETH = "gearbox, single teeth", "gearbox, single teeth, coast"
_TEETH_RAMP, _RAMP = "gearbox, single teeth, ramp", "gearbox, ramp"
_IDEAL = {"tooth_deviations": _FILES / "ideal_teeth.csv"}
_BOX, _COAST, _LIGHT = (
    "gearbox", "gearbox, coast", "gearbox, deflections below the damping's transition",
)  # fmt: skip
_UNGATED, _RIG, _RUN_UP = "gearbox, ungated damping, backlash crossed", "rig", "rig, run-up"

PATHS = {
    "right table unlike left one": LeftOut(
        _BOX, "files", {"stiffness_table": _FILES / "mesh_stiffness.csv"}
    ),
    "given transmission error": LeftOut(
        _BOX, "files", {"tooth_errors": _FILES / "perfect_teeth.csv"}
    ),
    "given transmission error, coast": LeftOut(
        _COAST, "files", {"tooth_errors": _FILES / "perfect_teeth.csv"}
    ),
    "unbalance, pinion": _gear(_BOX, pinion__unbalance=0.0),
    "unbalance, wheel": _gear(_BOX, wheel__unbalance=0.0),
    "ramp": _gear(_RAMP, ramp_turns=0.0),
    "reaction of the ramp": LeftOut(_RAMP, change=_without_reaction_of_ramp),
    "ramp, turning backwards": _gear("gearbox, ramp, turning backwards", ramp_turns=0.0),
    "single teeth": LeftOut(_TEETH, values=_IDEAL),
    "single teeth, coast": LeftOut(_COAST_TEETH, values=_IDEAL),
    "position of teeth": LeftOut(_TEETH, change=_without_column(0)),
    "profile of teeth": LeftOut(_TEETH, change=_without_column(1)),
    "helix of teeth": LeftOut(_TEETH, change=_without_column(2)),
    "ramp of single teeth": _gear(_TEETH_RAMP, ramp_turns=0.0),
    "energy of single teeth over the phase": LeftOut(_TEETH, change=_without_slope("phase_slope")),
    "energy of single teeth over the ramp": LeftOut(
        _TEETH_RAMP, change=_without_slope("ramp_slope")
    ),
    "torque share, pinion": _gear(_BOX, pinion__torque_share_left=0.5),
    "torque share, wheel": _gear(_BOX, wheel__torque_share_left=0.5),
    "symmetry deviation": _gear(_BOX, symmetry_deviation=0.0),
    "run-out of the apex": _gear(_BOX, symmetry_pinion=0.0),
    "stagger": _gear(_BOX, stagger=0.0),
    "impact": _gear(_BOX, impact_force=0.0),
    "restraint": _gear(_BOX, pinion_restraint=0.0),
    "axial drag": _gear(_BOX, pinion_axial_drag=0.0),
    "mesh damping": _gear(_BOX, mesh_damping_ratio=0.0),
    "clearance, loaded": _bearings(_BOX, pinion__radial_clearance=0.0),
    "clearance, damping rising": _bearings(_BOX, wheel__radial_clearance=10e-6),
    "axial values per shaft": _bearings(_BOX, axial_per_shaft=0.0),
    "phase of the coast flank": _gear(_COAST, coast_phase=0.2),
    "impact on the coast flank": _gear(_COAST, flank=1.0),
    "impact as teeth enter on the coast flank": _gear(_COAST, total_contact_ratio=3.2),
    "line of action of the coast flank": _bearings(_COAST, flank=1.0),
    "damping's transition": _gear(_LIGHT, damping_transition=1e-9),
    "ungated damping": _gear(_UNGATED, damping_gate=1.0),
    "drag torque": _gear(_RIG, drag_torque=0.0),
    "friction of the load": LeftOut(_RIG, "load_motor", {"viscous_friction": 0.0}),
    "gradual load": LeftOut(_RUN_UP, "bench_controller", {"load_ramp_time": 0.0}),
    "torque limit and anti-windup": LeftOut(_RUN_UP, "drive_motor", {"torque_limit": 1000.0}),
    "limited set-point ramp": LeftOut(_RUN_UP, "drive_motor", {"maximum_acceleration": 1e5}),
}


def without(given, path):
    """What a run was given, without a path.

    Args:
        given: of the case.
        path: what is left out.
    """
    if path.part == "files":
        return given._replace(files={**given.files, **path.values})
    assert set(path.values) <= set(given.parameters[path.part]), path
    changed = {**given.parameters[path.part], **path.values}
    return given._replace(parameters={**given.parameters, path.part: changed})
