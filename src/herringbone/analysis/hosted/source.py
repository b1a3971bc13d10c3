"""Source of the kernels that a gearbox for hosts has besides its parts.

**Flanges.** The end of a shaft has the angle phi + w (t - since) + offset, where the host has set
the angle phi at `since`, or it has run on to there when w was set; while the host gives nodes or
derivatives, phi + offset alone. Where it gives speed alone, phi is a state. tau_mean is the
integral of tau since the start of the step, over the time since then. Inside a step, time counts
from its start, so that a start time does not change a bit.
"""

from herringbone.analysis.hosted.start_places import FlangePlaces, StartPlaces
from herringbone.analysis.hosted.start_source import start_source
from herringbone.analysis.twin.composite_source import OwnLines


def own_lines(flanges: list[FlangePlaces], start: StartPlaces, starts: str) -> OwnLines:
    """The lines; `starts` calls the parts' start kernels on their blocks."""
    return OwnLines(
        "".join(_place(f, start) for f in flanges),
        "".join(_rates(f) for f in flanges),
        "".join(_results(f, start) for f in flanges),
        start_source(flanges, start, starts),
    )


def _place(f: FlangePlaces, s: StartPlaces) -> str:
    if f.angle >= 0:
        angle = f"    blocks[{f.end_phi}] = b[{f.angle}] + b[{f.offset}]\n"
    else:
        angle = (
            f"    blocks[{f.end_phi}] = b[{f.phi}] + b[{f.offset}]\n"
            f"    if b[{s.degree}] == 0.0 and b[{s.stepping}] != 0.0:\n"
            f"        blocks[{f.end_phi}] += b[{f.w}] * (b[{f.lead}] + t)\n"
        )
    return angle + f"    blocks[{f.end_w}] = b[{f.w}]\n"


def _rates(f: FlangePlaces) -> str:
    angle = f"    dx[{f.angle}] = b[{f.w}]\n" if f.angle >= 0 else ""
    return angle + f"    dx[{f.impulse}] = blocks[{f.end_tau}]\n"


def _results(f: FlangePlaces, s: StartPlaces) -> str:
    return (
        f"    since = t\n"
        f"    if b[{s.stepping}] == 0.0:\n"
        f"        since = t - b[{s.step_start}]\n"
        f"    b[{f.tau_mean}] = blocks[{f.end_tau}]\n"
        f"    if since > 0.0:\n"
        f"        b[{f.tau_mean}] = b[{f.impulse}] / since\n"
    )
