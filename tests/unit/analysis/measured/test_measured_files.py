"""Files of measured velocity: the same record in all formats, and one line for each defect."""

import struct

import numpy as np
import pytest
from scipy.io import wavfile
from support.files.universal_file import write_universal

from herringbone.analysis.measured.record import read_measured
from herringbone.core import HerringboneError

RATE = 2000
TIME = np.arange(400) / RATE
SIGNAL = 0.01 * np.sin(2.0 * np.pi * 90.0 * TIME) + 0.002 * np.cos(2.0 * np.pi * 450.0 * TIME)
FULL = 0.05


def csv_text(time=TIME, values=SIGNAL, unit="mm/s", scale=1e3):
    rows = "\n".join(
        f"{t!r},{scale * v!r}" for t, v in zip(time.tolist(), values.tolist(), strict=True)
    )
    return f"# units: time s, A {unit}\ntime,A\n{rows}\n"


def test_all_formats_give_the_same_record(tmp_path):
    (tmp_path / "a.csv").write_text(csv_text())
    shares = SIGNAL / FULL
    kinds = {
        "i2": (np.rint(shares * 2**15).astype(np.int16), 2.0**-16),
        "i4": (np.rint(shares * 2**31).astype(np.int32), 2.0**-32),
        "u1": (np.rint(shares * 128 + 128).astype(np.uint8), 2.0**-8),
        "f4": (shares.astype(np.float32), 2.0**-24),
    }
    found = [(read_measured(tmp_path / "a.csv"), 1e-15)]
    for name, (samples, step) in kinds.items():
        wavfile.write(tmp_path / f"{name}.wav", RATE, samples)
        found.append((read_measured(tmp_path / f"{name}.wav", full_scale=FULL), FULL * 1.01 * step))
    write_universal(tmp_path / "a.uff", SIGNAL, RATE)
    found.append((read_measured(tmp_path / "a.uff"), 1e-6 * np.abs(SIGNAL).max()))
    for record, tolerance in found:
        assert record.sampling_hz == pytest.approx(RATE, rel=1e-6), record.file
        np.testing.assert_allclose(record.velocity, SIGNAL, rtol=0.0, atol=tolerance)


def test_channels_are_named(tmp_path):
    file = tmp_path / "two.wav"
    wavfile.write(file, RATE, np.stack([SIGNAL, 2.0 * SIGNAL], axis=1).astype(np.float32))
    second = read_measured(file, "2", full_scale=1.0)
    np.testing.assert_allclose(second.velocity, 2.0 * SIGNAL, rtol=1e-6, atol=1e-12)
    with pytest.raises(HerringboneError, match=r"it has the channels 1, 2; name one"):
        read_measured(file, full_scale=1.0)
    with pytest.raises(HerringboneError, match=r"no channel '3'; there are: 1, 2"):
        read_measured(file, "3", full_scale=1.0)


uneven = TIME.copy()
uneven[100] += 1e-4
DEFECTS = {
    "a.csv": [
        (csv_text(unit="g"), "it takes m/s or mm/s"),
        (csv_text(time=uneven), "times must go up in even steps"),
        (csv_text(TIME[:20], SIGNAL[:20]), "20 samples; a record takes 64 or more"),
        (csv_text().replace("time,A", "t,A"), "column time is missing"),
        (csv_text(values=np.append(SIGNAL[:-1], np.nan)), "not a finite number"),
        ("", "the first line must be '# units"),
    ],
    "a.dat": [("x", "'.dat' is no format of records that is known")],
    "a.wav": [("RIFF....WAVE", "no whole WAV file")],
    "a.uff": [("nothing", "no mark"), ("    -1\n    58\n", "truncated")],
}


@pytest.mark.parametrize(
    ("name", "text", "message"), [(n, t, m) for n, both in DEFECTS.items() for t, m in both]
)
def test_defects_are_one_line(tmp_path, name, text, message):
    file = tmp_path / name
    file.write_text(text)
    with pytest.raises(HerringboneError, match=message) as caught:
        read_measured(file, full_scale=FULL if name.endswith("wav") else None)
    assert "\n" not in str(caught.value)
    assert str(file) in str(caught.value)


def test_a_wav_file_is_whole_and_has_a_scale(tmp_path):
    file = tmp_path / "a.wav"
    wavfile.write(file, RATE, SIGNAL.astype(np.float32))
    with pytest.raises(HerringboneError, match="WAV has no unit"):
        read_measured(file)
    content = file.read_bytes()
    wavfile.write(file, RATE, SIGNAL[:0].astype(np.float32))
    with pytest.raises(HerringboneError, match="0 samples; a record takes 64 or more"):
        read_measured(file, full_scale=FULL)
    file.write_bytes(content[: len(content) // 2])
    with pytest.raises(HerringboneError, match="no whole WAV file"):
        read_measured(file, full_scale=FULL)
    file.write_bytes(content[:40] + struct.pack("<I", 2**31))
    with pytest.raises(HerringboneError):
        read_measured(file, full_scale=FULL)
    (tmp_path / "a.csv").write_text(csv_text())
    with pytest.raises(HerringboneError, match="only WAV takes a full scale"):
        read_measured(tmp_path / "a.csv", full_scale=1.0)


def test_universal_files_hold_velocities(tmp_path):
    write_universal(tmp_path / "acceleration.uff", SIGNAL, RATE, kind=12, unit="m/s2")
    with pytest.raises(HerringboneError, match="it has no velocity"):
        read_measured(tmp_path / "acceleration.uff")
    write_universal(tmp_path / "inches.uff", SIGNAL, RATE, unit="in/s")
    with pytest.raises(HerringboneError, match="is in 'in/s'; it takes m/s or mm/s"):
        read_measured(tmp_path / "inches.uff")
