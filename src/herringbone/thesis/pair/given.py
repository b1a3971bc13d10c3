"""The thesis' pair, as the package ships it."""

from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.shipped_pair import GEAR_FILE

JOB = read_gear_file(GEAR_FILE)
