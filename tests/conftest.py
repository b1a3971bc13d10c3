"""Fixtures that several test files share, and the order of the files."""

import os
from collections import Counter
from contextlib import ExitStack

import pytest
from support.alone import alone
from threadpoolctl import threadpool_limits

from herringbone.commands import output
from herringbone.components.registry import COMPONENTS
from herringbone.core.caching import answers
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.fmi import build_python_fmus
from herringbone.fmi.native import build_native_fmus, find_compiler, own_platform


def pytest_configure(config):
    """Searching numba's millions of objects, and those of tests, for cycles takes a tenth of it."""
    around = ExitStack()
    around.enter_context(output.seldom_collected())
    config.add_cleanup(around.close)


def pytest_collection_modifyitems(items):
    """Files with slow tests first, those with most at the front: no process is left with them.

    Tests of a file stay together, as they share what is made for the file.
    """
    slow = Counter(item.path for item in items if item.get_closest_marker("slow"))
    items.sort(key=lambda item: -slow[item.path])


@pytest.fixture(scope="session", autouse=True)
def power_stays():
    """No machine loses its power in a test, so no file waits for its disk: some 10 ms each."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda descriptor: None)
        yield


@pytest.fixture(scope="session", autouse=True)
def one_blas_thread():
    """Threads of two test processes would wait for each other: ten times the time."""
    with threadpool_limits(limits=1, user_api="blas"):
        yield


@pytest.fixture(scope="session", autouse=True)
def strangers_in_process():
    """A cell takes a third of a second to start; the tests of cells ask for them."""
    with foreign_fmu_policy(in_process=True):
        yield


@pytest.fixture(scope="session", autouse=True)
def answers_of_the_session(tmp_path_factory):
    """Tests find what others were told before."""
    place = tmp_path_factory.getbasetemp() / "answers"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(answers, "FOLDER", str(place))
        yield place


@pytest.fixture(autouse=True)
def answers_of_the_test(request, answers_of_the_session, monkeypatch):
    """What a test is told, with whatever it has replaced, no other one is told."""
    monkeypatch.setattr(answers, "FOLDER", str(answers_of_the_session / str(id(request.node))))


@pytest.fixture
def without_pictures(monkeypatch):
    """Runs of the command line draw none, which takes longer than a short run."""
    has_pictures = "herringbone.running.reporting.report.has_pictures"
    monkeypatch.setattr(has_pictures, lambda result: False)


@pytest.fixture(scope="session")
def python_fmus():
    """Path of the Python FMU by component."""
    with alone("python_fmus"):
        return build_python_fmus()


def _native(order, fmi):
    """Native FMUs by component; test processes that build them at a time share the work."""
    found = build_native_fmus(order, fmi=fmi)
    return {name: found[name] for name in COMPONENTS}


@pytest.fixture(scope="session")
def build_order(request):
    """Components, in another order in every other test process."""
    worker = getattr(request.config, "workerinput", {}).get("workerid", "gw0")
    return list(COMPONENTS)[:: -1 if int(worker.removeprefix("gw")) % 2 else 1]


@pytest.fixture(scope="session")
def native_fmus(build_order):
    """Path of the native FMU 2.0 of this platform by component."""
    platform = own_platform()
    if platform is None or find_compiler(platform) is None:
        pytest.skip("no C compiler for native FMUs was found")
    return _native(build_order, fmi=2)


@pytest.fixture(scope="session")
def fmi3_fmus(native_fmus, build_order):
    """Path of the native FMU 3.0 of this platform by component."""
    return _native(build_order, fmi=3)
