"""What a report says of a system's sensors: for people, and for programs."""

from collections.abc import Iterator
from typing import Any

from herringbone.analysis.figures.sensing.lines import SensorLine
from herringbone.analysis.figures.sensing.sensors import SensorFigures, sensor_figures
from herringbone.result.result import Result

_MM = 1e3
_LABEL = 20


def sensor_lines(result: Result) -> Iterator[str]:
    """A table: level and peak of the samples, clipped ones, and the largest line."""
    found = sensor_figures(result)[0] if result.info.sensors else {}
    if not found:
        return
    rates = sorted({f"{x.chain.sampling_hz:g}" for x in found.values()})
    label = f"Sensors, {', '.join(rates)} Hz"
    yield f"{label:<{_LABEL}}{'rms [mm/s]':>11}{'peak':>9}{'clipped':>9}   largest line"
    for name, figures in found.items():
        line = _told(figures.lines[0]) if figures.lines else "not steady, or too few samples"
        yield (f"{f'{name} ({figures.spec.axis})':<{_LABEL}}{figures.rms * _MM:>11.3g}"
               f"{figures.peak * _MM:>9.3g}{figures.saturated:>9}   {line}")  # fmt: skip


def _told(line: SensorLine) -> str:
    order = f" = {line.mesh_order} f_m" if line.mesh_order else ""
    folded = " folded" if line.folded else ""
    return f"{line.frequency_hz:>6.1f} Hz{order}{folded}, {line.amplitude * _MM:.3g} mm/s"


def sensor_values(result: Result) -> dict[str, Any]:
    """Figures of the sensors by name; SI units, frequencies in Hz."""
    found = sensor_figures(result)[0] if result.info.sensors else {}
    return {name: _values(figures) for name, figures in found.items()}


def _values(figures: SensorFigures) -> dict[str, Any]:
    return {
        "feels": figures.spec.path,
        "sampling_Hz": figures.chain.sampling_hz,
        "samples": len(figures.time),
        "rms_m_s": figures.rms,
        "peak_m_s": figures.peak,
        "saturated": figures.saturated,
        "lines": [vars(line) for line in figures.lines],
    }
