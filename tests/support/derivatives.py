"""Participants that take and give FMI 2 derivatives instead of signal nodes."""

import ctypes
import math
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from support.parts.fakes import DISCARD, OK
from support.parts.two_masses import Mass

_ORDERS = ctypes.POINTER(ctypes.c_int32)
_DERIVATIVES = ctypes.CFUNCTYPE(
    ctypes.c_int32,
    ctypes.c_void_p,
    ctypes.POINTER(ctypes.c_uint32),
    ctypes.c_size_t,
    _ORDERS,
    ctypes.POINTER(ctypes.c_double),
)


class DerivativeMass(Mass):
    """A free mass, exact for a polynomial force that comes as value and derivatives.

    Args:
        order: highest order of input derivatives that it takes.
        rates: it declares output derivatives; "refused" if it then refuses to give them.
        status: what it answers to derivatives above the order.
        more: options of `Mass`.
    """

    def __init__(self, *arguments, order=4, rates=True, status=DISCARD, **more):
        super().__init__(*arguments, **(more | {"nodes": False}))
        self.order, self.rates, self.status = order, rates, status
        self.slopes: dict[int, list[float]] = {}
        self.h = self.end_force = 0.0
        self._derivatives = [_DERIVATIVES(self._set_inputs), _DERIVATIVES(self._get_outputs)]

    @property
    def addresses(self):
        found = super().addresses
        inputs, outputs = (ctypes.cast(f, ctypes.c_void_p).value for f in self._derivatives)
        return found._replace(set_derivatives=inputs, get_derivatives=outputs * bool(self.rates))

    def _set_inputs(self, _component, references, count, orders, values):
        if any(orders[i] > self.order for i in range(count)):
            return self.status
        for i in range(count):
            slopes = self.slopes.setdefault(references[i], [0.0] * 4)
            slopes[orders[i] - 1] = values[i]
        return OK

    def _get_outputs(self, _component, references, count, orders, values):
        if self.rates == "refused" or any(orders[i] != 1 for i in range(count)):
            return DISCARD
        rate = {
            self.variables["flange.s"].reference: self["flange.v"],
            self.variables["flange.v"].reference: self.end_force / self.mass,
        }
        for i in range(count):
            values[i] = rate[references[i]]
        return OK

    def nodal(self, name):
        """The force at 0, 1/4 ... 1 of the step, which is that polynomial."""
        slopes = self.slopes.get(self.variables[name].reference, [])
        since = self.h * np.arange(5) / 4.0
        terms = [d * since**k / math.factorial(k) for k, d in enumerate(slopes, 1)]
        return list(np.sum([np.full(5, self[name]), *terms], axis=0))

    def step(self, t, h):
        self.h = h
        self.end_force = self.nodal("flange.f")[-1] + self.nodal("load.f")[-1]
        return super().step(t, h)


def without_nodes(fmu: Path, folder: Path, **flags: object) -> Path:
    """A stranger's view of one of our FMUs: the same binary, its signal nodes not declared.

    Args:
        fmu: the FMU, 2.0 or 3.0.
        folder: where the new one goes.
        flags: attributes of CoSimulation, such as canInterpolateInputs="false".
    """
    folder.mkdir(exist_ok=True)
    found = folder / fmu.name
    with zipfile.ZipFile(fmu) as archive, zipfile.ZipFile(found, "w") as changed:
        for name in archive.namelist():
            content = archive.read(name)
            if name == "modelDescription.xml":
                content = _hide_nodes(content, flags)
            changed.writestr(name, content)
    return found


def _hide_nodes(description: bytes, flags: dict[str, object]) -> bytes:
    root = ElementTree.fromstring(description)
    for name, value in flags.items():
        root.find("CoSimulation").set(name, str(value))
    if root.get("fmiVersion") == "3.0":
        return _hide_arrays(root)
    variables = root.find("ModelVariables")
    names = [v.get("name") for v in variables]
    kept = [n for n in names if ".node" not in n and n != INTERFACE_DEGREE]
    place = {str(names.index(n) + 1): str(i) for i, n in enumerate(kept, 1)}
    for v in list(variables):
        if v.get("name") not in kept:
            variables.remove(v)
    for group in root.find("ModelStructure"):
        for unknown in list(group):
            if unknown.get("index") not in place:
                group.remove(unknown)
                continue
            unknown.set("index", place[unknown.get("index")])
            if unknown.get("dependencies"):
                pairs = zip(
                    unknown.get("dependencies").split(),
                    (unknown.get("dependenciesKind") or "").split()
                    or [""] * len(unknown.get("dependencies").split()),
                    strict=True,
                )
                left = [(place[d], kind) for d, kind in pairs if d in place]
                unknown.set("dependencies", " ".join(d for d, _ in left))
                if unknown.get("dependenciesKind"):
                    unknown.set("dependenciesKind", " ".join(kind for _, kind in left))
    for v in variables:
        real = v.find("Real")
        if real is not None and real.get("derivative") in place:
            real.set("derivative", place[real.get("derivative")])
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


def _hide_arrays(root: ElementTree.Element) -> bytes:
    """As `_hide_nodes`, for FMI 3.0, whose structure goes by value references."""
    variables, hidden = root.find("ModelVariables"), set()
    for v in list(variables):
        if v.get("name").endswith(".node") or v.get("name") == INTERFACE_DEGREE:
            variables.remove(v)
            hidden.add(v.get("valueReference"))
    for unknown in list(root.find("ModelStructure")):
        if unknown.get("valueReference") in hidden:
            root.find("ModelStructure").remove(unknown)
            continue
        left = [d for d in (unknown.get("dependencies") or "").split() if d not in hidden]
        if "dependencies" in unknown.attrib:
            unknown.set("dependencies", " ".join(left))
        if "dependenciesKind" in unknown.attrib:
            unknown.set("dependenciesKind", " ".join(["dependent"] * len(left)))
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
