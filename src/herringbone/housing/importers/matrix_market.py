"""Importer of matrices in Matrix Market files: stiffness, mass, and perhaps the seat input.

Source: R. F. Boisvert, R. Pozo, K. A. Remington, The Matrix Market Exchange Formats, NISTIR 5935.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse as sp

from herringbone.core import ResourceError, reason
from herringbone.housing.matrix_model import MatrixModel


def read_matrix_market(paths: Sequence[str | Path]) -> MatrixModel:
    """Read stiffness, mass and, as a third file, the seat input (N, 12).

    Raises:
        ResourceError: not two or three files, not readable, complex, or sizes that differ.
    """
    files = [Path(path) for path in paths]
    if len(files) not in {2, 3}:
        raise ResourceError(
            f"{len(files)} Matrix Market file(s); give stiffness, mass and perhaps the seat input"
        )
    stiffness, mass, *rest = map(_read, files)
    if stiffness.shape != mass.shape or stiffness.shape[0] != stiffness.shape[1]:
        raise ResourceError(
            f"{files[0]} is {stiffness.shape}, {files[1]} is {mass.shape}; both must be square and "
            "of the same size"
        )
    seat_input = rest[0].toarray() if rest else None
    if seat_input is not None and seat_input.shape != (mass.shape[0], 12):
        raise ResourceError(
            f"{files[2]} is {seat_input.shape}; the seat input must be ({mass.shape[0]}, 12)"
        )
    names = ", ".join(file.name for file in files)
    return MatrixModel(stiffness, mass, None, {}, seat_input, {"tool": "matrices", "file": names})


def _read(file: Path) -> sp.csr_array:
    try:
        matrix = scipy.io.mmread(file)
    except OSError as error:
        raise ResourceError(f"cannot read {file}: {reason(error)}") from error
    except (ValueError, OverflowError) as error:
        raise ResourceError(f"{file} is no valid Matrix Market file: {error}") from error
    if np.iscomplexobj(matrix):
        raise ResourceError(f"{file} is complex; real matrices are needed")
    return sp.csr_array(matrix, dtype=float)
