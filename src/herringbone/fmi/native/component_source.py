"""The C file that describes one component to the wrapper; see component.h for every entry."""

from collections.abc import Iterable, Mapping, Sequence

from herringbone.components.resources.loader import ResourceLoader
from herringbone.core import Component, Text, Variable
from herringbone.core.caching.keys import sources_key
from herringbone.core.declaring.component import unbounded, unchanged
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.fmi.description.common import identifier
from herringbone.fmi.native.c_text import array, quoted, string_array
from herringbone.fmi.native.component_tables import (
    access,
    block_of,
    extents,
    rates,
    reals,
    unlike_nodes,
    vectors,
)
from herringbone.fmi.used_states import UsedStates

_ENTRY_POINTS = """\
int32_t hb_step(double *b, double *w, double t, double h);
void hb_rhs(double *b, double t, double *dx);
void hb_out(double *b, double t);
double hb_longest_step(double *b);
void hb_start(double *b);
int32_t hb_load(const double *values, const int64_t *shape, double *b, double *scratch,
                double *report);
int32_t hb_verify(double *b, double *report);
int32_t hb_settle(double *b, double t);
int32_t hb_remark(double *b, double *w, int32_t which, double *report);
void hb_tangent(double *b, double t, double *d, double *dx);
void hb_indicators(double *b, double t, double *z);
void hb_answer(double *b, double *w, double t, const uint32_t *references, int64_t count);
"""


def component_source(used: UsedStates) -> str:
    """C source that defines `hb_component`; it depends on the sources and the data set alone.

    Args:
        used: the component, and the states that its FMU shows.
    """
    component, declaration = used.component, used.component.declaration
    states, block, hosting = used.scalars(), block_of(used), component.hosting
    loader = component.load if isinstance(component.load, ResourceLoader) else None
    refusals = loader.refusals if loader else ()
    parts = [
        "/* Generated from a component's declaration, not to be edited. */",
        "#include <math.h>",
        "#include <stddef.h>",
        '#include "component.h"',
        _ENTRY_POINTS,
        array("HbReal reals", reals(declaration, block)),
        string_array("names", (v.name if v else "" for v in unlike_nodes(declaration, block))),
        string_array("units", (v.unit if v else "" for v in unlike_nodes(declaration, block))),
        array("uint8_t access", access(declaration, block, states)),
        array("uint8_t extents", extents(used)),
        array("uint32_t rates", rates(declaration, block)),
        array("uint32_t exchanged", states),
        array("HbVector vectors", vectors(used)),
        *_grammars(declaration.texts),
        array("HbRunsOn runs_on", _runs_on(component)),
        array("char *const not_settled", map(quoted, hosting.not_settled if hosting else ())),
        array("HbRemark remarks", _remarks(component)),
        array("HbText texts", _text_entries(declaration.texts)),
        array("HbRefusal refusals", (f"{{{r.text}, {quoted(r.format)}}}" for r in refusals)),
    ]
    entries = _entries(used, states, loader, len(refusals))
    rows = "".join(f"    .{name} = {value},\n" for name, value in entries.items())
    return "\n".join([*parts, f"const HbComponent hb_component = {{\n{rows}}};\n"])


