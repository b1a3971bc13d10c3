"""A measured velocity as a universal file."""

import numpy as np
import pytest


def write_universal(file, values, rate, *, kind=11, unit="mm/s", spacing=1, scale=1e3, **more):
    """A velocity [m/s] by its samples, as data set 58; `scale` makes its unit of them.

    `more`: other fields of the data set.
    """
    pyuff = pytest.importorskip("pyuff")
    names = ["abscissa", "ordinate", "orddenom", "z_axis"]
    blank = dict.fromkeys(
        (f"{n}_{w}" for n in names for w in ("axis_lab", "axis_units_lab")), "NONE"
    )
    exponents = (f"{n}_{w}_unit_exp" for n in names for w in ("len", "force", "temp"))
    dataset = {
        **blank,
        **dict.fromkeys(exponents, 0),
        **dict.fromkeys((f"{n}_spec_data_type" for n in names), 0),
        "type": 58, "binary": 0, "func_type": 1, "ver_num": 0, "load_case_id": 0,
        "rsp_node": 1, "rsp_dir": 3, "ref_node": 1, "ref_dir": 1, "data": scale * values,
        "x": np.arange(values.size) / rate,
        **{f"id{k}": "A" if k == 1 else "NONE" for k in range(1, 6)},
        "rsp_ent_name": "NONE", "ref_ent_name": "NONE", "abscissa_spacing": spacing,
        "ord_data_type": 4, "num_pts": values.size, "abscissa_min": 0.0, "abscissa_inc": 1.0 / rate,
        "z_axis_value": 0.0, "ordinate_spec_data_type": kind, "ordinate_axis_units_lab": unit,
        "abscissa_spec_data_type": 17, **more,
    }  # fmt: skip
    pyuff.UFF(str(file)).write_sets(dataset, "add")
