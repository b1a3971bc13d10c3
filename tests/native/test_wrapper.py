"""The C wrapper of native FMUs around a hand-made component, under sanitizers and valgrind."""

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from compile_c import COMPILER, HERE, VALGRIND, WRAPPER, compile_c, execute

UNDER = {
    "sanitizers": ("-fsanitize=address,undefined", "-fno-sanitize-recover=all"),
    "thread sanitizer": ("-fsanitize=thread",),
    "valgrind": (),
}
"""Ways to find errors of memory and threads, with their compiler flags."""
TESTED = ("co_simulation", "fmi3", "model_exchange")

pytestmark = pytest.mark.skipif(not COMPILER, reason="no C compiler")

INERTIAS = "# units: mass kg, speed rad/s\nside,mass,speed\n"
FILES = {
    "inertias.csv": INERTIAS + "left,0.5,1\nright,0.25,1\n",
    "heavy.csv": INERTIAS + "left,5,1\n",
    "schwer größer.csv": INERTIAS + "left,5,1\n",
    "empty.csv": "",
    "no_units.csv": "side,mass,speed\nleft,1,1\n",
    "unit.csv": "# units: mass g, speed rad/s\nside,mass,speed\nleft,1,1\n",
    "other_unit.csv": "# units: mass kg\nside,mass,speed\nleft,1,1\n",
    "no_rows.csv": INERTIAS + "\n# nothing\n",
    "twice.csv": "# units: mass kg, speed rad/s\nside,mass,mass\nleft,1,1\n",
    "column.csv": "# units: mass kg, speed rad/s\nside,speed,masse\nleft,1,1\n",
    "extra.csv": "# units: mass kg, speed rad/s\nside,mass,speed,colour\nleft,1,1,3\n",
    "short.csv": INERTIAS + "left,1,1\n\nleft,1\n",
    "number.csv": INERTIAS + "left,1,1\nleft,0x10,1\n",
    "nan.csv": INERTIAS + "left,nan,1\n",
    "huge.csv": INERTIAS + "left,1e999,1\n",
    "word.csv": INERTIAS + "top,1,1\n",
    "quote.csv": INERTIAS + 'left,1,1\n"left,1,1\n',
    "quotes.csv": INERTIAS + 'left,1,1\nleft,"0""5,",1\n',
    "negative.csv": INERTIAS + "left,1,1\nright,-1,1\n",
    "excel.csv": '\ufeff# units: speed r/min, mass kg\r\n"speed" , mass ,side\r\n'
    '"1", 5e-1 ," left "\r\n\r\n2,+.5,"right"',
    "shapes.csv": "# units: shape kg^-1/2\npoint,m1,m2\na,0.5,-0.25\nb,0.25,0.25\n",
    "three_shapes.csv": "# units: shape kg^-1/2\npoint,m1,m2,m3\na,1,0,0\nb,0,0,0\n",
    "one_shape.csv": "# units: shape kg^-1/2\npoint,m1,m2\na,0.5,-0.25\n",
}
"""Resource files of the rotor; the gain is the first mass, ten times as large in r/min."""


@pytest.fixture(scope="module")
def resources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("resources")
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8", newline="")
    (folder / "binary.csv").write_bytes(INERTIAS.encode() + b"left,\xff\xfe,1\n")
    return folder


@pytest.fixture(scope="module")
def run(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, resources: Path
) -> Callable[..., None]:
    """Compile a test against the wrapper and run it."""
    if request.param == "valgrind" and not shutil.which("valgrind"):
        pytest.skip("valgrind is not installed")
    flags = (*UNDER[request.param], '-DSOURCES="version1"')
    guard = VALGRIND if request.param == "valgrind" else ()
    folder = tmp_path_factory.mktemp("rotor")
    library = folder / "rotor.o"
    compile_c(*flags, "-r", *sorted(WRAPPER.rglob("*.c")), HERE / "rotor.c", "-o", library)

    def run_test(test: str, *arguments: str, **environment: str) -> None:
        compile_c(*flags, HERE / f"{test}.c", library, "-o", folder / test)
        environment = {**os.environ, **environment}
        execute(*guard, folder / test, resources, *arguments, env=environment)

    return run_test


@pytest.mark.parametrize(
    ("run", "test"),
    [
        *(("sanitizers", f"test_{what}") for what in TESTED),
        *(("valgrind", f"test_{what}") for what in TESTED),
        ("sanitizers", "test_threads"),
        ("thread sanitizer", "test_threads"),
        ("sanitizers", "fuzz_csv"),
    ],
    indirect=["run"],
    scope="module",
)
def test_wrapper(run: Callable[..., None], test: str) -> None:
    run(test)


@pytest.fixture(scope="module")
def german(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Environment with a locale whose decimal point is a comma."""
    folder = tmp_path_factory.mktemp("locales")
    make = shutil.which("localedef")
    name = "de_DE.UTF-8"
    sources = Path("/usr/share/i18n/locales/de_DE").is_file()
    if not make or not sources:
        pytest.skip("localedef and the sources of locales are not installed")
    subprocess.run([make, "-i", "de_DE", "-f", "UTF-8", folder / name], check=True)
    return {"LOCPATH": str(folder), "LC_ALL": name}


@pytest.mark.parametrize("run", ["sanitizers"], indirect=True)
def test_host_with_decimal_comma(run: Callable[..., None], german: dict[str, str]) -> None:
    run("test_co_simulation", ",", **german)
