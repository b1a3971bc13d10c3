"""The writer of flat CSV files: it takes whatever the reader takes."""

import numpy as np

from herringbone.components.registry import COMPONENTS
from herringbone.components.resources.flat_csv_text import with_scaled_column
from herringbone.components.resources.modal_data import MODE_COLUMNS, read_mode_table

ROUGH = """# units: mode 1, frequency_hz Hz, damping_ratio 1
 mode, kind ,frequency_hz, damping_ratio
# measured
1, normal,250.1,0.3
2,"residual",447.0,0.1

"""


def test_one_column_is_scaled_exactly_and_the_rest_stays(tmp_path):
    """Blank lines, comments, spaces and quotes are of the grammar."""
    rough, scaled = tmp_path / "rough.csv", tmp_path / "scaled.csv"
    rough.write_text(ROUGH, encoding="utf-8")
    factor = 1.0 + 1e-5
    text = with_scaled_column(rough, MODE_COLUMNS, "damping_ratio", factor)
    scaled.write_text(text, encoding="utf-8")
    kinds, frequency, damping = read_mode_table(scaled)
    assert kinds == ("normal", "residual")
    assert frequency.tolist() == [250.1, 447.0]
    assert damping.tolist() == [factor * 0.3, factor * 0.1]


def test_scaled_by_one_a_file_reads_back_bit_by_bit(tmp_path):
    shipped, same = COMPONENTS["modal_housing"].resources / "modes.csv", tmp_path / "same.csv"
    text = with_scaled_column(shipped, MODE_COLUMNS, "damping_ratio", 1.0)
    same.write_text(text, encoding="utf-8")
    for found, expected in zip(read_mode_table(same), read_mode_table(shipped), strict=True):
        assert np.array_equal(found, expected)
