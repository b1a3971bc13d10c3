"""String parameters, which name resource files, and the columns of these."""

from dataclasses import dataclass

from herringbone.core.declaring.roles import Quantity


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a resource file: numbers in one of some units, or words.

    Attributes:
        name: name in the header.
        units: units that numbers may have; empty for words.
        words: what words are read as their number in this tuple.
        other_words: further words are allowed, and read as -1.
        rest: stands last, for all further columns of the file: numbers, in the unit that is given
            under this name.
    """

    name: str
    units: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    other_words: bool = False
    rest: bool = False


@dataclass(frozen=True, slots=True)
class Text:
    """A String parameter that names a resource file, a flat CSV of these columns.

    A relative name is looked up in the component's resources folder. Several tables may lie in one
    file; then one of them alone is a String parameter, which the others name as `shared`.

    Attributes:
        name, description: as of a variable.
        start: file name at the start.
        columns: of the file; those that it may have besides are `Column.rest`.
        quantity, place: what the file means to those who ask for the component's role, and where.
        header: name in a comment line `# NAME: ...` before the table; "" for none.
        header_count: how many numbers that line has.
        section: the table is what follows a line `# section: NAME`; "": the whole file.
        shared: name of the Text whose file this table lies in; "": its own.
    """

    name: str
    description: str
    start: str
    columns: tuple[Column, ...] = ()
    quantity: Quantity | None = None
    place: str = ""
    header: str = ""
    header_count: int = 0
    section: str = ""
    shared: str = ""
