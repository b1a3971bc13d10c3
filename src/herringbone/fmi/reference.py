"""Reference results inside an FMU, and their replay: the layered standard FMI-LS-REF.

A manifest names the files: inputs, held from one of their times to the next, which are the
communication points, and results. Ours are the golden run of a component, and the first steps of
the default experiment of anything else.
"""

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from fmpy.model_description import ModelDescription

from herringbone.components.registry import component
from herringbone.core import FmuError
from herringbone.core.reading.archives import open_archive
from herringbone.core.reading.numbers import number
from herringbone.core.reading.xml import parse_xml
from herringbone.fmi import golden
from herringbone.fmi.host import Host, Host3, open_host

NAME: Final = "org.fmi-standard.fmi-ls-ref"
VERSION: Final = "1.0.0-beta.1"
_FOLDER: Final = f"extra/{NAME}"
_MANIFEST: Final = f"{_FOLDER}/fmi-ls-manifest.xml"
_NAMESPACE: Final = "http://fmi-standard.org/fmi-ls-manifest"
_INPUT, _RESULT = "input", "result"
_REAL = {"Real", "Float64"}
_STEPS = 20
_LARGEST = 2**26  # bytes of a file
_EQUAL = 1e-6
"""Difference that is none, over the largest value of a column; FMUs with a tolerance: that one."""


def reference_files(fmu: Path, *, shipped: bool) -> dict[str, bytes]:
    """Files for an FMU: manifest, inputs, results; `shipped`: its golden result is known.

    Raises:
        FmuError: the FMU does not run.
    """
    name = fmu.stem
    inputs, results = _golden(name) if shipped else _recorded(fmu)
    return {
        _MANIFEST: _manifest(name),
        f"{_FOLDER}/{name}_in.csv": inputs,
        f"{_FOLDER}/{name}_out.csv": results,
    }


def _manifest(name: str) -> bytes:
    root = Element(
        "fmiReferences",
        {
            "xmlns:fmi-ls": _NAMESPACE,
            "fmi-ls:fmi-ls-name": NAME,
            "fmi-ls:fmi-ls-version": VERSION,
            "fmi-ls:fmi-ls-description": "Reference results, and the inputs that give them",
        },
    )
    for role, end in ((_INPUT, "in"), (_RESULT, "out")):
        SubElement(root, "Related", type="text/csv", source=f"{name}_{end}.csv", role=role)
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True)


def _golden(name: str) -> tuple[bytes, bytes]:
    """Inputs and results of a component's golden run."""
    found = component(name)
    times = [n * golden.STEP_SIZE for n in range(golden.STEPS + 1)]
    given = [golden.inputs(found, t) for t in times]
    rows = [[t, *values.values()] for t, values in zip(times, given, strict=True)]
    return _csv(["time", *given[0]], rows), golden.golden_file(found).read_bytes()


def _recorded(fmu: Path) -> tuple[bytes, bytes]:
    """The first steps of the default experiment, inputs as they start; shafts turn."""
    with open_host(fmu.stem, fmu) as host:
        inputs = [
            v.name
            for v in host.model.modelVariables
            if v.causality == "input" and v.type in _REAL and not v.dimensions
        ]
        names = _outputs(host.model)
        host.initialise()
        step = float(host.model.defaultExperiment.stepSize)
        start = dict(zip(inputs, host.values(*inputs), strict=True)) if inputs else {}
        times = [n * step for n in range(_STEPS + 1)]
        given = [_turned(start, time) for time in times]
        rows = [host.values(*names)]
        for n, time in enumerate(times[:-1]):
            host.set_values(given[n])
            host.step(time, step)
            rows.append(host.values(*names))
    return (
        _csv(["time", *inputs], [[t, *row.values()] for t, row in zip(times, given, strict=True)]),
        _csv(["time", *names], [[t, *row] for t, row in zip(times, rows, strict=True)]),
    )


def _turned(start: Mapping[str, float], time: float) -> dict[str, float]:
    """Inputs at a time [s]: as at the start, but an angle `x.phi` goes on with its speed `x.w`."""
    rates = {name: start.get(f"{name.removesuffix('.phi')}.w", 0.0) for name in start}
    return {
        name: value + rates[name] * time if name.endswith(".phi") else value
        for name, value in start.items()
    }


