"""Files of finite element programs, written as those programs write them."""

import numpy as np
import scipy.linalg as la

NODES = 12
"""A frame of 12 free nodes in space; three per seat, node 12 also carries sensor A."""
SEATS = """
valid_to_hz = 500
boundary = "fixed"
[units]
length = "mm"
mass = "t"
[frame]
origin = [100, 0, 0]
rotation = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
[damping]
ratio = 0.02
source = "assumed"
[seats]
pinion_left = { nodes = [1, 2, 3], weights = [1, 2, 1] }
pinion_right = { nodes = [4, 5, 6] }
wheel_left = { nodes = [7, 8, 9] }
wheel_right = { nodes = [10, 11, 12] }
[sensors]
A = { nodes = [12], dofs = ["z"] }
"""


def frame_model():
    """Stiffness [N/mm], mass [t] and node positions [mm] of random springs, all to the ground."""
    random = np.random.default_rng(5)
    root = random.standard_normal((3 * NODES, 3 * NODES))
    stiffness = 1e3 * (root @ root.T + 40.0 * np.eye(3 * NODES))
    mass = np.diag(np.repeat(random.uniform(1e-3, 3e-3, NODES), 3))
    return stiffness, mass, 100.0 * random.standard_normal((NODES, 3))


def modes_of(model):
    stiffness, mass, _ = model
    squares, shapes = la.eigh(stiffness, mass)
    return np.sqrt(squares) / (2 * np.pi), shapes.reshape(NODES, 3, -1)


def frd_text(frequency, shapes, coordinates, *, generalised=True, short=False, steps=1):
    """As CalculiX 2.20 writes it; modes of each step are numbered from 1."""
    width = 5 if short else 10
    last = "0" if short else "1"
    head = f"    2C                  {NODES:12d}{'':37}{last}"

    def block(rows):
        for label, row in enumerate(rows, 1):
            yield f" -1{label:{width}d}" + "".join(f"{x:12.5E}" for x in row)
        yield " -3"

    lines = ["    1C", "    1UVERSION           Version 2.20", head, *block(coordinates)]
    for n, f in enumerate(frequency):
        if generalised:
            lines.append(f"    1PGM                {1.0:12.6E}")
            lines.append(f"    1PGK                {(2 * np.pi * f) ** 2:12.6E}")
        lines += [
            f"    1PMODE         {n % (len(frequency) // steps) + 1:10d}",
            f"  100CL  {101 + n}{f:12.5E}{NODES:12d}{'':20}2{n + 1:5d}MODAL{last:>7}",
            " -4  DISP        4    1",
            " -5  D1          1    2    1    0",
            *block(shapes[:, :, n]),
            "  100CL  101 0.00000E+00           1                     2    1MODAL      1",
            " -4  STRESS      6    1",
            " -1         1 1.00000E+00 1.00000E+00 1.00000E+00 1.00000E+00 1.00000E+00 1.00000E+00",
            " -3",
        ]
    return "\n".join([*lines, " 9999", ""])


def text_2414(frequency, shapes, *, result=8):
    for n, f in enumerate(frequency):
        yield from ["    -1", "  2414", f"{n + 1:10d}", "MODE", f"{1:10d}"]
        yield from ["NONE"] * 5
        yield "".join(f"{x:10d}" for x in (1, 2, 2, result, 2, 3))
        yield "".join(f"{x:10d}" for x in (0, 0, 0, 0, 0, n + 1, 0, 0))
        yield "".join(f"{x:10d}" for x in (0, 0))
        w2 = (2 * np.pi * f) ** 2
        yield "".join(f"{x:13.5E}" for x in (0.0, f, w2, 1.0, 0.04, 0.0))
        yield "".join(f"{x:13.5E}" for x in (0.0,) * 6)
        for label, row in enumerate(shapes[:, :, n], 1):
            yield f"{label:10d}"
            yield "".join(f"{x:13.5E}" for x in row)
        yield "    -1"


def dmig_text(name, matrix, *, form=6, large=True, free=False):
    """One triangle of a symmetric matrix; 8 fields a card and its continuations."""
    yield f"DMIG    {name:8}{0:8d}{form:8d}{2:8d}{0:8d}"
    for column in range(matrix.shape[0]):
        entries = [
            (row // 3 + 1, row % 3 + 1, matrix[row, column])
            for row in range(column, matrix.shape[0])
            if matrix[row, column]
        ]
        node, axis = column // 3 + 1, column % 3 + 1
        if free:
            for row in entries:
                yield f"DMIG,{name},{node},{axis},,{row[0]},{row[1]},{row[2]:.16E}"
        elif large:
            yield f"DMIG*   {name:16}{node:16d}{axis:16d}{'':16}*"
            for row in entries:
                yield f"*       {row[0]:16d}{row[1]:16d}{row[2]:16.9E}"
        else:
            for row in entries:
                number = f"{row[2]:.2E}".replace("E", "")
                yield f"DMIG    {name:8}{node:8d}{axis:8d}{'':8}{row[0]:8d}{row[1]:8d}{number:8}"


def grid_text(coordinates):
    for label, row in enumerate(coordinates, 1):
        yield f"GRID*   {label:16d}{'':16}" + "".join(f"{x:16.9E}" for x in row[:2]) + "*"
        yield f"*       {row[2]:16.9E}"


def op4_text(name, matrix, kind="dense"):
    """As Nastran writes it: five dense, sparse or big sparse columns of 3E23.16."""
    n = matrix.shape[0]
    yield f"{n:8d}{-n if kind == 'big' else n:8d}{6:8d}{2:8d}{name:8}1P,3E23.16"
    for column in range(n):
        rows = np.flatnonzero(matrix[:, column])
        first, values = rows[0], matrix[rows[0] : rows[-1] + 1, column]
        words = 2 * values.size
        if kind == "dense":
            yield f"{column + 1:8d}{first + 1:8d}{words:8d}"
        else:
            yield f"{column + 1:8d}{0:8d}{words + 1:8d}"
            big = f"{words + 1:8d}{first + 1:8d}"
            yield big if kind == "big" else f"{first + 1 + 65536 * (words + 1):12d}"
        for k in range(0, values.size, 3):
            yield "".join(f"{x:23.16E}" for x in values[k : k + 3])
    yield f"{n + 1:8d}{1:8d}{1:8d}"
    yield f"{1.0:23.16E}"
