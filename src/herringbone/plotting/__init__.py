"""Pictures of results; the only package that imports matplotlib.

Every function returns a `matplotlib.figure.Figure`, which a notebook shows: save it with
`figure.savefig(file)`.
"""

from herringbone.plotting.columns import plot_columns
from herringbone.plotting.runs.over_time import bearing_forces, seat_velocities, torques
from herringbone.plotting.runs.overview import overview
from herringbone.plotting.runs.pictures import PICTURES, write_pictures
from herringbone.plotting.runs.spectra import radiated_power, spectra

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
