"""Source of the kernels of a system as one component: the twin's, inside one block.

The component's table part holds the blocks of all parts, one behind the other, as the twin does.
`refresh` hands them the parameters, and writes what follows from these: no FMU state holds it.
"""

from dataclasses import dataclass

from herringbone.components.resources.loader import ResourceLoader
from herringbone.core import Instance


@dataclass(frozen=True)
class BlockMap:
    """Pairs of places: in the component's block, in the blocks of the parts.

    Attributes:
        first: start of the parts' blocks in the component's block.
        states: number of states.
        inputs, outputs, parameters: pairs of places.
        own: states in front that no part has.
    """

    first: int
    states: int
    inputs: tuple[tuple[int, int], ...]
    outputs: tuple[tuple[int, int], ...]
    parameters: tuple[tuple[int, int], ...]
    own: int = 0


@dataclass(frozen=True)
class OwnLines:
    """What a component does besides its parts, as lines of kernels; `b` is its block.

    Attributes:
        place: hands inputs to the parts' `blocks`, at time t.
        rates: derivatives `dx` of the own states, when the parts' are known.
        results: own outputs, when the parts' are known.
        kernels: further kernels, and what the module imports for them.
    """

    place: str = ""
    rates: str = ""
    results: str = ""
    kernels: str = ""


_KERNELS = """

@kernel
def refresh(b: np.ndarray) -> None:
    blocks = b[{first}:]
    for i in range({parameters}):
        blocks[PARAMETER_TO[i]] = b[PARAMETER_FROM[i]]
{prepare}

@kernel
def place(b: np.ndarray, t: float) -> None:
    blocks = b[{first}:]
{inputs}{own_place}    return


@kernel
def system_rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    blocks = b[{first}:]
    place(b, t)
    rhs(blocks, b[{own}:{states}], t, dx[{own}:{states}])
{own_rates}    return


@kernel
def system_out(b: np.ndarray, t: float) -> None:
    blocks = b[{first}:]
    refresh(b)
    place(b, t)
    scatter(blocks, b[{own}:{states}])
    move(blocks, t)
    propagate(blocks, t)
    for i in range({outputs}):
        b[OUTPUT_TO[i]] = blocks[OUTPUT_FROM[i]]
{own_results}    return


@seldom
def system_start(b: np.ndarray) -> None:
    blocks = b[{first}:]
    refresh(b)
    scatter(blocks, b[{own}:{states}])
{starts}    return


@kernel
def system_indicators(b: np.ndarray, t: float, z: np.ndarray) -> None:
    blocks = b[{first}:]
    scatter(blocks, b[{own}:{states}])
{indicators}    return


@seldom
def system_load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    blocks = b[{first}:]
    at = 0
{loads}    return 0


@seldom
def system_verify(b: np.ndarray, report: np.ndarray) -> int:
    blocks = b[{first}:]
    refresh(b)
{checks}    return 0
"""


def composite_source(
    twin: str,
    instances: list[Instance],
    blocks: tuple[int, ...],
    states: tuple[int, ...],
    m: BlockMap,
    own: OwnLines = OwnLines(),
) -> str:
    """Generate the module: the twin's source, then the component's kernels.

    Args:
        twin: source of the system's twin.
        instances: the parts.
        blocks, states: where each part's block and states begin in the twin; totals at the end.
        m: where the component's variables lie.
        own: what the component does besides.
    """
    loading = [i for i in instances if i.component.declaration.texts]
    starting = {i.component.name for i in instances if hasattr(i.component.start, "py_func")}
    indicating = {i.component.name for i in instances if i.component.indicators}
    lines = [twin]
    lines += [f'\n{n}_start = COMPONENTS["{n}"].start' for n in sorted(starting)]
    preparing = {
        i.component.name
        for i in instances
        if i.component.laws and hasattr(i.component.laws.prepare, "py_func")
    }
    lines += [f'\n{n}_prepare = COMPONENTS["{n}"].laws.prepare' for n in sorted(preparing)]
    lines += [f'\n{n}_indicators = COMPONENTS["{n}"].indicators' for n in sorted(indicating)]
    names = sorted({i.component.name for i in loading})
    lines += [f'\n{n}_load = COMPONENTS["{n}"].load.kernel' for n in names]
    for name, pairs in (("OUTPUT", m.outputs), ("PARAMETER", m.parameters)):
        ends = ("TO", "FROM") if name == "OUTPUT" else ("FROM", "TO")
        lines += [f"\n{name}_{end} = {tuple(p[k] for p in pairs)!r}" for k, end in enumerate(ends)]
    checking = sorted({i.component.name for i in instances if has_check(i)})
    lines += [f'\n{n}_check = COMPONENTS["{n}"].load.check' for n in checking]
    text = _KERNELS.format(
        first=m.first,
        states=m.states,
        parameters=len(m.parameters),
        outputs=len(m.outputs),
        inputs="".join(f"    blocks[{to}] = b[{at}]\n" for at, to in m.inputs),
        own=m.own,
        prepare="".join(
            f"    {i.component.name}_prepare(blocks[{blocks[p]}:{blocks[p + 1]}])\n"
            for p, i in enumerate(instances)
            if i.component.name in preparing
        ),
        own_place=own.place,
        own_rates=own.rates,
        own_results=own.results,
        starts=_starts(instances, blocks, states, starting, m.own),
        indicators=_indicators(instances, blocks),
        loads=_loads(instances, blocks),
        checks=_checks(instances, blocks),
    )
    return "".join([*lines, "\n", text, own.kernels])


