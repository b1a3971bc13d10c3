"""The neutral format "modal-housing 1.0": a folder or zip file of one JSON and some CSV files.

housing.json        points, frame, provenance, validity, hashes of the CSV files
modes.csv           mode, kind, frequency_hz, damping_ratio; the FMU reads it
shapes.csv          point, dof, m1 ... mn [kg^-1/2]; the FMU reads it
static.csv          optional: static compliance at the seats [m/N]
residual.csv        optional: compliance that the modes miss [m/N]
surface_gram.csv    optional: Gram matrix of the surface's normal motion [kg^-1 m2]
"""

import hashlib

from herringbone.housing.modal_model import SEAT_DOFS

FORMAT, VERSION = "modal-housing", "1.0"
HEAD, MODES, SHAPES = "housing.json", "modes.csv", "shapes.csv"
COMPLIANCES = {"static": "static.csv", "residual": "residual.csv"}
"""File of each compliance matrix, by attribute of the model."""
GRAM = "surface_gram.csv"
OPTIONAL = (*COMPLIANCES.values(), GRAM)
UNITS = {"length": "m", "mass": "kg", "time": "s", "force": "N"}
SEAT_COLUMNS = tuple(f"{seat}.{axis}" for seat, axis in SEAT_DOFS)


DATA = "data"
"""Of a certificate: the whole path of the data that were reduced."""


def digest(data: bytes) -> str:
    """SHA-256 with line ends as on Unix, so that a checkout on Windows keeps it."""
    return hashlib.sha256(data.replace(b"\r\n", b"\n")).hexdigest()
