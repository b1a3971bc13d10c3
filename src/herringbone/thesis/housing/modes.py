"""The four modes of the housing, with labels that are judged."""

import tomllib
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.components.registry import component
from herringbone.housing import read_housing
from herringbone.housing.welded.published import PUBLISHED
from herringbone.thesis import names
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WITHIN = 1.0
"""Deviation of a frequency that agrees [%]: what the mesh of the housing leaves open."""
_MOST = 0.5
"""Share of the kinetic, or strain, energy that makes a label true."""
_SOME = 0.1
"""Share that makes the second half of a label true."""
_STEEL = (210.0, 7850.0, 0.3)
"""Q235A of table 4.1 [GPa], [kg/m3], [1]."""
_TWISTS = ("Rx", "Ry", "Rz")
_MOTIONS = {"Tx": "sway across the shafts", "Ty": "bounce", "Tz": "sway along the shafts",
            "Rx": "roll about x", "Ry": "yaw about the vertical", "Rz": "rocking about the shafts",
            "elastic": "walls bend", "base plate": "base plate moves"}  # fmt: skip
_AXES = "xyz"


def compute() -> Outcome:
    """Frequencies, energy shares, and the surface with the shapes."""
    housing = component(names.HOUSING)
    own = read_housing(housing.resources).frequency_hz[: len(PUBLISHED)]
    folder = housing.folder / "surface"
    shares, nodes, triangles = (
        pd.read_csv(folder / f"{name}.csv", comment="#")
        for name in ("shares", "nodes", "triangles")
    )
    published = np.array([f for f, _ in PUBLISHED])
    listed = table(
        {
            "mode": shares["mode"], "published": published, "here": own,
            "deviation": 100.0 * (own / published - 1.0), "label": [x for _, x in PUBLISHED],
            "it moves": [_told(shares.iloc[k]) for k in range(len(shares))],
        },
        {"published": "Hz", "here": "Hz", "deviation": "%"},
    )  # fmt: skip
    units = {name: "m" if name in _AXES else "kg^-1/2" for name in nodes.columns}
    tables = {
        "modes": listed, "energy shares": table(shares),
        "surface nodes": table(nodes, units), "surface triangles": table(triangles),
    }  # fmt: skip
    return Outcome(tables, (_steel(), *_frequencies(listed), *_labels(listed, shares)))


def _told(shares: pd.Series) -> str:
    most = shares[list(_MOTIONS)].sort_values(ascending=False)[:2]
    return ", ".join(f"{_MOTIONS[str(n)]} {100.0 * x:.0f} %" for n, x in most.items() if x > 0.01)


def _steel() -> Finding:
    """Of what the shipped housing is made."""
    file = component(names.HOUSING).folder / "welded_housing.toml"
    material = tomllib.loads(file.read_text(encoding="utf-8"))["material"]
    young, density, poisson = (
        material[name] for name in ("young_modulus", "density", "poisson_ratio")
    )
    return Finding(
        "The housing is of steel with 210 GPa, 7850 kg/m³ and a Poisson's ratio of 0.3.",
        Verdict.of((1e-9 * young, density, poisson) == _STEEL),
        1e-9 * young,
        "GPa",
        f"with {density:g} kg/m³ and {poisson:g} has the shipped one",
    )


def _frequencies(listed: pd.DataFrame) -> tuple[Finding, ...]:
    return tuple(
        Finding(
            f"Mode {row['mode']} of the constrained housing lies at {row['published']:.2f} Hz.",
            Verdict.of(abs(row["deviation"]) <= _WITHIN, assuming=True),
            row["here"],
            "Hz",
            f"{row['deviation']:+.2f} % from it",
            "No dimension is published: ours were chosen so that the four frequencies come out.",
        )
        for _, row in listed.iterrows()
    )


def _labels(listed: pd.DataFrame, shares: pd.DataFrame) -> tuple[Finding, ...]:
    """A label holds if the energy of what it names is most of the mode's."""
    twist = shares[list(_TWISTS)].sum(axis=1)
    judged = (
        (shares["Tz"][0], shares["Tz"][0] > _MOST, "of the kinetic energy is axial sway"),
        (twist[1], twist[1] > _MOST, "of the kinetic energy is rotation of the box; "
         f"{100.0 * shares['Tx'][1]:.0f} % is sway across the shafts"),
        (shares["strain: base plate"][2], shares["strain: base plate"][2] > _MOST,
         "of the strain energy is in the base plate"),
        (shares["Tz"][3], twist[3] > _MOST and shares["Tz"][3] > _SOME,
         "of the kinetic energy is axial sway; "
         f"{100.0 * twist[3]:.0f} % is rotation, about the vertical"),
    )  # fmt: skip
    return tuple(
        Finding(
            f"Mode {row['mode']} is {row['label']}.",
            Verdict.of(holds),
            100.0 * share,
            "%",
            what,
            "Other housings have the same four frequencies and other shapes." if not holds else "",
        )
        for (_, row), (share, holds, what) in zip(listed.iterrows(), judged, strict=True)
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """The displaced surface of each mode."""
    from herringbone.plotting.modes.surfaces import displaced_surfaces  # noqa: PLC0415 (lazy)

    listed, nodes = tables["modes"], tables["surface nodes"]
    places = nodes[list(_AXES)].to_numpy()
    shapes = [nodes[[f"m{k}_{axis}" for axis in _AXES]].to_numpy() for k in listed["mode"]]
    titles = [
        f"mode {row['mode']}: {row['here']:.1f} Hz (thesis {row['published']:.2f} Hz, "
        f"“{row['label']}”)\n{row['it moves']}"
        for _, row in listed.iterrows()
    ]
    title = "Constrained modes of the housing, shapes exaggerated; colour: size of the displacement"
    triangles = tables["surface triangles"].to_numpy()
    return {"modes": displaced_surfaces(title, places, triangles, shapes, titles)}


ENTRY = Entry(
    name="housing_modes",
    group="housing",
    title="Four constrained modes of the housing",
    source="chapter 4.2, tables 4.1 and 4.2",
    shows="Four natural frequencies of the welded housing on its bolts, with descriptions of the "
    "shapes; no dimension.",
    compute=compute,
    draw=draw,
    seconds=0.5,
)