def has_check(instance: Instance) -> bool:
    """True if a part checks what it loads against its parameters."""
    load = instance.component.load
    return isinstance(load, ResourceLoader) and load.check is not None


def _starts(
    instances: list[Instance],
    blocks: tuple[int, ...],
    states: tuple[int, ...],
    starting: set[str],
    own: int,
) -> str:
    lines = []
    for p, instance in enumerate(instances):
        if instance.component.name in starting:
            count = states[p + 1] - states[p]
            lines.append(
                f"    {instance.component.name}_start(blocks[{blocks[p]}:{blocks[p + 1]}])\n"
                f"    for i in range({count}):\n"
                f"        b[{own + states[p]} + i] = blocks[{blocks[p]} + i]\n"
            )
    return "".join(lines)


def _indicators(instances: list[Instance], blocks: tuple[int, ...]) -> str:
    """The parts' event indicators, part after part; they depend on states and parameters alone."""
    lines, first = [], 0
    for p, instance in enumerate(instances):
        end = first + instance.component.indicator_count
        if end > first:
            lines.append(
                f"    {instance.component.name}_indicators("
                f"blocks[{blocks[p]}:{blocks[p + 1]}], t, z[{first}:{end}])\n"
            )
        first = end
    return "".join(lines)


def _checks(instances: list[Instance], blocks: tuple[int, ...]) -> str:
    """What each part loaded against its parameters; refusals are numbered as in `_loads`."""
    lines, refusals = [], 0
    for p, instance in enumerate(instances):
        load = instance.component.load
        if not isinstance(load, ResourceLoader):
            continue
        if load.check is not None:
            lines.append(
                f"    status = {instance.component.name}_check("
                f"blocks[{blocks[p]}:{blocks[p + 1]}], report)\n"
                "    if status != 0:\n"
                f"        return {refusals} + status\n"
            )
        refusals += len(load.refusals)
    return "".join(lines)


def _loads(instances: list[Instance], blocks: tuple[int, ...]) -> str:
    """Each part's load kernel gets its own files; refusals are numbered part after part."""
    lines, file, refusals = [], 0, 0
    for p, instance in enumerate(instances):
        texts = instance.component.declaration.texts
        if not texts:
            continue
        lines.append("    size = 0\n")
        for k, text in enumerate(texts):
            at = 2 * (file + k)
            fixed = len(text.columns) + text.header_count
            lines.append(f"    size += {fixed} + shape[{at}] * shape[{at + 1}]\n")
        lines.append(
            f"    status = {instance.component.name}_load(values[at : at + size], "
            f"shape[{2 * file}:{2 * (file + len(texts))}], blocks[{blocks[p]}:{blocks[p + 1]}], "
            f"s, report)\n"
            "    if status != 0:\n"
            f"        return {refusals} + status\n"
            "    at += size\n"
        )
        file += len(texts)
        if isinstance(instance.component.load, ResourceLoader):
            refusals += len(instance.component.load.refusals)
    return "".join(lines)
