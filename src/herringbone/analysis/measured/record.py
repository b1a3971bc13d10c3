"""A measured velocity, from a file: CSV, WAV or universal file.

**CSV** has the grammar of all flat files here: `# units: time s, A mm/s`, then `time,A`, then rows;
columns but `time` are channels, in m/s or mm/s. **WAV** has neither unit nor names: it takes the
velocity of its largest number; channels are counted from 1. **Universal files** have data set 58,
as text or binary, with real, even data of a velocity; channels are its names (line 1), in the order
of the file. Units are those of the axis labels, or SI units; times are in s or ms.
"""

import io
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from herringbone.components.resources.flat_csv import fields_of, read_flat_csv
from herringbone.core import ParameterError, ResourceError
from herringbone.core.reading.texts import LARGEST_MODEL, read_bytes, read_text
from herringbone.core.reading.universal import universal_sets

FEWEST = 64
"""A shorter record tells nothing of lines."""
_UNITS = {"m/s": 1.0, "mm/s": 1e-3}
_SECONDS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "": 1.0, "NONE": 1.0}
_EVEN, _COARSE = 1e-3, 0.1
"""By how much times may differ from a straight line, over the step: if they have many digits, and
at most by their last one."""
_TIME = "time"
_FUNCTION, _VELOCITY, _TIME_RESPONSE = 58, 11, 1
_CSV, _WAV, _UNIVERSAL = {".csv", ".txt"}, {".wav"}, {".uff", ".unv", ".uf", ".bunv"}


class MeasuredRecord(NamedTuple):
    """A measured velocity.

    Attributes:
        velocity: (n,) [m/s].
        sampling_hz: [Hz].
        channel: its name.
        file: it came from.
    """

    velocity: np.ndarray
    sampling_hz: float
    channel: str
    file: str


_Channels = tuple[Mapping[str, np.ndarray], float]
"""Velocities [m/s] by name, and the sampling rate [Hz]."""


def read_measured(
    file: str | Path, channel: str = "", full_scale: float | None = None
) -> MeasuredRecord:
    """Read a measured velocity; the module says of what files.

    Args:
        file: its ending tells the format: .csv, .txt; .wav; .uff, .unv.
        channel: name; may be left out if the file has one.
        full_scale: of WAV: velocity of its largest number [m/s].

    Raises:
        ParameterError: no such channel, or a full scale is missing, or given in vain.
        HerringboneError: pyuff is missing.
        ResourceError: the file cannot be read, or is no velocity over even times.
    """
    path = Path(file)
    kind = path.suffix.lower()
    if full_scale is not None and kind not in _WAV:
        raise ParameterError(f"{file}: only WAV takes a full scale; this file tells its unit")
    if kind in _CSV:
        channels, rate = _of_csv(path)
    elif kind in _WAV:
        channels, rate = _of_wav(path, full_scale)
    elif kind in _UNIVERSAL:
        channels, rate = _of_universal(path)
    else:
        known = ", ".join(sorted(_CSV | _WAV | _UNIVERSAL))
        raise ResourceError(f"{file}: '{kind}' is no format of records that is known: {known}")
    name = _chosen(path, channels, channel)
    velocity = np.asarray(channels[name], dtype=float)
    if velocity.size < FEWEST:
        raise ResourceError(f"{file}: {velocity.size} samples; a record takes {FEWEST} or more")
    if not np.isfinite(velocity).all():
        raise ResourceError(f"{file}: {name} has samples that are not finite")
    if velocity.min() == velocity.max():
        raise ResourceError(
            f"{file}: {name} is {velocity[0]:g} m/s throughout; was the sensor connected?"
        )
    return MeasuredRecord(velocity, rate, name, str(file))


def _chosen(path: Path, channels: Mapping[str, np.ndarray], wanted: str) -> str:
    names = ", ".join(channels)
    if not channels:
        raise ResourceError(f"{path}: it has no velocity")
    if wanted and wanted not in channels:
        raise ParameterError(f"{path}: there is no channel '{wanted}'; there are: {names}")
    if not wanted and len(channels) > 1:
        raise ParameterError(f"{path}: it has the channels {names}; name one")
    return wanted or next(iter(channels))


