"""What a gearbox for hosts says once in the log: loads beyond its data, and slow steps."""

from herringbone.analysis.twin.composite_parts import Parts
from herringbone.core import Remark

_DEAR = "Runge-Kutta alone integrates, at about ten times the CPU time of the condensed core"
_NO_FORM = Remark(
    f"{_DEAR}, which needs torques as inputs at both flanges, and parts that are linear beside the "
    "meshes",
    warning=False,
)
_NOT_LINEAR = Remark(
    f"{_DEAR}: with these parameters the equations have no condensed form; look for stiffnesses "
    "and dampings of 0, and for parts that are not linear"
)
_KERNEL = """

{imports}
@kernel
def remark(b: np.ndarray, w: np.ndarray, which: int, report: np.ndarray) -> int:
    blocks = b[{first}:]
{lines}    return {otherwise}
"""


def remarks_of(parts: Parts, *, condensed: bool) -> tuple[Remark, ...]:
    """The remarks: those of the parts, then that on the condensed core."""
    lines = [
        line for i in parts.instances if i.component.beyond for line in i.component.beyond.lines
    ]
    return (*map(Remark, lines), _NOT_LINEAR if condensed else _NO_FORM)


def remark_source(parts: Parts, first: int, status: int | None) -> str:
    """The kernel `remark`.

    Args:
        parts: of the gearbox.
        first: start of their blocks.
        status: place in the work space that is negative if there is no condensed form; None: there
            is none at all.
    """
    names, lines, number = {}, "", 0
    for p, instance in enumerate(parts.instances):
        name, beyond = instance.component.name, instance.component.beyond
        if beyond is None:
            continue
        names[name] = f'{name}_beyond = COMPONENTS["{name}"].beyond.kernel\n'
        block = f"blocks[{parts.layout.block_first[p]}:{parts.layout.block_first[p + 1]}]"
        end = number + len(beyond.lines)
        lines += f"    if which < {end}:\n"
        lines += f"        return {name}_beyond({block}, which - {number}, report)\n"
        number = end
    otherwise = "1" if status is None else f"1 if w[{status}] < 0.0 else 0"
    return _KERNEL.format(
        imports="".join(names.values()), first=first, lines=lines, otherwise=otherwise
    )
