"""Kinds of files of measured velocity."""

import io
from pathlib import Path

import numpy as np
import scipy.io.wavfile

from herringbone.analysis.measured.record import FEWEST, read_measured

_RATE = 2000
SIGNAL = np.sin(2.0 * np.pi * 90.0 / _RATE * np.arange(FEWEST))


def csv_record() -> bytes:
    """Of one channel."""
    rows = "".join(f"{k / _RATE!r},{v:.4f}\n" for k, v in enumerate(SIGNAL.tolist()))
    return f"# units: time s, A mm/s\ntime,A\n{rows}".encode()


def wav_record() -> bytes:
    """Of bytes."""
    stream = io.BytesIO()
    scipy.io.wavfile.write(stream, _RATE, np.rint(127.0 * SIGNAL + 128.0).astype(np.uint8))
    return stream.getvalue()


def universal_record() -> bytes:
    """Of one data set 58, single precision, even."""
    head = (
        "    -1\n    58\nA\nNONE\nNONE\nNONE\nNONE\n"
        "    1         1    0         0       NONE         1   3       NONE         1   1\n"
        f"{2:>10}{FEWEST:>10}{1:>10}{0.0:13.5e}{1.0 / _RATE:13.5e}{0.0:13.5e}\n"
        f"{17:>10}    0    0    0 {'Time':<20} {'s':<20}\n"
        f"{11:>10}    0    0    0 {'Velocity':<20} {'mm/s':<20}\n"
    )
    head += 2 * f"{0:>10}    0    0    0 {'NONE':<20} {'NONE':<20}\n"
    rows = [SIGNAL[k : k + 6] for k in range(0, FEWEST, 6)]
    data = "".join("".join(f"{v:13.5e}" for v in row) + "\n" for row in rows)
    return (head + data + "    -1\n").encode()


def read_wav(file: Path) -> object:
    """With a scale."""
    return read_measured(file, full_scale=0.05)