def _csv(head: Sequence[str], rows: Iterable[Sequence[float]]) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([repr(float(x)) for x in row] for row in rows)
    return text.getvalue().encode()


def _outputs(model: ModelDescription) -> list[str]:
    return [
        v.name
        for v in model.modelVariables
        if v.causality == "output" and v.type in _REAL and not v.dimensions
    ]


def replay(fmu: Path) -> list[str]:
    """Run an FMU as its reference results were made, and compare.

    Returns:
        Problems, one line each: columns that differ, or files that cannot be used. Nothing if the
        FMU has no reference results.

    Raises:
        FmuError: the FMU does not run.
    """
    try:
        files = _related(fmu)
        if _RESULT not in files:
            return []
        results = _table(files[_RESULT], f"{fmu}: reference results")
        inputs = _table(files[_INPUT], f"{fmu}: reference inputs") if _INPUT in files else {}
    except FmuError as error:
        return [str(error)]
    with open_host(fmu.stem, fmu) as host:
        return _compared(host, inputs, results)


def _related(fmu: Path) -> dict[str, bytes]:
    """The files that the manifest names, by role; nothing without a manifest."""
    with open_archive(fmu, "an FMU", FmuError) as archive:
        if _MANIFEST not in archive.names:
            return {}
        root = parse_xml(archive.read(_MANIFEST, _LARGEST), f"{fmu}: {_MANIFEST}", FmuError)
        found: dict[str, bytes] = {}
        for related in root.iter("Related"):
            path = f"{_FOLDER}/{related.get('source', '')}"
            if path not in archive.names:
                raise FmuError(f"{fmu}: {_MANIFEST} names {path}, which is not there")
            found.setdefault(related.get("role", ""), archive.read(path, _LARGEST))
    return found


def _table(data: bytes, what: str) -> dict[str, list[float]]:
    """Columns of a CSV file by name; the first one is the time."""
    try:
        head, *rows = csv.reader(io.StringIO(data.decode()))
        columns = [[number(x) for x in column] for column in zip(*rows, strict=True)]
        table = dict(zip(head, columns, strict=True))
    except (ValueError, UnicodeDecodeError) as error:
        raise FmuError(f"{what} are no table of numbers: {error}") from error
    if "time" not in table or not table["time"]:
        raise FmuError(f"{what} have no column 'time'")
    return table


def _compared(
    host: Host | Host3, inputs: Mapping[str, list[float]], results: Mapping[str, list[float]]
) -> list[str]:
    experiment = host.model.defaultExperiment
    equal = max(_EQUAL, float(experiment.tolerance or 0.0)) if experiment else _EQUAL
    names = [n for n in _outputs(host.model) if n in results]
    times = inputs.get("time") or _times(host.model, results["time"])
    given = {n: values for n, values in inputs.items() if n != "time"}
    wanted = dict(zip(results["time"], zip(*(results[n] for n in names), strict=True), strict=True))
    host.initialise({n: values[0] for n, values in given.items()}, stop_time=max(1.0, times[-1]))
    worst: dict[str, tuple[float, float, float, float]] = {}
    for k, time in enumerate(times):
        if expected := _at(wanted, time):
            for n, value, right in zip(names, host.values(*names), expected, strict=True):
                size = max(*map(abs, results[n]), 1e-12)
                miss = abs(value - right) / size
                if not miss <= max(worst.get(n, (equal,))[0], equal):
                    worst[n] = miss, time, value, right
        if k + 1 < len(times):
            host.set_values({n: values[k] for n, values in given.items()})
            host.step(time, times[k + 1] - time)
    return [
        f"reference results: {n} = {value:.9g} instead of {right:.9g} at {time:g} s"
        for n, (_, time, value, right) in worst.items()
    ]


def _times(model: ModelDescription, results: list[float]) -> list[float]:
    """Communication points: those of the default experiment, else those of the results."""
    experiment = model.defaultExperiment
    if not experiment or not experiment.stepSize:
        return results
    step = float(experiment.stepSize)
    return [results[0] + n * step for n in range(round((results[-1] - results[0]) / step) + 1)]


def _at(wanted: Mapping[float, Sequence[float]], time: float) -> Sequence[float] | None:
    return next((v for t, v in wanted.items() if math.isclose(t, time, abs_tol=1e-12)), None)
