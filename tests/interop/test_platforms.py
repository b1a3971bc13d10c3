"""The test rig's native FMUs on other platforms: the same bits as here.

The Windows binaries run under wine, those of aarch64 under qemu; a master written in C (jacobi.c)
steps them, compiled for the same platform.
"""

import importlib.util
import os
import shutil
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import fmpy
import numpy as np
import pytest
from jacobi_plan import read_rows, write_plan

import herringbone as hb
from herringbone.cosim.algorithms import Jacobi
from herringbone.fmi.native import PLATFORMS, build_native_fmus, own_platform
from herringbone.fmi.native.compiler import require_compiler
from herringbone.running.loading import load_scene, load_system
from herringbone.running.start import started

STEP, COUNT, EVERY = 2e-6, 100_000, 1000
MASTER = Path(__file__).with_name("jacobi.c")
WINDOWS_START = MASTER.with_name("windows_start.c")
WINDOWS_PARTS = "convert", "heap", "private", "runtime", "stdio", "string"
"""Of Windows' universal C runtime: those that the master calls."""
AARCH64_LIBC = Path("/usr/aarch64-linux-gnu")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        own_platform() != PLATFORMS["x86_64-linux"], reason="compared with 64-bit Linux on x86"
    ),
    pytest.mark.skipif(not importlib.util.find_spec("ziglang"), reason="ziglang is not installed"),
]


@dataclass(frozen=True)
class Runner:
    """How programs of a platform run here.

    Attributes:
        platform: its name.
        command: what comes before the program; nothing for the own platform.
        drive: what stands before an absolute path there.
    """

    platform: str
    command: tuple[str, ...] = ()
    drive: str = ""


RUNNERS = [
    Runner("x86_64-linux"),
    Runner("x86_64-windows", ("wine",), drive="Z:"),
    Runner("aarch64-linux", ("qemu-aarch64", "-L", str(AARCH64_LIBC))),
]


@pytest.fixture(scope="module")
def fmus():
    """Path of the FMU for all three platforms by component of the test rig."""
    names = sorted({str(part.component) for part in load_system("test_rig")[0].parts})
    return build_native_fmus(names, platforms=[runner.platform for runner in RUNNERS])


@pytest.fixture(scope="module", params=RUNNERS, ids=lambda runner: runner.platform)
def runner(request):
    command = request.param.command
    if command and not shutil.which(command[0]):
        pytest.skip(f"{command[0]} is not installed")
    if str(AARCH64_LIBC) in command and not (AARCH64_LIBC / "lib").is_dir():
        pytest.skip("the C library of aarch64 (libc6-arm64-cross) is not installed")
    return request.param


def compile_master(platform, folder):
    """The master's program for a platform; on Windows without mingw's library (windows_start.c)."""
    windows = platform.extension == "dll"
    command = require_compiler(platform).command
    flags = ["-std=c11", "-O1", "-Wall", "-Wextra", "-Werror", "-c"]
    flags.append(f"-I{Path(fmpy.__file__).parent / 'c-code'}")
    flags += ["-D__USE_MINGW_ANSI_STDIO=0", "-fno-stack-protector"] * windows
    program = folder / "jacobi.exe"
    objects = []
    for source in (MASTER, *[WINDOWS_START] * windows):  # zig takes one at a time
        objects.append(folder / f"{source.stem}.o")
        subprocess.run([*command, *flags, source, "-o", objects[-1]], check=True)
    libraries = ["-ldl"]
    if windows:
        libraries = [f"-lapi-ms-win-crt-{part}-l1-1-0" for part in WINDOWS_PARTS]
        libraries += ["-lkernel32", "-nostdlib", "-rtlib=none", "-Wl,-e,mainCRTStartup"]
    link = ["-fno-sanitize=undefined", *libraries]  # zig would build a library for it
    subprocess.run([*command, *objects, "-o", program, *link], check=True)
    return program


@pytest.fixture(scope="module")
def run_plan(runner, tmp_path_factory):
    """Function that runs the master on a plan, and gives its rows."""
    folder = tmp_path_factory.mktemp("master")
    program = compile_master(PLATFORMS[runner.platform], folder)
    quiet = {"WINEDEBUG": "-all", "WINEDLLOVERRIDES": "mscoree,mshtml="}

    def run(plan):
        done = subprocess.run(
            [*runner.command, program, plan.name],
            cwd=plan.parent,
            env={**os.environ, **quiet, "WINEPREFIX": str(folder / "wine")},
            capture_output=True,
            text=True,
            check=False,
            timeout=300,
        )
        assert done.returncode == 0, done.stderr[-2000:]
        return read_rows(done.stdout)

    return run


@pytest.mark.parametrize("scene", ["loaded", "separation"])
def test_same_bits_on_every_platform(scene, fmus, runner, run_plan, tmp_path):
    """Against the compiled loop with this platform's FMUs: all outputs of the test rig."""
    system, folder = load_system("test_rig")
    chosen = replace(load_scene(folder, scene), t_end=COUNT * STEP, record_step=EVERY * STEP)
    parallel = Jacobi(order=0, schedule="parallel")
    wanted = hb.run("test_rig", scene=chosen, step=STEP, algorithm=parallel, fmu="native")
    assert wanted.outcome.completed
    names = [name for name in wanted.data.columns if name != "time"]
    system, _ = started(system, chosen)
    platform, grid = PLATFORMS[runner.platform], (STEP, COUNT, EVERY)
    rows = run_plan(write_plan(system, fmus, platform, runner.drive, names, grid, tmp_path))
    assert rows.shape == (COUNT // EVERY + 1, len(names))
    assert (rows[-1] != rows[0]).sum() > len(names) / 2
    np.testing.assert_array_equal(rows, wanted.data[names].to_numpy())
