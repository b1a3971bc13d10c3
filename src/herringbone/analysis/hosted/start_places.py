"""Places that the lines of a gearbox for hosts need."""

from dataclasses import dataclass


@dataclass(frozen=True)
class FlangePlaces:
    """Places of a flange that has a shaft; -1: it has none of it.

    Attributes:
        phi, w: inputs.
        angle, impulse: states.
        offset, lead, tau_mean, initial_torque: as in the declaration.
        end_phi, end_w, end_tau, gear_tau, gear_w, stiffness: in the blocks of the parts.
    """

    phi: int
    w: int
    angle: int
    impulse: int
    offset: int
    lead: int
    tau_mean: int
    initial_torque: int
    end_phi: int
    end_w: int
    end_tau: int
    gear_tau: int
    gear_w: int
    stiffness: int


@dataclass(frozen=True)
class StartPlaces:
    """Places that the search for the equilibrium needs.

    Attributes:
        first, own, states: start of the parts' blocks, number of own states and of all.
        unknowns, sizes: elastic coordinates, and their usual sizes.
        rows: states whose derivatives are to vanish.
        state_sizes: usual sizes of all states.
        coordinates, coordinate_sizes: elastic coordinates and the angle, each with its rate among
            the states, and their usual sizes.
        turning: states that are angles which turn evenly.
        free: place of the angle among the coordinates if nothing holds it; else -1.
        teeth: numbers of teeth of pinion and wheel, in the blocks of the parts.
        speed: state of the pinion's speed.
        initial_speed: parameter; -1: the first shaft gives it.
        start_mode, flank, inner_step, step_start, stepping, degree: as in the declaration.
        guesses: by coordinate: where the search begins on the drive and on the coast flank.
        forces: mesh forces in the blocks of the parts.
        clearances: in the blocks of the parts.
        locals: pairs: local, and its place in the blocks of the parts.
        keeps_states: states are set by the host if the start is as set.
        scratch: room in the block.
        owner: name of the component.
    """

    first: int
    own: int
    states: int
    unknowns: tuple[int, ...]
    sizes: tuple[float, ...]
    rows: tuple[int, ...]
    state_sizes: tuple[float, ...]
    coordinates: tuple[tuple[int, int], ...]
    coordinate_sizes: tuple[float, ...]
    turning: tuple[int, ...]
    free: int
    teeth: tuple[int, int]
    speed: int
    initial_speed: int
    start_mode: int
    flank: int
    inner_step: int
    step_start: int
    stepping: int
    degree: int
    guesses: tuple[tuple[int, int, int], ...]
    forces: tuple[int, ...]
    clearances: tuple[int, ...]
    locals: tuple[tuple[int, int], ...]
    keeps_states: bool
    scratch: int
    owner: str
