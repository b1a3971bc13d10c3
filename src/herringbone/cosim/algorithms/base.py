"""What an algorithm is.

A new algorithm is one file in this folder: a frozen dataclass of its options that derives from
`Algorithm`, and, if stages do not suffice, a compiled loop of its own beside that of
`loops.stages`. Add it to `ALGORITHMS` in `__init__.py`; command line, documentation and
`tests/conformance` follow.
The tests hold it to what it declares: order, passes, rollback, slow bodies, an adaptive step.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from itertools import product
from typing import Any, ClassVar, NoReturn, Self

from herringbone.core import ParameterError
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.structure.network import Network


def option(default: float | str, allowed: str = "", choices: Sequence[int | str] = ()) -> Any:  # noqa: ANN401 (as dataclasses.field)
    """A field of an algorithm.

    Args:
        default: value.
        allowed: in words, which values it may have; the choices, if not given.
        choices: all values that it may have, if they are few; others are refused.
    """
    *most, last = map(str, choices or ("",))
    listed = f"{', '.join(most)} or {last}" if most else last
    return field(default=default, metadata={"allowed": allowed or listed, "choices": choices})


@dataclass(frozen=True)
class Algorithm(ABC):
    """A coupling algorithm; its options are the fields of a frozen dataclass.

    Attributes:
        name: on the command line.
        needs: capabilities that parts must have, "rollback" at least one: "nodes", "rollback",
            "accelerations".
        default_step: communication step size [s] if none is given.
    """

    name: ClassVar[str]
    needs: ClassVar[frozenset[str]] = frozenset()
    default_step: ClassVar[float] = 1e-5

    def __post_init__(self) -> None:
        for f in fields(self):
            choices = f.metadata["choices"]
            if choices and getattr(self, f.name) not in choices:
                self.refuse(f.name)

    @property
    @abstractmethod
    def convergence_order(self) -> int:
        """Power of the macro step with which the global error falls."""

    @abstractmethod
    def prepare(self, network: Network) -> "PreparedRun":
        """Lay out a network for this algorithm."""

    @property
    def adaptive(self) -> bool:
        """True if the macro step follows a tolerance."""
        return False

    @property
    def multirate(self) -> bool:
        """True if bodies may be slow: step once in several macro steps."""
        return False

    @property
    def passes(self) -> int:
        """Calls of doStep of each part in a macro step, unless more corrections are wanted."""
        return 1

    @property
    def accurate_step(self) -> float | None:
        """Step at which it errs 0.1 %, times the highest frequency of all bonds together.

        As measured on the test rig, see `analysis.stability.recommendation`; None if that is not
        known: the algorithm is not recommended then.
        """
        return None

    @property
    def start_step(self) -> float:
        """Communication step size [s] if none is given; the largest one if it is adaptive."""
        return self.default_step

    @classmethod
    def variants(cls) -> tuple[Self, ...]:
        """What there is to examine: all choices of the options, other options at their defaults."""
        choices = {f.name: f.metadata["choices"] for f in fields(cls)}
        chosen = {name: values for name, values in choices.items() if values}
        return tuple(cls(**dict(zip(chosen, v, strict=True))) for v in product(*chosen.values()))

    @classmethod
    def charted(cls) -> tuple[Self, ...]:
        """Variants that a speed-accuracy chart shows if none are named."""
        return (cls(),)

    @classmethod
    def allowed(cls, name: str) -> str:
        """In words, which values an option may have."""
        return next(f for f in fields(cls) if f.name == name).metadata["allowed"]

    def refuse(self, name: str) -> NoReturn:
        """Say that an option has a value that it may not have.

        Raises:
            ParameterError: always.
        """
        value = getattr(self, name)
        raise ParameterError(f"{self.name}: {name}={value}; it must be {self.allowed(name)}")

    def __str__(self) -> str:
        options = ",".join(f"{f.name}={getattr(self, f.name)}" for f in fields(self))
        return f"{self.name}:{options}" if options else self.name


def check_multirate(algorithm: Algorithm) -> None:
    """Check that an algorithm takes slow bodies.

    Raises:
        ParameterError: it does not.
    """
    if not algorithm.multirate:
        raise ParameterError(
            f"slow: {algorithm} steps all bodies alike; use jacobi, or li without a tolerance"
        )
