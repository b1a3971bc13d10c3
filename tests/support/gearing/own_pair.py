"""Gear files of pairs of one's own, whose tables are made in a second."""

from pathlib import Path

TABLE = '[table]\ntorque = "200 N m"\nmethod = "coupled-slices"\nphases = 8\n'
"""Eight phases: which table it is matters, not how good."""
PAIRS = {
    "teeth": 'number_of_teeth = [23, 57]\nnormal_module = "3.5 mm"\nhelix_angle = "30 deg"',
    "helix": 'number_of_teeth = [27, 81]\nnormal_module = "3.5 mm"\nhelix_angle = "22 deg"',
    "module": 'number_of_teeth = [27, 81]\nnormal_module = "4.5 mm"\nhelix_angle = "30 deg"',
    "nearly spur": (
        'number_of_teeth = [25, 70]\nnormal_module = "4 mm"\nhelix_angle = "5 deg"\n'
        "profile_shift_coefficient = [0.25, -0.1]"
    ),
}
"""Sections [gear_pair] but for the width: of 23/57 teeth, 22 deg, 4.5 mm, nearly a spur pair."""
WIDTHS = 'face_width = "45 mm"\ngap_width = "40 mm"\nstub_length = "60 mm"\n'
BODIES = 'shaft_diameter = ["50 mm", "70 mm"]\n'
MESH = '[mesh]\nbacklash = "120 um"\ndamping_ratio = 0.08\n'


def write_pair(file: Path, pair: str = "teeth", *, mesh: str = MESH, table: str = TABLE) -> Path:
    """A gear file of one of PAIRS."""
    text = f"[gear_pair]\n{PAIRS[pair]}\n{WIDTHS}{BODIES}{mesh}{table}"
    file.write_text(text, encoding="utf-8")
    return file
