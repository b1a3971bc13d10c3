"""A component's declaration and the layout of its block.

The block is one float64 array: mutable part (states, hidden states, inputs, outputs, locals,
what steps go on with), then parameters, then tables. The FMI value reference of a real is its
index in the block.
"""

import re
from collections.abc import Iterable
from functools import cached_property

from herringbone.core.declaring.roles import Port, Quantity, Role
from herringbone.core.declaring.text import Text
from herringbone.core.declaring.units import base_exponents
from herringbone.core.declaring.variable import NODES, Causality, StateVector, Variable, parameter
from herringbone.core.errors import ParameterError, StructureError
from herringbone.core.names import check_name, meant

INTERFACE_DEGREE = "interface_degree"
_NODE = re.compile(r"\.node\d+$")


def node_name(name: str, node: int) -> str:
    """Name of a signal's value at node 1 ... NODES."""
    return f"{name}.node{node}"


def is_node(name: str) -> bool:
    """True for the name of a signal's value at a node."""
    return bool(_NODE.search(name))


def signal_of(name: str) -> str:
    """Name of the signal whose value at a node this is; any other name itself."""
    return _NODE.sub("", name)


class Declaration:
    """What a component is, without how it is computed.

    Args:
        name: FMI model identifier and folder name.
        description: one line.
        variables: states first or not, in the order in which they are shown.
        texts: String parameters that name resource files.
        vectors: states whose number follows from resource files, such as modal coordinates.
        kept: length of what steps go on with besides states and variables.
        tables: length of the table part of the block.
        work: length of the work space that the kernels need.
        roles: what the component is for.
        ports: where it is joined to others.
        hidden: names of variables, and of signals' nodes, that an FMU does not show.

    A component with inputs also gets the tunable parameter `interface_degree` (0 to 4).

    Raises:
        StructureError: the component's name is no identifier, a variable's name stands twice, a
            unit is unknown, or a feedthrough, rate or port names nothing.
    """

    def __init__(
        self,
        name: str,
        description: str,
        variables: Iterable[Variable],
        *,
        texts: Iterable[Text] = (),
        vectors: Iterable[StateVector] = (),
        kept: int = 0,
        tables: int = 0,
        work: int = 0,
        roles: Iterable[Role] = (),
        ports: Iterable[Port] = (),
        hidden: Iterable[str] = (),
    ) -> None:
        self.name = check_name(name, "component")
        self.description = description
        self.texts = tuple(texts)
        self.vectors = tuple(vectors)
        self.kept = kept
        self.tables = tables
        self.work = work
        self.roles = tuple(roles)
        self.ports = tuple(ports)
        self.hidden = frozenset(hidden)
        self.variables = (
            *variables,
            parameter(
                INTERFACE_DEGREE,
                "1",
                "degree of the signals inside a macro step: 0 holds, n uses n nodes",
                0.0,
                minimum=0,
                maximum=NODES,
                tunable=True,
                whole=True,
            ),
        )
        self._check()

    def _check(self) -> None:
        names = [v.name for v in self.variables]
        names += [v.name for v in self.texts] + [v.name for v in self.vectors]
        twice = sorted({n for n in names if names.count(n) > 1})
        if twice:
            raise StructureError(f"{self.name}: declared twice: {', '.join(twice)}")
        inputs = {v.name for v in self.inputs}
        for vector in self.vectors:
            base_exponents(vector.unit)
        for v in self.variables:
            base_exponents(v.unit)
            unknown = set(v.feedthrough) - inputs
            if unknown:
                raise StructureError(f"{self.name}.{v.name}: feedthrough from unknown {unknown}")
        self._check_relations(inputs)

    def _check_relations(self, inputs: set[str]) -> None:
        outputs = {v.name for v in self.outputs}
        for v in self.variables:
            if v.rate and not {v.name, v.rate} <= outputs:
                raise StructureError(f"{self.name}.{v.name}: rate '{v.rate}' of no output")
            if v.at_rest and v.at_rest not in inputs:
                raise StructureError(f"{self.name}.{v.name}: at rest under unknown '{v.at_rest}'")
        for port in self.ports:
            if not any(name.startswith(f"{port.name}.") for name in inputs | outputs):
                raise StructureError(f"{self.name}: port '{port.name}' has no variables")

    def _select(self, causality: Causality) -> tuple[Variable, ...]:
        return tuple(v for v in self.variables if v.causality is causality)

    @cached_property
    def states(self) -> tuple[Variable, ...]:
        """The states that are FMI variables."""
        return tuple(v for v in self.variables if v.state)

    @cached_property
    def inputs(self) -> tuple[Variable, ...]:
        """All inputs; each is a polynomial signal with nodes."""
        return self._select(Causality.INPUT)

    @cached_property
    def outputs(self) -> tuple[Variable, ...]:
        """All outputs; those with nodes come first in the block."""
        return self._select(Causality.OUTPUT)

    @cached_property
    def locals(self) -> tuple[Variable, ...]:
        """All locals that are no states."""
        return tuple(v for v in self._select(Causality.LOCAL) if not v.state)

    @cached_property
    def parameters(self) -> tuple[Variable, ...]:
        """All real parameters."""
        return self._select(Causality.PARAMETER)

    @property
    def hidden_states(self) -> int:
        """Room for the states that are no variables in co-simulation."""
        return sum(v.capacity for v in self.vectors)

    @property
    def state_count(self) -> int:
        """Number of states, hidden ones included; they lie at the start of the block."""
        return len(self.states) + self.hidden_states

    @property
    def vector_indices(self) -> dict[str, int]:
        """Index of the first element of each state vector; they follow the other states."""
        first, found = len(self.states), {}
        for vector in self.vectors:
            found[vector.name] = first
            first += vector.capacity
        return found

    @cached_property
    def first_input(self) -> int:
        """Index of the first input; inputs lie `NODES + 1` apart: value, node 1 ... node 4."""
        return self.state_count

    @cached_property
    def node_outputs(self) -> tuple[Variable, ...]:
        """The outputs that have nodes."""
        return tuple(v for v in self.outputs if v.nodes)

    @cached_property
    def first_output(self) -> int:
        """Index of the first output with nodes; these lie `NODES + 1` apart."""
        return self.first_input + len(self.inputs) * (NODES + 1)

    @cached_property
    def index(self) -> dict[str, int]:
        """Index in the block of every real variable, nodes included."""
        index = {v.name: i for i, v in enumerate(self.states)}
        position = self.first_input
        plain_outputs = tuple(v for v in self.outputs if not v.nodes)
        plain = (*plain_outputs, *self.locals)
        for v in (*self.inputs, *self.node_outputs, *plain, *self.parameters):
            if v is self.parameters[0]:
                position += self.kept
            index[v.name] = position
            position += 1
            if v.nodes:
                for node in range(1, NODES + 1):
                    index[node_name(v.name, node)] = position
                    position += 1
        return index

    @cached_property
    def mutable_size(self) -> int:
        """Length of the part that a step may change."""
        return self.index[self.parameters[0].name]

    @property
    def first_kept(self) -> int:
        """Index of what steps go on with, the end of the mutable part."""
        return self.mutable_size - self.kept

    @cached_property
    def first_table(self) -> int:
        """Index of the first table entry."""
        return self.mutable_size + len(self.parameters)

    @property
    def size(self) -> int:
        """Length of the block."""
        return self.first_table + self.tables

    def indices(self, *names: str) -> tuple[int, ...]:
        """Indices of several variables, as constants for a kernel."""
        return tuple(self.index[name] for name in names)

    def offered(self, quantity: Quantity, place: str | None = None) -> tuple[Variable, ...]:
        """The variables that are a quantity, at a place or anywhere."""
        return tuple(
            v
            for v in self.variables
            if v.quantity is quantity and (place is None or v.place == place)
        )

    def variable(self, name: str) -> Variable:
        """The variable of that name.

        Raises:
            ParameterError: there is none.
        """
        for v in self.variables:
            if v.name == name:
                return v
        hint = meant(name, (v.name for v in self.variables))
        raise ParameterError(
            f"{self.name} has no variable '{name}'; {hint}'herringbone list {self.name}' shows them"
        )
