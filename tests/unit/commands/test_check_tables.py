"""The tables of `check FMU --as ROLE`."""

from herringbone.analysis.finding import judged, not_tested
from herringbone.commands.checking.contract import _table

WHY, OTHER = "the same steps give other outputs", "it does not start"


def test_a_reason_stands_once():
    findings = [judged("units", True, "as declared", "SI"), not_tested("no delay", WHY)]
    findings += [not_tested("feedthrough", WHY), not_tested("H-term", OTHER)]
    findings += [not_tested("passivity", WHY)]
    rows = [line.split(maxsplit=1) for line in _table(findings).splitlines()]
    shown = dict(rows)
    assert _table(findings).count(WHY) == 1
    assert _table(findings).count("see 'no delay'") == 2
    assert shown["passivity"] == "not tested  see 'no delay'"
    assert shown["H-term"] == f"not tested  {OTHER}"
