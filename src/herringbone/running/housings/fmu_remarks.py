"""Testing a housing FMU against the contract of housings before it runs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from herringbone.analysis.finding import Finding, Verdict
from herringbone.analysis.housing.contract import of_energy
from herringbone.analysis.housing.runs import VARIABLES
from herringbone.core import HerringboneError, Outcome, OutcomeKind, StructureError
from herringbone.core.names import first_of
from herringbone.cosim.cell.policy import policy
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.running.housings.tested import tested_housing

_SIZE = "compliance"
_SHOWN = 3
"""Missing variables, by name in a line."""


@dataclass(frozen=True)
class HousingRemarks:
    """What is to be said of a housing FMU that takes part in a run.

    Attributes:
        part: whose place it takes.
        lines: that the user should read; at least one.
        energy: the one of them that says that it makes energy; empty: it makes none.
    """

    part: str
    lines: tuple[str, ...]
    energy: str = ""


def refuse_other_kinds(system: System, part: str, fmu: Path) -> None:
    """Check that an FMU has what a housing is joined by, so that one line says what lacks.

    Args:
        system: in which the part is joined.
        part: that is replaced.
        fmu: in its place.

    Raises:
        FmuError: it cannot be read.
        StructureError: nothing that joins the part is there: it is something else; or some is not.
    """
    ends = (system.split(path) for pair in system.connections for path in pair)
    joined = dict.fromkeys(name for owner, name in ends if owner == part)
    known = [variable.name for variable in read_fmu(fmu).modelVariables]
    if joined and not any(v == name or v.startswith(f"{name}.") for v in known for name in joined):
        raise StructureError(
            f"{part}: {fmu} is no housing: it has none of {', '.join(joined)}, by which "
            f"{system.name} joins it; see 'herringbone check {fmu} --as housing'"
        )
    wanted = [v for v in VARIABLES if any(v == name or v.startswith(f"{name}.") for name in joined)]
    if missing := [v for v in wanted if v not in known]:
        raise StructureError(
            f"{part}: {fmu} lacks {first_of(missing, _SHOWN)}, of the {len(wanted)} "
            f"variables by which {system.name} joins a housing; see 'herringbone check {fmu} --as "
            "housing'"
        )


def replacement_remarks(part: str, fmu: Path, usual: float) -> HousingRemarks | None:
    """What a housing FMU that replaces a part does not hold; tested once per content.

    Wrong variables, and units of another dimension, are refused by the wiring, too.

    Args:
        part: that is replaced.
        fmu: in its place.
        usual: static compliance of the part that is replaced [m/N].
    """
    try:
        lines, energy = _tested(fmu, usual)
    except HerringboneError as error:
        return HousingRemarks(part, (f"{fmu} could not be tested as housing: {error}",))
    return HousingRemarks(part, tuple(lines), energy) if lines else None


def untested(part: str, fmu: Path) -> HousingRemarks:
    """What is said of a housing FMU that replaces a part where no trial steps are to be made."""
    line = f"{fmu} was not tested as housing, as no trial steps were to be made (no probe)"
    return HousingRemarks(part, (line,))


def _tested(fmu: Path, usual: float) -> tuple[list[str], str]:
    """Lines on what does not hold, and the one on energy, or nothing."""

    def broken(finding: Finding) -> str:
        return (
            f"{fmu} breaks the contract of housings: {finding.test}: {finding.measured} "
            f"(limit {finding.limit}); see 'herringbone check {fmu} --as housing'"
        )

    findings = tested_housing(fmu, usual, longest=policy().longest_trial).findings
    lines = [broken(finding) for finding in findings if not finding.holds]
    lines += [
        f"{fmu}: the static {finding.test} of its seats is {finding.measured}"
        for finding in findings
        if finding.test == _SIZE and finding.verdict is Verdict.REMARK
    ]
    if left := [finding for finding in findings if finding.verdict is Verdict.NOT_TESTED]:
        names = ", ".join(finding.test for finding in left)
        lines.append(f"{fmu} was tested as housing, but not for {names}: {left[0].measured}")
    return lines, next(map(broken, of_energy(findings)), "")


def with_remarks(result: Result, remarks: Sequence[HousingRemarks]) -> Result:
    """The result, which has not completed if a housing made energy; of one that diverged, why."""
    outcome = result.outcome
    if remarks and outcome.unstable:
        said = f"{outcome.message}; {remarks[0].part}: {remarks[0].lines[0]}"
        return replace(result, outcome=replace(outcome, message=said))
    active = [own for own in remarks if own.energy]
    if not active or outcome.kind is not OutcomeKind.COMPLETED:
        return result
    said = (
        f"{active[0].part} makes energy, so that no figure of the run is that of a gearbox: "
        f"{active[0].energy}"
    )
    kind = OutcomeKind.PART_MAKES_ENERGY
    return replace(result, outcome=Outcome(kind, outcome.time, active[0].part, said))
