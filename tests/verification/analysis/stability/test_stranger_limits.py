"""Limits of systems of strangers: predicted before the run, and as runs of the FMUs show them.

Masses, springs and drives of `tests/fmus/kinds`; the values of the first two systems were drawn
from a commit's hash. Growth per step is compared, too: it is that of the amplification matrix.
"""

import json
import math
import re

import numpy as np
import pytest
from support.foreign.c_housing import c_housing_fmu
from support.foreign.kinds import without_states
from support.foreign.stranger_limits import ABOVE, BELOW, limits, run_rate

import herringbone as hb
from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.limits import default_algorithms
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.steps.clock_grid import clocks_of, common_steps
from herringbone.analysis.stability.steps.simulated_limit import nonlinear_limit
from herringbone.analysis.stability.steps.step_limits import step_limits
from herringbone.commands import main as cli
from herringbone.core import ParameterError
from herringbone.cosim.algorithms import Jacobi, iterated, parse_algorithm
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.foreign.linear_start import under_load
from herringbone.running.foreign.surrogates import opened_surrogates
from herringbone.running.prepared import Wishes, prepared

WITHIN = 0.02
RATE = 0.03
"""Deviation of growth per step above the limit: what other motions leave in a run."""
STEP = 4e-5
MASS, SPRING, DRIVE = "oscillator_mass.fmu", "oscillator_spring.fmu", "c_e_drive.fmu"
HASH = 0x56E4D81
"""Of the commit that the work began with."""


def _drawn(names):
    """Values between half and twice of these, by the hash."""
    random = np.random.default_rng(HASH + len(names))
    return {name: float(x * 2.0 ** random.uniform(-1.0, 1.0)) for name, x in names.items()}


SYSTEMS = {
    "2 inputs and 1 output": (
        {"one": MASS, "two": MASS},
        [["one.fo", "two.f"], ["two.x", "one.xo"], ["two.v", "one.vo"]],
        {"two.v0": -1.0}
        | _drawn({"one.m": 1.0, "one.k": 10.0, "one.c": 1.0, "one.ko": 100.0, "one.co": 1.0,
                  "two.m": 1.0, "two.k": 1000.0, "two.c": 1.0}),
    ),
    "2 inputs and 2 outputs": (
        {"one": MASS, "two": MASS},
        [["one.x", "two.xo"], ["one.v", "two.vo"], ["two.x", "one.xo"], ["two.v", "one.vo"]],
        {"one.v0": 1.0}
        | _drawn({"one.m": 1.0, "one.k": 10.0, "one.c": 1.0, "one.ko": 100.0, "one.co": 1.0,
                  "two.m": 1.0, "two.k": 1000.0, "two.c": 1.0, "two.ko": 100.0, "two.co": 1.0}),
    ),
    "an element alone": (
        {"one": MASS, "two": MASS, "spring": SPRING},
        [["one.x", "spring.xa"], ["one.v", "spring.va"], ["two.x", "spring.xb"],
         ["two.v", "spring.vb"], ["spring.fa", "one.f"], ["spring.fb", "two.f"]],
        {"one.v0": 1.0, "one.k": 10.0, "two.k": 1000.0, "spring.c": 1.0},
    ),
    "states and feedthrough": (
        {"drive": DRIVE, "wheel": MASS},
        [["drive.flange.tau", "wheel.f"], ["wheel.x", "drive.flange.phi"],
         ["wheel.v", "drive.flange.w"]],
        {"wheel.m": 0.5, "wheel.c": 0.1, "wheel.v0": 1.0},
    ),
    "free bodies": (
        {"a": "LinearCarriage.fmu", "b": MASS, "k": "c_spring_damper.fmu"},
        [["a.position", "k.x1"], ["a.velocity", "k.v1"], ["b.x", "k.x2"], ["b.v", "k.v2"],
         ["k.f1", "a.force_in"], ["k.f2", "b.f"]],
        {"b.m": 3.0, "b.v0": 0.1},
    ),
}  # fmt: skip


def make_system(folder, kinds, name):
    """One of the systems, by its name or as these are, with its values."""
    files, connections, values = SYSTEMS[name] if isinstance(name, str) else name
    lines = ['name = "strangers"', f"connections = {connections}", "[parts]"]
    lines += [f'{part} = {{ fmu = "{kinds / file}" }}' for part, file in files.items()]
    (folder / "system.toml").write_text("\n".join(lines), encoding="utf-8")
    return read_system(folder).with_values(values)


