"""Testing a housing FMU against the contract of housings before it runs."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from herringbone.analysis.finding import Finding, Verdict
from herringbone.analysis.housing.contract import check_housing, of_energy
from herringbone.core import HerringboneError, Outcome, OutcomeKind, StructureError
from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import digest_of, sources_key
from herringbone.core.caching.tried import tried_folder
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.fmu.opening import open_fmu
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result

_SIZE = "compliance"


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
    """Check that an FMU has anything of what a housing is joined by; what else lacks is remarked.

    Args:
        system: in which the part is joined.
        part: that is replaced.
        fmu: in its place.

    Raises:
        FmuError: it cannot be read.
        StructureError: nothing that joins the part is there: it is something else.
    """
    ends = (system.split(path) for pair in system.connections for path in pair)
    joined = dict.fromkeys(name for owner, name in ends if owner == part)
    known = [variable.name for variable in read_fmu(fmu).modelVariables]
    if joined and not any(v == name or v.startswith(f"{name}.") for v in known for name in joined):
        raise StructureError(
            f"{part}: {fmu} is no housing: it has none of {', '.join(joined)}, by which "
            f"{system.name} joins it; see 'herringbone check {fmu} --as housing'"
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
        digest = hashlib.sha256(fmu.read_bytes()).hexdigest()
    except OSError:
        return None
    known = tried_folder("housings") / f"{digest_of(sources_key(), digest, f'{usual:.3g}')}.json"
    if (found := kept(known)) is None:
        try:
            found = _tested(fmu, usual)
        except HerringboneError as error:
            return HousingRemarks(part, (f"{fmu} could not be tested as housing: {error}",))
        keep(known, found)
    lines, energy = found
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

    findings = check_housing(lambda: open_fmu("housing", fmu), usual=usual)
    lines = [broken(finding) for finding in findings if not finding.holds]
    lines += [
        f"{fmu}: the static {finding.test} of its seats is {finding.measured}"
        for finding in findings
        if finding.test == _SIZE and finding.verdict is Verdict.REMARK
    ]
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
