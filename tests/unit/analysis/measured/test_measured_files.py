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
        (csv_text(values=0.0 * SIGNAL), "A is 0 m/s throughout; was the sensor connected"),
        (csv_text(values=0.0 * SIGNAL + 1.0), "A is 1 m/s throughout"),
        (csv_text(np.delete(TIME, 200), SIGNAL[1:]), "times must go up in even steps"),
        (csv_text(-TIME), "times must go up in even steps"),
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
    write_universal(tmp_path / "minutes.uff", SIGNAL, RATE, abscissa_axis_units_lab="min")
    with pytest.raises(HerringboneError, match="times of data set 1 are in 'min'; it takes s or"):
        read_measured(tmp_path / "minutes.uff")
    write_universal(tmp_path / "ms.uff", SIGNAL, RATE / 1e3, abscissa_axis_units_lab="ms")
    assert read_measured(tmp_path / "ms.uff").sampling_hz == pytest.approx(RATE, rel=1e-6)


def test_binary_universal_files_hold_marks_and_line_ends_as_numbers(tmp_path):
    """A number of the bytes of a mark, and of line feeds before one; the second set is text."""
    bits = np.frombuffer(b"\n    -1\n" + b"\n" * 8)
    values = np.concatenate([SIGNAL, bits, SIGNAL])
    file = tmp_path / "a.uff"
    write_universal(file, values, RATE, unit="m/s", scale=1.0, binary=1)
    content = file.read_bytes()
    with pytest.raises(
        HerringboneError, match="data set 1 has 400 of 802 values"
    ):  # pyuff sees a mark
        read_measured(file)
    file.unlink()
    values = np.concatenate([SIGNAL, bits[1:], SIGNAL])
    write_universal(file, values, RATE, unit="m/s", scale=1.0, binary=1)
    write_universal(file, SIGNAL, RATE, id1="B")
    np.testing.assert_array_equal(read_measured(file, "A").velocity, values)
    np.testing.assert_allclose(read_measured(file, "B").velocity, SIGNAL, rtol=1e-6, atol=1e-9)
    file.write_bytes(content[: len(content) // 2])
    with pytest.raises(HerringboneError, match="truncated: the last data set does not end"):
        read_measured(file)
    file.write_bytes(content[:200])
    with pytest.raises(HerringboneError, match="head of a data set 58b is malformed or cut off"):
        read_measured(file)


def test_times_are_even_within_their_digits(tmp_path):
    """39.0625 us in steps of a microsecond, and quotes around names."""
    file, rate = tmp_path / "a.csv", 25600.0
    rows = "\n".join(f"{k / rate:.6f},{v!r}" for k, v in enumerate(SIGNAL.tolist()))
    file.write_text(f'# units: time s, A m/s\n"time","A"\n{rows}\n')
    found = read_measured(file)
    assert found.sampling_hz == pytest.approx(rate, rel=2e-6)  # 400 rows: a digit in 15.6 ms
    np.testing.assert_array_equal(found.velocity, SIGNAL)
