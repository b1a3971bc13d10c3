"""How a result was computed: settings, cost, and what the run and its parts tell."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from herringbone.core.declaring.anatomy import Anatomy
from herringbone.core.energy_report import Diagnosis, EnergyReport
from herringbone.core.sensor_spec import SensorSpec


@dataclass(frozen=True)
class RunInfo:
    """How a result was computed; the fields of the JSON summary.

    Attributes:
        system, scene, model: names; `model` is the list of components by instance.
        t_end: end that was asked for [s].
        communication_step, record_step: [s]; means, if the step is adaptive.
        micro_steps: longest internal step by instance [s], at the start.
        algorithm: as on the command line.
        fmu: "native", "python" or "in-process".
        macro_steps, passes, rollbacks, wall_s: cost of the loop.
        notes: downgrades and other lines to read.
        steps: if the step is adaptive, the macro steps "accepted" and "rejected", and the
            "shortest", "median" and "longest" of the accepted ones [s].
        estimate: if the step is adaptive, the relative error "asked" for, and what the steps let
            expect: of the "coupling", and of the "inner_steps" of the parts.
        tolerance_by_default: the error that was asked for is the default one: nothing was said of
            algorithm, step or tolerance.
        energy: what the coupling did to the energy; None where no element has dampers.
        why: of an unstable run, what grows and what helps; None if the linear parts do not tell.
        slow: bodies that step once in several macro steps, and in how many.
        core: of a fused run, the "degree" of its polynomials, the base "step" [s], and how many
            "steps", "halvings", "evaluations" of the laws and "bends" of them there were.
        parameters: all real parameters, and inputs that nothing feeds, by `instance.variable`, SI
            units; not in the summary.
        resources: files that components read, by `instance.variable`; not in the summary.
        anatomy: what the parts are for, and what is joined to what; not in the summary.
        sensors: those of the system, by name; not in the summary.
    """

    system: str
    scene: str
    model: Mapping[str, str]
    t_end: float
    communication_step: float
    record_step: float
    micro_steps: Mapping[str, float]
    algorithm: str
    fmu: str
    macro_steps: int
    passes: Mapping[str, int]
    rollbacks: int
    wall_s: float
    notes: tuple[str, ...] = ()
    steps: Mapping[str, float] | None = None
    estimate: Mapping[str, float] | None = None
    tolerance_by_default: bool = False
    energy: EnergyReport | None = None
    why: Diagnosis | None = None
    slow: Mapping[str, int] = field(default_factory=dict)
    core: Mapping[str, float] | None = None
    parameters: Mapping[str, float] = field(default_factory=dict, repr=False)
    resources: Mapping[str, str] = field(default_factory=dict, repr=False)
    anatomy: Anatomy = field(default_factory=Anatomy, repr=False)
    sensors: Mapping[str, SensorSpec] = field(default_factory=dict, repr=False)

    @property
    def all_fused(self) -> bool:
        """True if all parts made one core, so that nothing was coupled."""
        return self.core is not None and not self.passes
