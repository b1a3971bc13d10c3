"""How far outputs of both implementations are apart."""

from fnmatch import fnmatch

import numpy as np

GROUPS = {
    "bearing forces": "bearing_supports.shaft.*",
    "seat velocities": "modal_housing.*",
    "velocities of the halves": "gear_mesh.*.v_?",
    "mesh forces": "gear_mesh.mesh_*.force",
    "flange speeds": "gear_mesh.*.w",
    "coupling torques": "*_coupling.torque",
}


def deviations(data, outputs):
    """By group: rms of the difference over time and outputs, over that of the alternating part.

    Args:
        data: columns of the product.
        outputs: of the second implementation, by the end of the column's name, each (n,).
    """
    columns = {name: next(c for c in data.columns if c.endswith(name)) for name in outputs}
    found = {}
    for group, pattern in GROUPS.items():
        names = [name for name in outputs if fnmatch(name, pattern)]
        if names:
            ours = np.array([outputs[name] for name in names])
            theirs = np.array([data[columns[name]].to_numpy() for name in names])
            alternating = theirs - theirs.mean(axis=1, keepdims=True)
            found[group] = float(np.linalg.norm(ours - theirs) / np.linalg.norm(alternating))
    return found
