"""What foreign parts take from own ones and from each other, and what own ones take from them."""

from collections.abc import Sequence

import numpy as np

from herringbone.analysis.answered import Answers
from herringbone.cosim.structure.approach import SteadyInput
from herringbone.cosim.structure.network import Network
from herringbone.running.settling.own_motion import OwnMotion
from herringbone.running.settling.stranger import Stranger

_LEAST = {"m": 1e-9, "rad": 1e-6, "m/s": 1e-6, "rad/s": 1e-3, "N": 1e-3, "N.m": 1e-3}
"""Answers that are as good as none, by unit; others 1e-6."""


class Links:
    """Connections of strangers; the answers of all of them stand in one row (k,).

    Args:
        network: of all parts.
        strangers: the foreign ones.

    Attributes:
        own_outputs: paths of own outputs that strangers take, (n,).
    """

    def __init__(self, network: Network, strangers: Sequence[Stranger]) -> None:
        names = [part.name for part in network.parts]
        self._strangers = {s.name: s for s in strangers}
        crossing = [
            ((names[c.source], c.output), (names[c.target], c.input))
            for c in network.connections
            if {names[c.source], names[c.target]} & set(self._strangers)
        ]
        self._source = {to: of for of, to in crossing}
        taken = dict.fromkeys(of for of, _ in crossing)
        self._answers = [of for of in taken if of[0] in self._strangers]
        self.own_outputs = [".".join(of) for of in taken if of[0] not in self._strangers]
        self._fed = [
            (".".join(to), self._answers.index(of))
            for of, to in crossing
            if to[0] not in self._strangers
        ]

    def row(self, answers: dict[str, np.ndarray]) -> np.ndarray:
        """(k,) of the outputs of each stranger, by name."""
        return np.array(
            [answers[name][self._strangers[name].outputs.index(o)] for name, o in self._answers]
        )

    @property
    def has_states(self) -> np.ndarray:
        """(k,) True for answers of parts with memory."""
        return np.array([not self._strangers[name].at_once for name, _ in self._answers], bool)

    def slopes(self) -> np.ndarray:
        """(k, n) of answers that come at once, on own outputs."""
        found = np.zeros((len(self._answers), len(self.own_outputs)))
        for k, (name, output) in enumerate(self._answers):
            part = self._strangers[name]
            if not part.at_once:
                continue
            direct = part.feedthrough()[part.outputs.index(output)]
            for passed, given in zip(direct, part.inputs, strict=True):
                source = ".".join(self._source[name, given])
                if source in self.own_outputs:
                    found[k, self.own_outputs.index(source)] += passed
        return found

    def answered(
        self, constant: np.ndarray, slopes: np.ndarray, by_acceleration: np.ndarray
    ) -> Answers:
        """Straight lines (k,), (k, n), (k,) as what own inputs are given."""
        places = [k for _, k in self._fed]
        return Answers(
            tuple(path for path, _ in self._fed),
            constant[places],
            tuple(self.own_outputs),
            slopes[places],
            by_acceleration[places],
        )

    def own_values(self, motion: OwnMotion) -> np.ndarray:
        """(n,) own outputs in a motion."""
        return np.array([motion.outputs[path].value for path in self.own_outputs])

    def given(self, part: Stranger, motion: OwnMotion, answers: np.ndarray) -> list[SteadyInput]:
        """What a stranger is given in a motion, while all others answer (k,)."""
        found = []
        for name, begin in zip(part.inputs, part.begin, strict=True):
            of = self._source[part.name, name]
            if of in self._answers:
                value = float(answers[self._answers.index(of)])
                found.append(SteadyInput(name, value, begin=float(begin)))
                continue
            path = ".".join(of)
            output = motion.outputs[path]
            start = None if motion.turns(path) else float(begin)
            rate, second = motion.rates(output)
            found.append(SteadyInput(name, output.value, rate, second, start, output.is_speed))
        return found

    def declared_speed(self, motion: OwnMotion) -> tuple[float, str]:
        """Speed of the fastest shaft [rad/s] by what strangers declare at their flanges, and where.

        Of those that declare one, the first; 0 and "" where none does.
        """
        for (name, given), (source, output) in self._source.items():
            own = motion.outputs.get(f"{source}.{output}")
            part = self._strangers.get(name)
            if part is None or own is None or not (own.is_speed and own.by_acceleration):
                continue
            if begin := float(part.begin[part.inputs.index(given)]):
                return begin / own.by_acceleration, f"{name}.{given}"
        return 0.0, ""

    def sizes(self, answers: np.ndarray) -> np.ndarray:
        """(k,) largest answers of the same unit."""
        units = [self._strangers[n].units.get(o, "") for n, o in self._answers]
        largest = {
            unit: max(
                _LEAST.get(unit, 1e-6),
                *(abs(float(z)) for z, u in zip(answers, units, strict=True) if u == unit),
            )
            for unit in set(units)
        }
        return np.array([largest[unit] for unit in units])