@pytest.mark.parametrize("name", SYSTEMS)
def test_limits_of_all_algorithms(kinds, tmp_path, name):
    """Within 2 %, each; below the limit a perturbation dies out, above it grows, as predicted."""
    system = make_system(tmp_path, kinds, name)
    with opened_surrogates(system, STEP) as found:
        assert not found.missing
        for algorithm in default_algorithms():
            predicted, seen, residual, expected, rates = limits(system, found.strangers, algorithm)
            assert residual < 1e-4
            if math.isfinite(predicted):
                assert seen == pytest.approx(predicted, rel=WITHIN), algorithm
                assert rates[1] == pytest.approx(expected[1], rel=RATE), algorithm
            else:
                step = 0.3
                growth = Amplification(
                    *linear_network(system, strangers=found.strangers), algorithm
                ).growth(step)
                rate = np.log(growth.radius)
                assert run_rate(system, found.strangers, algorithm, step, rate) < 0.0


def test_corrections_are_as_many_after_every_change(kinds, tmp_path, monkeypatch):
    """One that a step asks for, and the next one does not, is no answer to a change.

    A synchronous motor on the gearbox had growth by 109 a step at 698 us sharp, another one a band
    from 347.2 to 347.8 us, where runs and matrices beside it decay.
    """
    system = make_system(tmp_path, kinds, "states and feedthrough")
    with opened_surrogates(system, STEP) as found:

        def matrix(rest):
            monkeypatch.setattr(iterated, "REST", rest)
            network = linear_network(system, strangers=found.strangers)
            return Amplification(*network, parse_algorithm("li:degree=3")).matrix(1e-3)

        assert np.array_equal(matrix(iterated.REST), matrix(0.0))


ONCE = ["jacobi:order=2", "fixed_point:degree=3,sweeps=2", "li:degree=3"]
"""The first steps once; the others correct, which changes what a part misses in the step before."""


@pytest.mark.parametrize("algorithm", ONCE)
@pytest.mark.parametrize(
    ("name", "once"),
    [("2 inputs and 1 output", ("one", "two")), ("2 inputs and 1 output", ("one",)),
     ("an element alone", ("two",)), ("an element alone", ("spring",))],
)  # fmt: skip
def test_limits_of_parts_that_cannot_repeat_a_step(kinds, tmp_path, name, once, algorithm):
    """What they make up for in the next step is part of the map; tried on fresh instances."""
    files, connections, values = SYSTEMS[name]
    plain = {part: without_states(kinds / files[part]).name for part in once}
    system = make_system(tmp_path, kinds, (files | plain, connections, values))
    with opened_surrogates(system, STEP) as found:
        assert not found.missing
        tried = {name: s.surrogate.fresh_instances for name, s in found.strangers.items()}
        assert {name for name, count in tried.items() if count} == set(once)
        predicted, seen, residual, expected, rates = limits(
            system, found.strangers, parse_algorithm(algorithm)
        )
    assert residual < 1e-4
    assert seen == pytest.approx(predicted, rel=WITHIN)
    assert rates[1] == pytest.approx(expected[1], rel=RATE)


CURVE = "oscillator_curve.fmu"
"""It takes input derivatives up to the third order, and gives rates of its outputs."""


@pytest.mark.parametrize(
    "algorithm",
    ["jacobi:order=1", "jacobi:order=2",
     *(pytest.param(name, marks=pytest.mark.slow)
       for name in ("gauss_seidel", "fixed_point:degree=3,sweeps=2", "li:degree=3"))],
)  # fmt: skip
@pytest.mark.parametrize("curved", [("one", "two"), ("one",)], ids=["both", "one"])
def test_limits_with_input_derivatives(kinds, tmp_path, curved, algorithm):
    """Polynomials as they are; rates of outputs at the start of a step are part of the map."""
    files, connections, values = SYSTEMS["2 inputs and 1 output"]
    system = make_system(
        tmp_path, kinds, (files | dict.fromkeys(curved, CURVE), connections, values)
    )
    with opened_surrogates(system, STEP) as found:
        assert not found.missing
        assert {found.strangers[name].surrogate.orders for name in curved} == {3}
        predicted, seen, residual, expected, rates = limits(
            system, found.strangers, parse_algorithm(algorithm)
        )
    assert residual < 1e-4
    assert seen == pytest.approx(predicted, rel=WITHIN)
    assert rates[1] == pytest.approx(expected[1], rel=RATE)


