"""Values of the shipped gear pair, as the components have them by default: of its gear file.

`python -m herringbone.gears.files.shipped_pair` writes them anew.
"""

from dataclasses import fields

from herringbone.core.declaring.pair_values import PairValues
from herringbone.core.places.paths import PACKAGE, components_folder
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.pair_values import pair_values

(GEAR_FILE,) = components_folder().glob("*/gear_pair.toml")
VALUES_FILE = PACKAGE / "components" / "shipped_pair.py"
_HEAD = '''"""The shipped gear pair: what follows from its gear file, with all digits.

Made by `python -m herringbone.gears.files.shipped_pair`; edit the gear file instead.
"""

from herringbone.core.declaring.pair_values import PairValues

SHIPPED_PAIR = PairValues(
'''


def values_source() -> str:
    """The module of the components that holds the values."""
    values, _ = pair_values(read_gear_file(GEAR_FILE))
    lines = (f"    {f.name}={getattr(values, f.name)!r},\n" for f in fields(PairValues))
    return f"{_HEAD}{''.join(lines)})\n"


if __name__ == "__main__":
    VALUES_FILE.write_text(values_source(), encoding="utf-8", newline="\n")