def _of_csv(path: Path) -> _Channels:
    text = read_text(path)
    header = next((line for line in text.split("\n") if line and not line.startswith("#")), "")
    found = [name.strip() for name in fields_of(header, path)]
    if header and _TIME not in found:
        raise ResourceError(f"{path}: column {_TIME} is missing; it has {', '.join(found)}")
    names = [name for name in found if name != _TIME]
    wanted = {_TIME: ("s",), **{name: tuple(_UNITS) for name in names}}
    columns, units = read_flat_csv(path, (), wanted)
    step = _even_step(columns[_TIME])
    if step is None:
        raise ResourceError(f"{path}: times must go up in even steps")
    return {name: _UNITS[units[name].strip()] * columns[name] for name in names}, 1.0 / step


def _even_step(times: np.ndarray) -> float | None:
    """Step [s] of times (n,); None if they are not even within the digits in which they stand."""
    place = np.arange(times.size) - 0.5 * (times.size - 1)
    step = float(place @ times / max(place @ place, 1.0))
    digit = next((10.0**-d for d in range(16) if np.array_equal(times.round(d), times)), 0.0)
    off = np.abs(times - times.mean() - step * place)
    within = max(_EVEN * step, min(digit, _COARSE * step))
    return step if step > 0.0 and off.max() <= within else None


def _of_wav(path: Path, full_scale: float | None) -> _Channels:
    from scipy.io import wavfile  # noqa: PLC0415 (lazy)

    if full_scale is None:
        raise ParameterError(
            f"{path}: WAV has no unit; give the velocity of its largest number in m/s, such as "
            "--full-scale 0.05"
        )
    if not 0.0 < full_scale < np.inf:
        raise ParameterError(f"full scale = {full_scale:g} m/s must be positive")
    content = read_bytes(path, LARGEST_MODEL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)
            warnings.filterwarnings("error", message=".*prematurely.*")
            rate, samples = wavfile.read(io.BytesIO(content))
    except Exception as error:  # struct, value and other errors, by what is damaged
        raise ResourceError(f"{path}: it is no whole WAV file of PCM or float samples") from error
    samples = samples[:, np.newaxis] if samples.ndim == 1 else samples
    numbers = _as_shares(samples) * full_scale
    return {str(k): column for k, column in enumerate(numbers.T, 1)}, float(rate)


def _as_shares(samples: np.ndarray) -> np.ndarray:
    """Samples over the largest number of their type."""
    kind = samples.dtype
    if kind.kind == "f":
        return samples.astype(float)
    half = 2.0 ** (8 * kind.itemsize - 1)
    return (samples.astype(float) - (half if kind.kind == "u" else 0.0)) / half


def _of_universal(path: Path) -> _Channels:
    found: dict[str, np.ndarray] = {}
    rates = []
    try:
        for number, item in enumerate(universal_sets(path, {_FUNCTION}), 1):
            if item["func_type"] != _TIME_RESPONSE or item["ordinate_spec_data_type"] != _VELOCITY:
                continue
            if not item["abscissa_spacing"] or np.iscomplexobj(item["data"]):
                raise ResourceError(f"{path}: data set {number} is no real signal over even times")
            if item["data"].size != item["num_pts"]:
                raise ResourceError(
                    f"{path}: data set {number} has {item['data'].size} of {item['num_pts']} values"
                )
            unit = str(item["ordinate_axis_units_lab"]).strip()
            if unit not in {*_UNITS, "", "NONE"}:
                raise ResourceError(
                    f"{path}: data set {number} is in '{unit}'; it takes {' or '.join(_UNITS)}"
                )
            clock = str(item["abscissa_axis_units_lab"]).strip()
            if clock not in _SECONDS:
                raise ResourceError(
                    f"{path}: times of data set {number} are in '{clock}'; it takes s or ms"
                )
            name = str(item["id1"]).strip()
            name = name if name not in {"", "NONE", *found} else str(number)
            found[name] = _UNITS.get(unit, 1.0) * np.asarray(item["data"], dtype=float)
            rates.append(1.0 / (_SECONDS[clock] * float(item["abscissa_inc"])))
    except (KeyError, TypeError, ValueError, ZeroDivisionError) as error:
        raise ResourceError(f"{path}: a data set {_FUNCTION} is malformed: {error}") from error
    if rates and max(rates) > min(rates) * (1.0 + _EVEN):
        raise ResourceError(f"{path}: its channels have several sampling rates")
    return found, rates[0] if rates else 0.0
