"""Signatures of foreign FMUs, kept by what they depend on: content, values, step, and trials."""

import contextlib
import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import numpy as np

from herringbone.core.caching.files import write_file
from herringbone.core.caching.keys import digest_of, kernels_key
from herringbone.core.paths import cache_root
from herringbone.cosim.signature import Answer, Kind, Signature
from herringbone.cosim.signature.rotation import Given
from herringbone.cosim.signature.signature import Rate
from herringbone.cosim.structure.system import PartSpec

_TRIALS = "herringbone.cosim.signature.probe", "herringbone.running.foreign.foreign_parts"


def known_signature(spec: PartSpec, step: float, find: Callable[[], Signature]) -> Signature:
    """The signature that was found before, or is found now and kept.

    One that is unknown is not kept: what stood against the trials may have been elsewhere.

    Args:
        spec: of a foreign part.
        step: of the trials [s].
        find: makes the trials.
    """
    file = cache_root() / "signatures" / f"{_key(spec, step)}.json"
    try:
        return _read(file)
    except (OSError, ValueError, TypeError, KeyError):  # none, or a damaged one
        found = find()
    if found.kind is not Kind.UNKNOWN:
        with contextlib.suppress(OSError):  # it only saves time
            write_file(file, json.dumps(_plain(found)).encode())
    return found


def _key(spec: PartSpec, step: float) -> str:
    values = [f"{name} {value!r}" for name, value in sorted(spec.values.items())]
    named = [Path(v) for v in spec.values.values() if isinstance(v, str) and v]
    contents = [file.read_bytes() for file in (Path(str(spec.fmu)), *filter(_is_file, named))]
    return digest_of(kernels_key(*_TRIALS), *contents, repr(float(step)), *values)


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # a text that is no path
        return False


def _plain(found: Signature) -> dict:
    plain = asdict(found)
    plain["feedthrough"], plain["delay"] = found.feedthrough.tolist(), found.delay.tolist()
    return plain


def _read(file: Path) -> Signature:
    """Raises OSError, ValueError, TypeError or KeyError."""
    kept = json.loads(file.read_text(encoding="utf-8"))
    inputs, outputs = tuple(kept.pop("inputs")), tuple(kept.pop("outputs"))
    shape = len(outputs), len(inputs)
    rates = tuple(Rate(**{**rate, "holds": Answer(rate["holds"])}) for rate in kept.pop("rates"))
    return Signature(
        inputs,
        outputs,
        kind=Kind(kept.pop("kind")),
        feedthrough=np.array(kept.pop("feedthrough"), dtype=float).reshape(shape),
        memory=Answer(kept.pop("memory")),
        delay=np.array(kept.pop("delay"), dtype=int).reshape(shape),
        rates=rates,
        given=tuple(Given(rule) for rule in kept.pop("given")),
        rate_inputs=tuple(kept.pop("rate_inputs")),
        notes=tuple(kept.pop("notes")),
        **kept,
    )
