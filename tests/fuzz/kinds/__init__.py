"""Kinds of files of strangers: good ones, and what reads them."""

from fuzz.kinds.fmus import fmu_kinds
from fuzz.kinds.housings import housing_kinds
from fuzz.kinds.kind import Kind
from fuzz.kinds.models import model_kinds, record_kinds
from fuzz.kinds.own_files import own_kinds
from fuzz.kinds.resources import resource_kinds


def all_kinds() -> list[Kind]:
    """All of them; each good file is read without a complaint."""
    return [
        *fmu_kinds(), *own_kinds(), *housing_kinds(), *model_kinds(), *resource_kinds(),
        *record_kinds(),
    ]  # fmt: skip