def _entries(
    used: UsedStates, states: Mapping[int, Variable], loader: ResourceLoader | None, refusals: int
) -> dict[str, object]:
    """The members of `hb_component`, in the order of component.h.

    Args:
        used: the component, and the states that its FMU shows.
        states: those of them that are scalars, by index in the block.
        loader: of the component's resources; None without.
        refusals: how many reasons it has to refuse them.
    """
    component, declaration = used.component, used.component.declaration
    hosting, by_tolerance = component.hosting, component.by_tolerance
    return {
        "name": quoted(component.name),
        "token": quoted(identifier(component, used.built_with)),
        "sources": quoted(sources_key()),
        "states": declaration.state_count,
        "visible_states": len(declaration.states),
        "first_input": declaration.first_input,
        "inputs": len(declaration.inputs),
        "first_output": declaration.first_output,
        "node_outputs": len(declaration.node_outputs),
        "mutable_size": declaration.mutable_size,
        "first_table": declaration.first_table,
        "size": declaration.size,
        "work": max(declaration.work, 1),
        "degree": declaration.index[INTERFACE_DEGREE],
        "reals": "reals",
        "names": "names",
        "units": "units",
        "access": "access",
        "extents": "extents",
        "rates": "rates",
        "texts_count": len(declaration.texts),
        "texts": "texts",
        "step": "hb_step",
        "rhs": "hb_rhs",
        "out": "hb_out",
        "longest_step": "NULL" if component.longest_step is unbounded else "hb_longest_step",
        "start": "NULL" if component.start is unchanged else "hb_start",
        "load": "hb_load" if loader else "NULL",
        "verify": "hb_verify" if loader and loader.check else "NULL",
        "settle": "hb_settle" if hosting else "NULL",
        "not_settled": "not_settled",
        "remarks_count": len(by_tolerance.remarks) if by_tolerance else 0,
        "remarks": "remarks",
        "remark": "hb_remark" if by_tolerance else "NULL",
        "tolerance": declaration.index[by_tolerance.tolerance] if by_tolerance else 0,
        "watch": "&hb_watch" if hosting else "NULL",
        "start_made": _told_at_the_start(component),
        "runs_on_count": len(hosting.runs_on) if hosting else 0,
        "runs_on": "runs_on",
        "load_scratch": loader.scratch if loader else 0,
        "refusals_count": refusals,
        "refusals": "refusals",
        "exchanged_count": len(states),
        "exchanged": "exchanged",
        "vectors_count": sum(bool(v.vector.text) for v in used.vectors),
        "vectors": "vectors",
        "indicators_count": component.indicator_count,
        "indicators": "hb_indicators" if component.indicators else "NULL",
        "tangent": "hb_tangent",
        "answer": "hb_answer" if component.asked else "NULL",
        "stale": component.asked.stale if component.asked else 0,
    }


def _told_at_the_start(component: Component) -> str:
    """What warns of states: set ones where they are searched, else those that begin not at 0."""
    if component.hosting:
        return "hb_start_found"
    return "hb_start_made" if any(v.start for v in component.declaration.states) else "NULL"


def _runs_on(component: Component) -> Iterable[str]:
    index = component.declaration.index
    for which in component.hosting.runs_on if component.hosting else ():
        yield f"{{{', '.join(str(index[name]) for name in which)}}}"


def _remarks(component: Component) -> Iterable[str]:
    for remark in component.by_tolerance.remarks if component.by_tolerance else ():
        yield f"{{{quoted(remark.format)}, {int(remark.warning)}}}"


def _grammars(texts: Iterable[Text]) -> Iterable[str]:
    """The columns of each resource file, with their units and words."""
    for i, text in enumerate(texts):
        rows = []
        for k, column in enumerate(text.columns):
            lists = []
            for kind, values in (("units", column.units), ("words", column.words)):
                name = f"{kind}_{i}_{k}"
                if values:
                    yield array(f"char *const {name}", [*map(quoted, values), "NULL"])
                lists.append(name if values else "NULL")
            flags = f"{int(column.other_words)}, {int(column.rest)}"
            rows.append(f"{{{quoted(column.name)}, {', '.join(lists)}, {flags}}}")
        yield array(f"HbColumn columns_{i}", rows)


def _text_entries(texts: Sequence[Text]) -> Iterable[str]:
    place = {text.name: i for i, text in enumerate(texts)}
    for i, text in enumerate(texts):
        name, start, header = (quoted(s) for s in (text.name, text.start, text.header))
        counts = len(text.columns), text.header_count
        section = quoted(text.section) if text.section else "NULL"
        where = f"{section}, {place[text.shared or text.name]}"
        yield f"{{{name}, {start}, columns_{i}, {counts[0]}, {header}, {counts[1]}, {where}}}"