def test_an_order_of_derivatives_that_a_part_refuses(kinds, tmp_path):
    files, connections, values = SYSTEMS["2 inputs and 1 output"]
    system = make_system(tmp_path, kinds, (files | {"one": CURVE}, connections, values))
    with (
        opened_surrogates(system, STEP) as found,
        pytest.raises(ParameterError, match="one refuses input derivatives of order 4"),
    ):
        step_limits(system, parse_algorithm("li:degree=4"), strangers=found.strangers)


def _sprung(force, position, velocity):
    """A body and a mass with a spring between them."""
    return [["s.fa", f"a.{force}"], ["s.fb", "b.f"], [f"a.{position}", "s.xa"],
            [f"a.{velocity}", "s.va"], ["b.x", "s.xb"], ["b.v", "s.vb"]]  # fmt: skip


CLOCKS = {
    "inner steps": (
        {"a": "c_fixed_step_rotor.fmu", "b": MASS, "s": SPRING},
        _sprung("tau", "phi", "w"),
        {"b.k": 1e4, "b.c": 1.0, "b.v0": 1.0}
        | _drawn({"s.k": 2e5, "s.c": 40.0, "b.m": 1.0}),
        1e-4,
    ),
    "one step only": (
        {"a": "c_press_ram.fmu", "b": MASS, "s": SPRING},
        _sprung("force", "pos", "vel"),
        {"b.k": 1e4, "b.c": 1.0, "b.v0": 1.0}
        | _drawn({"s.k": 2e5, "s.c": 40.0, "b.m": 1.0}),
        1e-3,
    ),
    "sampled": (
        {"a": "c_ecu_task.fmu", "b": MASS},
        [["a.torque_request", "b.f"], ["b.v", "a.w_meas"]],
        {"b.v0": 1.0} | _drawn({"b.m": 0.1, "b.c": 0.01}),
        1e-3,
    ),
}  # fmt: skip


@pytest.mark.parametrize("algorithm", ["jacobi:order=0", "jacobi:order=2", "li:degree=3"])
@pytest.mark.parametrize("name", CLOCKS)
def test_limits_of_parts_with_clocks(kinds, tmp_path, name, algorithm):
    """Growth in the runs is that of the matrices over a period: among whole periods at the last
    stable step and the first unstable one and, of a sampled part, in a quarter of a period."""
    *made, period = CLOCKS[name]
    system = make_system(tmp_path, kinds, made)
    chosen = parse_algorithm(algorithm)
    with opened_surrogates(system, STEP) as found:
        assert not found.missing
        predicted = step_limits(system, chosen, strangers=found.strangers)
        (clock,) = clocks_of(found.strangers)
        assert clock.period == period
        bands = predicted.unstable_bands
        limit = next((low for low, _ in bands if low >= period), math.inf)
        grid = [step for step in common_steps([clock], 1.0) if step >= period]
        looked = [step for step in grid if step < limit][-1:]
        looked += [limit] if math.isfinite(limit) else []
        looked += [0.25 * period] if name == "sampled" else []
        amplification = Amplification(*linear_network(system, strangers=found.strangers), chosen)
        for step in looked:
            expected = math.log(amplification.growth(step).radius)
            seen = run_rate(system, found.strangers, chosen, step, expected)
            assert amplification.residual < 1e-4
            assert (expected > 0.0) == (step >= limit)
            assert seen == pytest.approx(expected, rel=RATE)


def test_a_step_that_does_not_go_with_a_clock(kinds, tmp_path, capsys):
    *made, _ = CLOCKS["sampled"]
    make_system(tmp_path, kinds, made)
    command = ["stability", str(tmp_path), "--algorithm", "jacobi:order=0", "--step"]
    assert cli.main([*command, "3e-4"]) == 2
    assert "nothing is known of a step of 0.0003 s: a has a clock" in capsys.readouterr().err
    assert cli.main([*command, "2.5e-4"]) == 0
    assert "jacobi:order=0" in capsys.readouterr().out


@pytest.fixture(scope="module")
def c_housing(tmp_path_factory):
    """One that saves its states."""
    return c_housing_fmu(tmp_path_factory.mktemp("c_housing"), ("SAVES",), saves=True)


