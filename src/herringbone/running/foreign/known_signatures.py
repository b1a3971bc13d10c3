"""Signatures of foreign FMUs, kept by what they depend on: content, values, step, and trials."""

from collections.abc import Callable
from dataclasses import asdict

import numpy as np

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import digest_of, kernels_key
from herringbone.core.caching.tried import tried_folder
from herringbone.cosim.cell.policy import policy
from herringbone.cosim.signature import Answer, Kind, Signature
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.signature import Rate
from herringbone.cosim.structure.system import PartSpec
from herringbone.running.content import contents_of

_TRIALS = "herringbone.cosim.signature.probe", "herringbone.running.foreign.trials"


def known_signature(spec: PartSpec, step: float, find: Callable[[], Signature]) -> Signature:
    """The signature that was found before, or is found now and kept.

    One that is unknown is not kept: what stood against the trials may have been elsewhere. Nor is
    one after a trial of the part was lost.

    Args:
        spec: of a foreign part.
        step: of the trials [s].
        find: makes the trials.
    """
    file = tried_folder("signatures") / f"{_key(spec, step)}.json"
    if (known := kept(file)) is not None:
        return _signature(known)
    found = find()
    if found.kind is not Kind.UNKNOWN and not policy().lost[spec.name]:
        keep(file, _plain(found))
    return found


def _key(spec: PartSpec, step: float) -> str:
    return digest_of(kernels_key(*_TRIALS), *contents_of(spec), repr(float(step)))


def _plain(found: Signature) -> dict:
    plain = asdict(found)
    plain["feedthrough"], plain["delay"] = found.feedthrough.tolist(), found.delay.tolist()
    return plain


def _signature(plain: dict) -> Signature:
    inputs, outputs = tuple(plain.pop("inputs")), tuple(plain.pop("outputs"))
    shape = len(outputs), len(inputs)
    rates = tuple(Rate(**{**rate, "holds": Answer(rate["holds"])}) for rate in plain.pop("rates"))
    return Signature(
        inputs,
        outputs,
        kind=Kind(plain.pop("kind")),
        feedthrough=np.array(plain.pop("feedthrough"), dtype=float).reshape(shape),
        memory=Answer(plain.pop("memory")),
        delay=np.array(plain.pop("delay"), dtype=int).reshape(shape),
        rates=rates,
        given=tuple(InputRule(rule) for rule in plain.pop("given")),
        rate_inputs=tuple(plain.pop("rate_inputs")),
        speeds=tuple(plain.pop("speeds")),
        notes=tuple(plain.pop("notes")),
        **plain,
    )
