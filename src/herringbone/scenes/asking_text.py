"""What a scene asks, as text: speeds are in r/min there, as in studies."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from herringbone.analysis.leaner.form import Form
from herringbone.core import ParameterError
from herringbone.core.declaring.units import R_MIN
from herringbone.scenes.asking import Ask, Model, Motion, Operating, Range
from herringbone.scenes.checks import ends

ASKING = {"ask", "operating", "model"}
"""Keys of a scene that are read here."""
_PARTS = ("one_way", "frozen", "linear")
"""Of a model: what names parts."""


def read_asking(data: Mapping[str, Any], file: Path) -> tuple[tuple[Ask, ...], Operating, Model]:
    """What is asked, where, and of which model.

    Args:
        data: of the scene.
        file: it, for messages.

    Raises:
        ParameterError: unknown key, or a value of the wrong type or out of range.
    """
    try:
        return (
            tuple(_ask(each) for each in _tables(data.get("ask", []))),
            _operating(data.get("operating", {})),
            _model(data.get("model", {})),
        )
    except ParameterError as error:
        raise ParameterError(f"{file}: {error}") from None


def _tables(given: Any) -> list[Any]:  # noqa: ANN401 (anything from TOML)
    if not isinstance(given, list):
        raise ParameterError("ask: it takes tables [[ask]]")
    return given


def _ask(data: Any) -> Ask:  # noqa: ANN401 (anything from TOML)
    _known(data, "ask", {"what", "as", "tolerance", "band", "orders"})
    given = data.get
    return Ask(
        given("what", ()), given("as", Form.SPECTRUM), given("tolerance", 0.01),
        given("band", math.inf), given("orders", ()),
    )  # fmt: skip


def _operating(data: Any) -> Operating:  # noqa: ANN401
    _known(data, "operating", {"motion", "speed", "torque", "solver_tolerance"})
    speed, torque = _speed(data, "operating"), _range(data, "operating", "torque")
    given = data.get("solver_tolerance")
    return Operating(data.get("motion", Motion.STEADY), speed, torque, given)


def _model(data: Any) -> Model:  # noqa: ANN401
    _known(data, "model", {field.name for field in fields(Model)})
    at = {"speed": _speed(data, "model"), "torque": _range(data, "model", "torque")}
    return Model(**{**data, **at})


def _known(data: Any, name: str, keys: set[str]) -> None:  # noqa: ANN401
    if not isinstance(data, dict):
        raise ParameterError(f"{name}: it takes a table")
    if unknown := set(data) - keys:
        raise ParameterError(
            f"{name}: unknown key {', '.join(sorted(unknown))}; known: {', '.join(sorted(keys))}"
        )


def _range(data: Mapping[str, Any], table: str, key: str) -> Range | None:
    """A number, or [LOWEST, HIGHEST]; speeds are in r/min here, and checked as such."""
    return ends(data[key], f"{table}: {key}", still=key != "speed") if key in data else None


def _speed(data: Mapping[str, Any], table: str) -> Range | None:
    """The speed [rad/s]."""
    given = _range(data, table, "speed")
    return None if given is None else (given[0] / R_MIN, given[1] / R_MIN)


def asking_text(asks: tuple[Ask, ...], operating: Operating, model: Model) -> Iterator[str]:
    """Lines of a scene, as `read_asking` takes them."""
    at = {"speed": operating.speed, "torque": operating.torque}
    yield from ("", "[operating]", f'motion = "{operating.motion}"', *_ranges(at))
    if operating.solver_tolerance is not None:
        yield f"solver_tolerance = {operating.solver_tolerance:.6g}"
    for ask in asks:
        yield from ("", "[[ask]]", f"what = {_listed(ask.what)}", f'as = "{ask.form}"')
        yield f"tolerance = {ask.tolerance:g}"
        if ask.band < math.inf:
            yield f"band = {ask.band:g}"
        if ask.orders:
            yield f"orders = [{', '.join(f'{k:g}' for k in ask.orders)}]"
    if model:
        yield from ("", "[model]", f"hold = {_listed(model.hold)}")
        yield from (f"{key} = {_listed(own)}" for key in _PARTS if (own := getattr(model, key)))
        if model.harmonics:
            kept = (f'"{part}" = {count}' for part, count in model.harmonics)
            yield f"harmonics = {{ {', '.join(kept)} }}"
        if model.error is not None:
            yield f"error = {model.error:.3g}"
        yield from _ranges({"speed": model.speed, "torque": model.torque})


def _listed(texts: tuple[str, ...]) -> str:
    return "[" + ", ".join(f'"{text}"' for text in texts) + "]"


def _ranges(by_key: Mapping[str, Range | None]) -> Iterator[str]:
    for key, given in by_key.items():
        if given is not None:
            low, high = (value * (R_MIN if key == "speed" else 1.0) for value in given)
            yield f"{key} = [{low:.12g}, {high:.12g}]"