@pytest.mark.parametrize(
    "algorithm",
    [
        "jacobi:order=2",
        *(
            pytest.param(name, marks=pytest.mark.slow)
            for name in ("jacobi:order=0", "jacobi:order=1", "gauss_seidel", "predict",
                         "fixed_point", "li")
        ),
    ],
)  # fmt: skip
def test_housing_on_the_rig(c_housing, algorithm):
    """With contact: not below the prediction, to the 1 % of the runs, and not above 1.15 of it."""
    wishes = Wishes(replace_parts={"modal_housing": c_housing}, start_offset={})
    system = under_load(prepared("test_rig", "loaded", wishes).system)
    chosen = parse_algorithm(algorithm)
    with opened_surrogates(system, STEP) as found:
        (surrogate,) = (s.surrogate for s in found.strangers.values())
        assert surrogate.order == 24
        predicted = step_limits(system, chosen, strangers=found.strangers)
        assert predicted.promised
        seen = nonlinear_limit(
            system, chosen, predicted.limit, predicted.unstable_bands, found.strangers
        )
    assert seen is not None
    assert 0.99 <= seen / predicted.limit <= 1.15


def _limit(system, algorithm):
    with opened_surrogates(system, STEP) as found:
        return step_limits(system, algorithm, strangers=found.strangers).limit


def test_a_run_warns_of_an_unstable_step(kinds, tmp_path):
    """By the rate, and by what it makes of the run: little, which may not show, in percent."""
    system = make_system(tmp_path, kinds, "an element alone")
    limit = _limit(system, Jacobi(0))
    options = {
        "algorithm": "jacobi:order=0",
        "start": "rest",
        "values": SYSTEMS["an element alone"][2],
    }

    def warnings(step, t_end):
        run = hb.run(tmp_path, step=step, t_end=t_end, record_step=step, **options)
        return run, [note for note in run.info.notes if "unstable" in note]

    assert not warnings(BELOW * limit, 3.0)[1]
    quiet, said = warnings(1.05 * limit, 3.0)
    assert quiet.outcome.completed
    rate, grown = map(
        float,
        re.search(r"exp\((.*) t/s\): by (.*) % within the run(?:, with |;)", said[0]).groups(),
    )
    assert grown == pytest.approx(100.0 * math.expm1(3.0 * rate), rel=0.02)
    _, said = warnings(ABOVE * limit, 1000.0)
    assert "powers of e within the run" in said[0]


def test_command(kinds, tmp_path, capsys):
    """`stability` of a system of strangers, as text and at a step."""
    make_system(tmp_path, kinds, "an element alone")
    given = [f"--set={name}={x}" for name, x in SYSTEMS["an element alone"][2].items()]
    assert cli.main(["stability", str(tmp_path), *given, "--algorithm", "jacobi:order=0"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "one of order 2, two of order 2, spring of order 0" in text
    assert "nothing is promised" not in text
    assert cli.main(
        ["stability", str(tmp_path), *given, "--algorithm", "jacobi:order=0", "--step", "0.04"]
    ) == 0  # fmt: skip
    assert capsys.readouterr().out.startswith("unstable: jacobi:order=0")


def test_nothing_is_promised_of_a_part_that_cannot_be_tried(kinds, tmp_path, capsys):
    files = {"one": MASS, "two": "c_single_flywheel.fmu"}
    lines = ['name = "once"', 'connections = [["one.fo", "two.tau"], ["two.angle", "one.xo"]]']
    lines += ["[parts]", *(f'{part} = {{ fmu = "{kinds / f}" }}' for part, f in files.items())]
    (tmp_path / "system.toml").write_text("\n".join(lines), encoding="utf-8")
    assert cli.main(["stability", str(tmp_path)]) == 2
    assert "nothing is promised: two: it can be instantiated once only" in capsys.readouterr().err


def test_the_rest_of_the_table_stands(kinds, tmp_path, capsys):
    """A noisy sensor on a body: its line, and the limits of the system without it."""
    files, connections, values = SYSTEMS["2 inputs and 2 outputs"]
    made = (
        files | {"sensor": "WheelSpeedSensor.fmu"},
        [*connections, ["one.v", "sensor.w_true"], ["sensor.w_sensed", "two.f"]],
        values,
    )
    make_system(tmp_path, kinds, made)
    given = [f"--set={name}={x}" for name, x in values.items()]
    command = ["stability", str(tmp_path), *given, "--algorithm", "jacobi:order=1", "--json"]
    assert cli.main(command) == 0
    found = json.loads(capsys.readouterr().out)
    assert "what is told is of the system without sensor" in found["notes"]
    assert "nothing is promised: sensor: the same steps give other outputs" in found["notes"][0]
    assert not found["algorithms"][0]["promised"]
    whole = _limit(make_system(tmp_path, kinds, "2 inputs and 2 outputs"), Jacobi(1))
    assert found["algorithms"][0]["limit"] == pytest.approx(whole, rel=WITHIN)
