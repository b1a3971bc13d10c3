"""Fixtures of the suite that every FMU passes."""

import pytest

from herringbone.fmi.host import Host


@pytest.fixture(params=["python", "native"])
def fmus(request):
    """Path of the FMU by component, for each kind of FMU."""
    return request.getfixturevalue(f"{request.param}_fmus")


@pytest.fixture
def started(fmus):
    """Function that gives an initialised host of a component; all are freed at the end."""
    hosts = []

    def start(name, instance="part", **values):
        host = Host(instance, fmus[name])
        hosts.append(host)
        host.initialise(values)
        return host

    yield start
    for host in hosts:
        host.close()
