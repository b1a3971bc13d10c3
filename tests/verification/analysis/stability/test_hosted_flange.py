"""The largest communication step of one FMU at a host: closed forms, and runs of the FMU."""

import json
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.flange.hosted_flange import Host
from herringbone.commands import main as cli
from herringbone.cosim.fmu.opening import many_of
from herringbone.cosim.signature.trial import Trial
from herringbone.running.foreign import hosted_flange as module
from herringbone.running.foreign.hosted_flange import hosted_flange

MASS = "tau=f,phi=x,w=v"
HOST = Host(2.0, 500.0, 1.0)
WITHIN = 0.02
STEPS = 6000


def limit_of(found, order, *, parallel=False):
    return next(x.limit for x in found.limits if (x.order, x.parallel) == (order, parallel))


def growth_at_host(file, host, h, *, parallel=False, inside=False):
    """Logarithm of growth of a host's torque over the second half of a run of the FMU.

    The host of `analysis.flange.hosted_flange` at order 0: a free inertia at 1 rad/s.
    """
    inputs, outputs = (
        (["flange.phi", "flange.w"], ["flange.tau"]) if inside else (["f"], ["x", "v"])
    )
    with many_of(file.stem, file) as make:
        fmu = Trial(make(), inputs, outputs, 0.0, 1e3)
        motion, torque, torques = np.array([0.0, 1.0]), 0.0, []
        gain = np.array([host.stiffness, host.damping])
        seen = np.zeros(2)
        for _ in range(STEPS):
            late = float(gain @ (motion - seen)) if not inside else 0.0
            fmu.set(motion if inside else np.array([torque]))
            fmu.step(h)
            a = (torque if inside else -torque) / host.inertia
            motion = np.array([motion[0] + h * motion[1] + 0.5 * h * h * a, motion[1] + h * a])
            if inside:
                torque = float(fmu.values()[0])
            else:
                seen = fmu.values()
                torque = late if parallel else float(gain @ (motion - seen))
            torques.append(torque)
        fmu.close()
    size = np.abs(np.diff(torques))
    half = STEPS // 2
    return np.log(size[-half // 2 :].max() / size[half - half // 2 : half].max())


@pytest.mark.parametrize(("parallel", "share"), [(False, 2.0), (True, 2.0 / 3.0)])
def test_shaft_outside(kinds, parallel, share):
    """A free mass: H w = 4 zeta, and 4/3 zeta one step late, which is 2 D/K and 2/3 D/K."""
    file = kinds / "oscillator_mass.fmu"
    found = hosted_flange(file, MASS, HOST)
    assert found.promised
    limit = limit_of(found, 0, parallel=parallel)
    assert limit == pytest.approx(share * HOST.damping / HOST.stiffness, rel=0.01)
    assert growth_at_host(file, HOST, (1.0 - WITHIN) * limit, parallel=parallel) < 0.0
    assert growth_at_host(file, HOST, (1.0 + WITHIN) * limit, parallel=parallel) > 0.0


def test_scripts_get_what_the_command_shows(kinds, capsys):
    file = kinds / "oscillator_mass.fmu"
    given = {"inertia": HOST.inertia, "stiffness": HOST.stiffness, "damping": HOST.damping}
    found = hb.flange_stability(file, flange=MASS, **given)
    options = [text for name, value in given.items() for text in (f"--{name}", str(value))]
    assert cli.main(["stability", str(file), "--flange", MASS, *options]) == 0
    assert capsys.readouterr().out.strip() == str(found)
    assert found.limits == hosted_flange(file, MASS, HOST).limits


def test_every_instance_is_freed(kinds, monkeypatch):
    """All of them share a folder, which goes when the limits are found."""
    made, closed = [], []

    @contextmanager
    def watched(name, file):
        with many_of(name, file) as new:

            def make():
                part = new()
                made.append(part)
                close = part.close
                part.close = lambda: (closed.append(part), close())
                return part

            yield make

    monkeypatch.setattr(module, "many_of", watched)
    hosted_flange(kinds / "oscillator_mass.fmu", MASS, HOST)
    assert made
    assert set(map(id, made)) == set(map(id, closed))


def test_shaft_inside(kinds):
    """The drive with its own shaft, which takes the motion of the host's inertia."""
    file, host = kinds / "c_e_drive.fmu", Host(0.5)
    limit = limit_of(hosted_flange(file, "flange", host), 0)
    assert growth_at_host(file, host, (1.0 - WITHIN) * limit, inside=True) < 0.0
    assert growth_at_host(file, host, (1.0 + WITHIN) * limit, inside=True) > 0.0


def test_an_angle_that_the_fmu_lacks_is_the_integral_of_its_speed(kinds):
    file = kinds / "oscillator_mass.fmu"
    with_angle, without = (hosted_flange(file, name, HOST) for name in (MASS, "tau=f,w=v"))
    for one, other in zip(with_angle.limits, without.limits, strict=True):
        assert one.limit == pytest.approx(other.limit, rel=1e-3)


def test_derivatives_help(kinds):
    """The more, the lighter the damping: two masses, H w about 1.85 zeta^(1/3) and 0.95."""
    found = hosted_flange(kinds / "oscillator_mass.fmu", MASS, HOST)
    frequency = np.sqrt(HOST.stiffness * 1.5)
    zeta = 0.5 * HOST.damping * frequency / HOST.stiffness
    assert limit_of(found, 1) * frequency == pytest.approx(1.85 * zeta ** (1.0 / 3.0), rel=0.1)
    assert limit_of(found, 2) * frequency == pytest.approx(1.0, rel=0.1)


def test_command(kinds, capsys):
    drive = str(kinds / "c_e_drive.fmu")
    assert cli.main(["stability", drive, "--flange", "flange", "--inertia", "0.5", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [row["order"] for row in found["limits"]] == [0, 1, 2]
    assert found["promised"]
    assert cli.main(["stability", drive, "--flange", "flange", "--inertia", "0.5"]) == 0
    assert "inertia at the flange" in capsys.readouterr().out


def test_a_model_that_misses_by_as_much_as_there_is_gives_no_limits(kinds, capsys, monkeypatch):
    """Its limits would be those of another system: an exported gearbox in trials of 1 ms."""
    model_of = module._hosted
    tried = []

    def misses(*of):
        tried.append(of)
        return replace(model_of(*of), residual=5.0)

    monkeypatch.setattr(module, "_hosted", misses)
    drive = str(kinds / "c_e_drive.fmu")
    assert cli.main(["stability", drive, "--flange", "flange", "--inertia", "0.5"]) == 2
    assert "misses trials" in capsys.readouterr().err
    assert len(tried) > 1  # shorter and longer steps were tried before


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "give the host's --inertia"),
        (["--flange", "shaft", "--inertia", "1"], "no variable shaft.tau"),
        (["--flange", "tau=flange.tau,w=flange.q", "--inertia", "1"], "no input phi and flange.q"),
        (["--flange", "tau=flange.w,w=flange.phi", "--inertia", "1"], "flange.w is an input"),
        (["--inertia", "1", "--set", "flange.tau=3"], "it is an output, which the FMU computes"),
        (["--flange", "flange", "--inertia", "-1"], "must be positive"),
        (["--flange", "flange", "--inertia", "1", "--stiffness", "9"], "has its shaft inside"),
        (["--flange", "flange", "--inertia", "1", "--step", "1e-4"], "--step is of systems"),
    ],
)
def test_refusals(kinds, capsys, options, message):
    assert cli.main(["stability", str(kinds / "c_e_drive.fmu"), *options]) == 2
    assert message in capsys.readouterr().err
