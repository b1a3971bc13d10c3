"""Pictures of results; the only package that imports matplotlib.

Every function returns a `matplotlib.figure.Figure`, which a notebook shows: save it with
`figure.savefig(file)`.
"""

from herringbone.plotting.columns import plot_columns
from herringbone.plotting.overview import overview
from herringbone.plotting.pictures import (
    PICTURES,
    bearing_forces,
    radiated_power,
    seat_velocities,
    spectra,
    torques,
    write_pictures,
)

__all__ = [
    "PICTURES",
    "bearing_forces",
    "overview",
    "plot_columns",
    "radiated_power",
    "seat_velocities",
    "spectra",
    "torques",
    "write_pictures",
]
